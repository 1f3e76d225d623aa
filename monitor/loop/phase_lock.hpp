// Moves the deadlines of the loop, so that a tick begins soon after the samples of one source have
// come. The source has its own clock: its period need not be that of the ticks, but a multiple or a
// part of it, nearly.
//
// Samples should come `lead` before the deadline. A correction follows the last samples slowly, and
// no period becomes longer or shorter by more than a 64th. Without samples there is no correction:
// the loop goes on by its clock, and comes back into phase without a jump.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>

namespace clearance {

class PhaseLock {
 public:
  // A period is off by no more than this part of it: Scene::longest_period().
  static constexpr std::int64_t kMostSlew = 64;
  // Samples come after their deadline in one tick of so many.
  static constexpr std::int64_t kTicksALateSample = 100;
  static constexpr std::int64_t kLeastLeadNs = 20'000;

  explicit PhaseLock(std::int64_t period_ns) noexcept : period_ns_(period_ns) {}

  // Samples of the source that the coming tick uses. When they came, CLOCK_MONOTONIC, ns.
  void note(std::int64_t came_ns) noexcept {
    const std::int64_t after_last = came_ns - deadline_ns_;
    is_late_ = is_late_ || (after_last > 0 && after_last < period_ns_ / kLocked);
    came_ns_ = std::max(came_ns_, came_ns);
    has_come_ = true;
  }
  // After the tick of this deadline. Returns by how much the next one is later than a period after
  // it, ns.
  [[nodiscard]] std::int64_t correction(std::int64_t deadline_ns) noexcept {
    deadline_ns_ = deadline_ns;
    const bool is_late = std::exchange(is_late_, false);
    if (!std::exchange(has_come_, false)) return 0;
    const std::int64_t off = nearest(deadline_ns - came_ns_ - lead_ns_);
    settled_ = std::abs(off) < period_ns_ / kLocked ? settled_ + 1 : 0;
    if (settled_ > kSettles) follow_jitter(is_late);
    const std::int64_t slew = period_ns_ / kMostSlew;
    return std::clamp(-off / kGain, -slew, slew);
  }
  [[nodiscard]] std::int64_t lead_ns() const noexcept { return lead_ns_; }

 private:
  static constexpr std::int64_t kGain = 16, kLocked = 4;  // parts of a period
  static constexpr std::int64_t kStepNs = 100;            // of the lead, a tick
  static constexpr std::uint64_t kSettles = 4 * kGain;    // ticks

  // The same phase, at most half a period from 0, ns.
  [[nodiscard]] std::int64_t nearest(std::int64_t ns) const noexcept {
    const std::int64_t rest = ns % period_ns_;
    if (rest > period_ns_ / 2) return rest - period_ns_;
    return rest < -period_ns_ / 2 ? rest + period_ns_ : rest;
  }
  // In balance, one tick in kTicksALateSample has a sample that came after the deadline before.
  void follow_jitter(bool is_late) noexcept {
    lead_ns_ = std::clamp(lead_ns_ + (is_late ? kTicksALateSample - 1 : -1) * kStepNs, kLeastLeadNs,
                          period_ns_ / kLocked);
  }

  std::int64_t period_ns_;
  std::int64_t lead_ns_ = 4 * kLeastLeadNs;
  std::int64_t came_ns_ = 0, deadline_ns_ = 0;  // of the last sample, and of the last tick
  std::uint64_t settled_ = 0;                   // ticks with samples near their place
  bool has_come_ = false, is_late_ = false;
};

}  // namespace clearance
