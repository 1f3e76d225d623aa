#include "monitor/objects/input_summary.hpp"

#include <algorithm>

#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

class LargestTwo {
 public:
  void add(double length) noexcept {
    if (length <= second_) return;
    second_ = std::min(most_, length);
    most_ = std::max(most_, length);
  }
  [[nodiscard]] double sum() const noexcept { return rounded_up(most_ + second_); }

 private:
  double most_ = 0.0, second_ = 0.0;
};

}  // namespace

InputSummary look_at_inputs(std::span<const TrackedObject> objects,
                            std::span<const std::uint32_t> moving, Report& report) noexcept {
  InputSummary round;
  bool any = false;
  LargestTwo unseen, strayed;
  for (const std::uint32_t i : moving) {
    const TrackedObject& object = objects[i];
    round.any_lost = round.any_lost || !object.known() || object.leapt;
    if (!object.seen) continue;
    report.newest_pose_ns =
        any ? std::max(report.newest_pose_ns, object.stamp_ns) : object.stamp_ns;
    report.oldest_pose_ns =
        any ? std::min(report.oldest_pose_ns, object.stamp_ns) : object.stamp_ns;
    any = true;
    if (!object.known()) continue;
    unseen.add(object.may_have_moved);
    // Of a body that nobody can bound, short of a leap, no pair sleeps.
    const double travel = object.travel_since();
    const double bounded = travel < kInfinity ? travel : 0.0;
    strayed.add(object.leapt ? kInfinity : rounded_up(object.unseen_since + bounded));
  }
  round.most_unseen = unseen.sum();
  round.most_strayed = strayed.sum();
  return round;
}

}  // namespace clearance
