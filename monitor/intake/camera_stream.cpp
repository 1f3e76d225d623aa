#include "monitor/intake/camera_stream.hpp"

#include <cstring>

namespace clearance {
namespace {

// The content of rows without their padding, eight bytes a step (FNV-1a's mixing). Equal depth has
// the same digest. Two frames that differ have the same one by chance only, once in 2^64: the frame
// is then refused.
class Digest {
 public:
  void add(std::span<const std::byte> bytes) noexcept {
    while (bytes.size() >= sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data(), sizeof word);
      mix(word);
      bytes = bytes.subspan(sizeof word);
    }
    for (const std::byte byte : bytes) mix(std::to_integer<std::uint64_t>(byte));
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  void mix(std::uint64_t word) noexcept {
    value_ = (value_ ^ word) * 0x100000001B3U;
    value_ ^= value_ >> 29;
  }
  std::uint64_t value_ = 0xCBF29CE484222325U;
};

std::uint64_t digest_of(std::span<const std::byte> bytes, std::size_t row, std::size_t step,
                        std::uint32_t rows) noexcept {
  Digest digest;
  for (std::uint32_t v = 0; v < rows; ++v) digest.add(bytes.subspan(v * step, row));
  return digest.value();
}

// Only of where the points are: a camera whose depth stands still may go on with its colours.
std::uint64_t digest_of(const PointsView& points) noexcept {
  Digest digest;
  for (std::uint32_t row = 0; row < points.height; ++row) {
    for (std::uint32_t column = 0; column < points.width; ++column) {
      const auto point = points.bytes.subspan(row * points.row_step + column * points.point_step);
      for (const std::size_t field : {points.x, points.y, points.z})
        digest.add(point.subspan(field, sizeof(float)));
    }
  }
  return digest.value();
}

// |a - b| as an unsigned number: stamps of a message may be any.
std::uint64_t time_between(std::int64_t a, std::int64_t b) noexcept {
  return a > b ? static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b)
               : static_cast<std::uint64_t>(b) - static_cast<std::uint64_t>(a);
}

}  // namespace

FrameFault CameraStream::counted(FrameFault fault) noexcept {
  ++counts_[static_cast<std::size_t>(fault)];
  return fault;
}

// The first CameraInfo is the camera. While another one is said, there is none.
FrameFault CameraStream::take(const sensor_msgs_msg_dds__CameraInfo_& message) noexcept {
  PinholeCamera camera;
  const FrameFault fault = view(message, camera);
  if (fault != FrameFault::kNoFault) {
    camera_.reset();
    return counted(fault);
  }
  if (!first_) first_ = camera;
  if (camera != *first_) {
    camera_.reset();
    return counted(FrameFault::kCameraInfoChanged);
  }
  camera_ = camera;
  return counted(FrameFault::kNoFault);
}

FrameFault CameraStream::take(const sensor_msgs_msg_dds__Image_& message, const FrameOrigin& origin,
                              DepthImage& out) noexcept {
  DepthImage image;
  FrameFault fault = view(message, options_.most_pixels, image);
  if (fault != FrameFault::kNoFault) return counted(fault);
  if (!camera_) {
    return counted(first_ ? FrameFault::kCameraInfoChanged : FrameFault::kNoCameraInfo);
  }
  if (image.width != camera_->width || image.height != camera_->height) {
    return counted(FrameFault::kSizeChanged);
  }
  fault = judge(origin);
  if (fault != FrameFault::kNoFault) return counted(fault);
  const std::size_t pixel = image.format == DepthImage::Format::kMillimetres16 ? 2 : 4;
  fault = accept(origin, digest_of(image.bytes, image.width * pixel, image.step, image.height));
  if (fault == FrameFault::kNoFault) out = image;
  return counted(fault);
}

FrameFault CameraStream::take(const sensor_msgs_msg_dds__PointCloud2_& message,
                              const FrameOrigin& origin, PointsView& out) noexcept {
  PointsView points;
  FrameFault fault = view(message, options_.most_pixels, points);
  if (fault == FrameFault::kNoFault) fault = judge(origin);
  if (fault != FrameFault::kNoFault) return counted(fault);
  fault = accept(origin, digest_of(points));
  if (fault == FrameFault::kNoFault) out = points;
  return counted(fault);
}

FrameFault CameraStream::take(const octomap_msgs_msg_dds__Octomap_& message,
                              const FrameOrigin& origin, OctomapView& out) noexcept {
  OctomapView map;
  FrameFault fault = view(message, map);
  if (fault == FrameFault::kNoFault) fault = judge(origin);
  if (fault == FrameFault::kNoFault && !origin.is_stamped) {
    fault = accept(origin, digest_of(map.bytes, map.bytes.size(), 0, 1));
  }
  if (fault != FrameFault::kNoFault) return counted(fault);
  last_ = origin;
  out = map;
  return counted(FrameFault::kNoFault);
}

FrameFault CameraStream::judge(const FrameOrigin& origin) const noexcept {
  if (origin.stamp_ns == 0) return FrameFault::kNoStamp;
  if (time_between(origin.stamp_ns, origin.sent_ns) >
      static_cast<std::uint64_t>(options_.clock_limit_ns)) {
    return FrameFault::kOtherClock;
  }
  if (last_.stamp_ns == 0) return FrameFault::kNoFault;
  const bool is_heard =
      time_between(origin.sent_ns, last_.sent_ns) < static_cast<std::uint64_t>(options_.silence_ns);
  if (origin.writer != last_.writer && is_heard) return FrameFault::kSecondPublisher;
  if (origin.stamp_ns <= last_.stamp_ns) {
    const bool is_set_back =
        time_between(origin.stamp_ns, last_.stamp_ns) > static_cast<std::uint64_t>(kSetBackNs);
    return is_set_back && !is_heard ? FrameFault::kNoFault : FrameFault::kOldStamp;
  }
  if (time_between(origin.stamp_ns, last_.stamp_ns) <
      static_cast<std::uint64_t>(options_.least_interval_ns)) {
    return FrameFault::kTooOften;
  }
  return FrameFault::kNoFault;
}

// A frozen frame is refused, so the stamp in use stays the one of the first such frame.
FrameFault CameraStream::accept(const FrameOrigin& origin, std::uint64_t digest) noexcept {
  if (!options_.may_repeat && has_digest_ && digest == digest_) return FrameFault::kFrozen;
  has_digest_ = true;
  digest_ = digest;
  last_ = origin;
  return FrameFault::kNoFault;
}

}  // namespace clearance
