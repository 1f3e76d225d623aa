// The least distance of a motion: bisection in time, with the pairs that are not decided yet.
#include <algorithm>
#include <cmath>

#include "monitor/ask/motion_search.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
void MotionSearch::find_least() {
  const OpenList all = all_pairs();
  seed_upper(all);
  minimise(posture_.trajectory().whole(), all, 0.0);
  answer_->lower = std::max(0.0, std::min(leasts_[0].closed, answer_->upper));
}

// Queries the pair that seems closest in the middle, so that no search begins without an upper
// bound.
void MotionSearch::seed_upper(const OpenList& all) noexcept {
  if (all.is_empty()) return;
  const Stretch whole = posture_.trajectory().whole();
  const double middle = posture_.trajectory().middle(whole);
  place(whole, middle);
  double least = kInfinity;
  std::uint32_t closest = order_[pairs_.bundles()[open_[all.begin].bundle].first];
  for (std::size_t k = all.begin; k < all.end; ++k) {
    const Bundle& bundle = pairs_.bundles()[open_[k].bundle];
    const std::uint32_t count = near_ones(bundle, open_[k].count, {}, least);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t pair = order_[bundle.first + i];
      const double apart = gap(pair_at(pair, {}), pair, least);
      if (apart < least) {
        least = apart;
        closest = pair;
      }
    }
  }
  const Pair at = pair_at(closest, {});
  const PairAtMiddle found = query(at, closest);
  const Bundle& bundle = pairs_.bundles()[pairs_.pairs()[closest].bundle];
  const TipMotion motion = tip_motion(bundle, whole, middle, posture_);
  note_upper(
      found,
      std::max(0.0, rounded_up(found.upper + motion.error - at.approach.nearing.until_middle)),
      middle, closest);
}

// Whether a division raises the pair's lower bound by the tolerance at most: the distance at the
// middle itself is not known better. Part of a frame that was cropped is such a case.
bool MotionSearch::is_as_good_as_at_middle(double lower, double model_error,
                                           const PairAtMiddle& found,
                                           const Pair& at) const noexcept {
  return lower >=
         found.lower - model_error - at.approach.nearing.until_middle - question_->tolerance;
}

void MotionSearch::minimise(const Stretch& stretch, const OpenList& list, double known) noexcept {
  if (list.is_empty()) return;
  if (is_exhausted()) {
    answer_->within_work_limit = false;
    leasts_[0].closed = std::min(leasts_[0].closed, known);
    return;
  }
  const double middle = posture_.trajectory().middle(stretch);
  place(stretch, middle);
  const bool divides = can_divide(stretch, middle);
  Least& all = leasts_[0];
  double least = kInfinity, closing = 0.0;
  OpenList left{list.end, list.end};
  for (std::size_t k = list.begin; k < list.end; ++k) {
    const Bundle& bundle = pairs_.bundles()[open_[k].bundle];
    const TipMotion motion = tip_motion(bundle, stretch, middle, posture_);
    std::uint32_t* const order = &order_[bundle.first];
    const std::uint32_t count = near_ones(bundle, open_[k].count, motion, all.reached);
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t pair = order[i];
      const auto enough = [&] {
        return std::min(question_->far_enough, all.reached - question_->tolerance);
      };
      const Pair at = pair_at(pair, motion);
      const double apart = gap(at, pair, rounded_up(all.reached + at.loss));
      double lower = rounded_down(apart - at.loss);
      if (lower >= all.reached) continue;  // it cannot lower the least distance
      // No distance is negative, so a pair in contact is decided as well.
      bool decided = std::max(0.0, lower) >= enough();
      const double size = at.tip.sphere_in_world.radius;
      const bool worth =
          apart < all.reached || apart + size >= enough() + kShareAlongNormal * at.loss || !divides;
      double speed = 0.0;
      if (!decided && worth) {
        const PairAtMiddle found = query(at, pair);
        const double now = found.upper + motion.error - at.approach.nearing.until_middle;
        note_upper(found, std::max(0.0, rounded_up(now)), middle, pair);
        lower = std::max(lower, lower_over(found, at.base, at.tip, bundle.keeps_direction, motion,
                                           at.approach, enough()));
        speed = closing_speed(found, at.tip, motion, at.approach);
        decided = std::max(0.0, lower) >= enough() ||
                  is_as_good_as_at_middle(lower, bundle.model_error, found, at);
      }
      if (decided || !divides) {
        all.closed = std::min(all.closed, lower);
        continue;
      }
      if (lower < least) {
        least = lower;
        closing = speed;
      }
      std::swap(order[kept++], order[i]);
    }
    if (kept > 0) open_[left.end++] = {open_[k].bundle, kept};
  }
  const double inherited = std::max(known, least);
  const Stretch before = Trajectory::before(stretch, middle);
  const Stretch after = Trajectory::after(stretch, middle);
  minimise(closing > 0.0 ? after : before, left, inherited);
  minimise(closing > 0.0 ? before : after, left, inherited);
}

}  // namespace clearance
