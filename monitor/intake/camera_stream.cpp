#include "monitor/intake/camera_stream.hpp"

#include <utility>

namespace clearance {
namespace {

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

FrameFault CameraStream::take(const MessageCloud& cloud, const FrameOrigin& origin) {
  const FrameFault fault = judge(cloud, origin);
  if (fault == FrameFault::kNoFault) {
    last_ = origin;
    form_.use(cloud.form);
  }
  return counted(fault);
}

FrameFault CameraStream::judge(const MessageCloud& cloud, const FrameOrigin& origin) {
  FrameFault fault = cloud.fault;
  if (fault == FrameFault::kNoFault && cloud.image() != nullptr)
    fault = judge(*cloud.image(), cloud.form.frame);
  if (fault == FrameFault::kNoFault) fault = judge(origin);
  if (fault == FrameFault::kNoFault) fault = form_.refuses(cloud.form);
  if (fault == FrameFault::kNoFault && repeats(cloud)) fault = FrameFault::kFrozen;
  return fault;
}

FrameFault CameraStream::judge(const DepthImage& image, std::uint64_t frame) const noexcept {
  if (!camera_) return first_ ? FrameFault::kCameraInfoChanged : FrameFault::kNoCameraInfo;
  if (image.width != camera_->width || image.height != camera_->height)
    return FrameFault::kSizeChanged;
  return are_named_unlike(frame, frame_) ? FrameFault::kOtherCamera : FrameFault::kNoFault;
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

// The stamp in use stays that of the first of those that are the same. A map that nothing has
// changed may come again as it was, if its stamp says so. Without a stamp, it may be an old one
// that was sent again. It is compared with the last one only, since it may change back.
bool CameraStream::repeats(const MessageCloud& cloud) {
  if (cloud.is_map()) {
    if (cloud.is_stamped) return false;
    return cloud.depth_digest(0) == std::exchange(last_map_, cloud.depth_digest(0));
  }
  has_repeated_ = last_depths_.has(cloud);
  if (!has_repeated_) last_depths_.add();
  return has_repeated_ && !options_.may_repeat;
}

}  // namespace clearance
