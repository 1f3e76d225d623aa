#include "monitor/intake/camera_stream.hpp"

#include <algorithm>
#include <span>

#include "monitor/intake/digest.hpp"

namespace clearance {
namespace {

// The content of rows without their padding: equal depth has the same digest. A frame that differs
// and has the same one by chance is refused.
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

std::uint64_t frame_of(const std_msgs_msg_dds__Header_& header) noexcept {
  return digest_of_frame(header.frame_id == nullptr ? "" : header.frame_id);
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
  const std::uint64_t frame = frame_of(message.header);
  if (!first_) {
    first_ = camera;
    frame_ = frame;
  }
  if (camera != *first_ || are_named_unlike(frame, frame_)) {
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
  if (are_named_unlike(frame_of(message.header), frame_)) {
    return counted(FrameFault::kOtherCamera);
  }
  const MessageForm form = form_of(origin.frame, image);
  fault = judge(origin, form);
  if (fault != FrameFault::kNoFault) return counted(fault);
  const std::size_t pixel = image.format == DepthImage::Format::kMillimetres16 ? 2 : 4;
  fault = accept(origin, form,
                 digest_of(image.bytes, image.width * pixel, image.step, image.height), kRing);
  if (fault == FrameFault::kNoFault) out = image;
  return counted(fault);
}

FrameFault CameraStream::take(const sensor_msgs_msg_dds__PointCloud2_& message,
                              const FrameOrigin& origin, PointsView& out) noexcept {
  PointsView points;
  FrameFault fault = view(message, options_.most_pixels, points);
  const MessageForm form = form_of(origin.frame, points);
  if (fault == FrameFault::kNoFault) fault = judge(origin, form);
  if (fault != FrameFault::kNoFault) return counted(fault);
  fault = accept(origin, form, digest_of(points), kRing);
  if (fault == FrameFault::kNoFault) out = points;
  return counted(fault);
}

FrameFault CameraStream::take(const octomap_msgs_msg_dds__Octomap_& message,
                              const FrameOrigin& origin, OctomapView& out) noexcept {
  OctomapView map;
  FrameFault fault = view(message, map);
  const MessageForm form = form_of(origin.frame, map);
  if (fault == FrameFault::kNoFault) fault = judge(origin, form);
  if (fault == FrameFault::kNoFault && !origin.is_stamped) {
    fault = accept(origin, form, digest_of(map.bytes, map.bytes.size(), 0, 1), 1);
  }
  if (fault != FrameFault::kNoFault) return counted(fault);
  use(origin, form);
  out = map;
  return counted(FrameFault::kNoFault);
}

FrameFault CameraStream::judge(const FrameOrigin& origin, const MessageForm& form) const noexcept {
  const FrameFault fault = judge(origin);
  return fault == FrameFault::kNoFault ? form_.refuses(form) : fault;
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

// Refuses a frame that repeats one of the last `ring` frames bit for bit: a driver that hangs may
// send the buffers of its ring again and again, under fresh stamps. The stamp in use stays that of
// the first of them. A map is compared with the last one only, since it may change back.
FrameFault CameraStream::accept(const FrameOrigin& origin, const MessageForm& form,
                                std::uint64_t digest, std::uint64_t ring) noexcept {
  const std::uint64_t kept = std::min({digests_, ring, std::uint64_t{kRing}});
  for (std::uint64_t i = 1; i <= kept && !options_.may_repeat; ++i)
    if (digest_[(digests_ - i) % kRing] == digest) return FrameFault::kFrozen;
  digest_[digests_++ % kRing] = digest;
  use(origin, form);
  return FrameFault::kNoFault;
}

void CameraStream::use(const FrameOrigin& origin, const MessageForm& form) noexcept {
  last_ = origin;
  last_.frame = {};  // of the message's memory
  form_.use(form);
}

}  // namespace clearance
