// The share of a picture's elements that have depth: a torn picture, or one that something covers,
// has fewer of them at once.
#pragma once

#include <cstdint>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/intake/camera_messages.hpp"

namespace clearance {

class SeenShare {
 public:
  // From one frame to the next, the share falls to less than this of what it was: no motion at the
  // rate of a camera does that, but a torn picture, or something nearer than the least depth.
  static constexpr double kLeastOfBefore = 0.8;
  // A share that stays lower for this long is that of the scene, ns.
  static constexpr std::int64_t kBelievedNs = 10'000'000'000;

  // `share` of elements with depth within the range, 0 to 1, of a frame with this stamp. A frame
  // without any is not judged here.
  [[nodiscard]] FrameFault judge(double share, double least, std::int64_t stamp_ns) noexcept {
    newest_ = {share, stamp_ns};
    if (share < least) return FrameFault::kFewSeen;
    return share < kLeastOfBefore * used_.share && elapsed(used_.stamp_ns, stamp_ns) < kBelievedNs
               ? FrameFault::kSeenFell
               : FrameFault::kNoFault;
  }
  // The frame that was judged last is used.
  void use() noexcept { used_ = newest_; }

 private:
  struct Frame {
    double share = 0.0;
    std::int64_t stamp_ns = 0;
  };
  Frame used_, newest_;
};

}  // namespace clearance
