// Judges the frames of one camera as a sequence: which of them may be used.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "monitor/intake/camera_messages.hpp"
#include "monitor/intake/message_form.hpp"

namespace clearance {

struct CameraStreamOptions {
  std::size_t most_pixels = 0;  // of an image or cloud: the memory that is fixed
  // A stamp farther than this from the time of sending is of another clock.
  std::int64_t clock_limit_ns = 10'000'000'000;
  // A publisher that was silent for this long has lost the stream, and another may take it.
  std::int64_t silence_ns = 500'000'000;
  // Frames may come at most this much sooner than the frame before; 0: at any rate.
  std::int64_t least_interval_ns = 0;
  bool may_repeat = false;  // a simulated camera without noise repeats its depth bit for bit
};

// When and by whom a message was sent.
struct FrameOrigin {
  std::int64_t stamp_ns = 0;  // of the header
  std::int64_t sent_ns = 0;   // the sender's clock at sending; in a log, the time of recording
  std::uint64_t writer = 0;
  bool is_stamped = true;       // false: the header has none, and `stamp_ns` is the time of sending
  std::string_view frame = {};  // in which it was measured
};

// To be used by one thread. Stamps increase, unless the clock was set back: after a silence, a
// stamp counts that is more than kSetBackNs older than the last one. A frame that is refused leaves
// no trace but its count.
class CameraStream {
 public:
  static constexpr std::int64_t kSetBackNs = 1'000'000'000;

  explicit CameraStream(const CameraStreamOptions& options) : options_(options) {}

  // Each returns kNoFault if the message can be used. The views are those of camera_messages.hpp.
  [[nodiscard]] FrameFault take(const sensor_msgs_msg_dds__CameraInfo_& message) noexcept;
  [[nodiscard]] FrameFault take(const sensor_msgs_msg_dds__Image_& message,
                                const FrameOrigin& origin, DepthImage& out) noexcept;
  [[nodiscard]] FrameFault take(const sensor_msgs_msg_dds__PointCloud2_& message,
                                const FrameOrigin& origin, PointsView& out) noexcept;
  // A map that nothing has changed may come again as it was, if its stamp says so. Without a stamp,
  // it may be an old one that was sent again.
  [[nodiscard]] FrameFault take(const octomap_msgs_msg_dds__Octomap_& message,
                                const FrameOrigin& origin, OctomapView& out) noexcept;
  // Counts bytes that could not be decoded.
  void refuse() noexcept { static_cast<void>(counted(FrameFault::kUndecodable)); }
  // Does not count the message that was refused last, because it is kept for later.
  void take_back(FrameFault fault) noexcept { --counts_[static_cast<std::size_t>(fault)]; }

  // Nothing before the first CameraInfo, or while another one is said.
  [[nodiscard]] const std::optional<PinholeCamera>& camera() const noexcept { return camera_; }
  // The stamp of the last frame that was used; 0: none.
  [[nodiscard]] std::int64_t stamp_ns() const noexcept { return last_.stamp_ns; }
  // Frames and CameraInfo that were used (kNoFault) or refused, by cause.
  [[nodiscard]] const std::array<std::uint64_t, kFrameFaults>& counts() const noexcept {
    return counts_;
  }

 private:
  FrameFault counted(FrameFault fault) noexcept;
  [[nodiscard]] FrameFault judge(const FrameOrigin& origin, const MessageForm& form) const noexcept;
  [[nodiscard]] FrameFault judge(const FrameOrigin& origin) const noexcept;
  // None of the last `ring` frames may have the same content.
  [[nodiscard]] FrameFault accept(const FrameOrigin& origin, const MessageForm& form,
                                  std::uint64_t digest, std::uint64_t ring) noexcept;
  void use(const FrameOrigin& origin, const MessageForm& form) noexcept;

  CameraStreamOptions options_;
  std::optional<PinholeCamera> first_, camera_;
  std::uint64_t frame_ = 0;  // of the first CameraInfo: a digest of its name; 0: it has none
  FrameOrigin last_;         // of the last frame that was used, without its frame's name
  FirstForm form_;
  static constexpr std::size_t kRing = 8;
  std::array<std::uint64_t, kRing> digest_{};  // of the depth of the last frames that were used
  std::uint64_t digests_ = 0;                  // so far
  std::array<std::uint64_t, kFrameFaults> counts_{};
};

}  // namespace clearance
