// Judges the frames of one camera as a sequence: which of them may be used.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "monitor/intake/last_depths.hpp"
#include "monitor/intake/message_cloud.hpp"

namespace clearance {

struct CameraStreamOptions {
  // A stamp farther than this from the time of sending is of another clock.
  std::int64_t clock_limit_ns = 10'000'000'000;
  // A publisher that was silent for this long has lost the stream, and another may take it.
  std::int64_t silence_ns = 500'000'000;
  // Frames may come at most this much sooner than the frame before; 0: at any rate.
  std::int64_t least_interval_ns = 0;
  bool may_repeat = false;  // a simulated camera without noise repeats its depth
};

// When and by whom a message was sent.
struct FrameOrigin {
  std::int64_t stamp_ns = 0;  // of the frame
  std::int64_t sent_ns = 0;   // the sender's clock at sending; in a log, the time of recording
  std::uint64_t writer = 0;
};

// To be used by one thread. Stamps increase, unless the clock was set back: after a silence, a
// stamp counts that is more than kSetBackNs older than the last one. A frame that is refused leaves
// no trace but its count.
class CameraStream {
 public:
  static constexpr std::int64_t kSetBackNs = 1'000'000'000;

  explicit CameraStream(const CameraStreamOptions& options) : options_(options) {}

  // Each returns kNoFault if the message can be used.
  [[nodiscard]] FrameFault take(const sensor_msgs_msg_dds__CameraInfo_& message) noexcept;
  [[nodiscard]] FrameFault take(const MessageCloud& cloud, const FrameOrigin& origin);
  // True if the last frame that was used repeats one of those before it, as it may.
  [[nodiscard]] bool has_repeated() const noexcept { return has_repeated_; }
  // Counts bytes that could not be decoded.
  void refuse() noexcept { static_cast<void>(counted(FrameFault::kUndecodable)); }
  // Does not count the message that was refused last, because it is kept for later.
  void take_back(FrameFault fault) noexcept { --counts_[static_cast<std::size_t>(fault)]; }

  // Stamps begin anew: no frame before is younger than those that follow.
  void begin_anew() noexcept { last_ = {}; }

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
  [[nodiscard]] FrameFault judge(const MessageCloud& cloud, const FrameOrigin& origin);
  // An image is refused that is not of the camera whose CameraInfo came.
  [[nodiscard]] FrameFault judge(const DepthImage& image, std::uint64_t frame) const noexcept;
  [[nodiscard]] FrameFault judge(const FrameOrigin& origin) const noexcept;
  // True if the cloud repeats one of the last ones. Otherwise, it is one of them from now on.
  [[nodiscard]] bool repeats(const MessageCloud& cloud);

  CameraStreamOptions options_;
  std::optional<PinholeCamera> first_, camera_;
  std::uint64_t frame_ = 0;  // of the first CameraInfo: a digest of its name; 0: it has none
  FrameOrigin last_;         // of the last frame that was used
  FirstForm form_;
  LastDepths last_depths_;
  std::uint32_t last_map_ = 0;
  bool has_repeated_ = false;
  std::array<std::uint64_t, kFrameFaults> counts_{};
};

}  // namespace clearance
