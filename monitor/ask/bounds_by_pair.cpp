// The least distance of each pair of objects by itself, and the first place at which one of them
// may be below its margin.
//
// The stretch with the bound that is farthest from what is needed comes first, so that a search
// that ends by its work limit has bounds of all pairs that are about equally good.
#include <algorithm>
#include <cmath>

#include "monitor/ask/motion_search.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

constexpr std::size_t kMostStretches = 4096;
constexpr std::size_t kPairsOfLevels = 16;  // all pairs in so many stretches

}  // namespace

void MotionSearch::make_room_by_pair() {
  stretches_.reserve(kMostStretches);
  waiting_.reserve((kPairsOfLevels + 1) * pairs_.pairs().size() + kMostStretches);
}

void MotionSearch::bound_by_pair() noexcept {
  MarginAnswer& decided = answer_->margins.front();
  decided.above_until = decided.below_at = kInfinity;
  found_ = false;
  wait_for_all();
  const bool only_verdict = question_->only_verdicts;
  while (!stretches_.empty() && !(only_verdict && found_)) {
    std::pop_heap(stretches_.begin(), stretches_.end());
    const WaitingStretch waiting = stretches_.back();
    stretches_.pop_back();
    const bool has_room = stretches_.size() + 2 <= stretches_.capacity() &&
                          waiting_.size() + (waiting.end - waiting.begin) <= waiting_.capacity();
    if (has_room && !is_exhausted()) {
      examine(waiting);
      continue;
    }
    answer_->within_work_limit = false;
    for (std::size_t i = waiting.begin; i < waiting.end; ++i) close(waiting.stretch, waiting_[i]);
  }
  if (found_) {
    decided.verdict = Verdict::kBelow;
  } else {
    const bool is_free = decided.above_until == kInfinity;
    decided.verdict = is_free ? Verdict::kFree : Verdict::kUndecided;
  }
  if (only_verdict && found_) decided.above_until = posture_.trajectory().begin();
  for (std::size_t p = 0; p < answer_->lower_by_pair.size(); ++p) {
    const double lower = std::min(leasts_[p].closed, leasts_[p].reached);
    answer_->lower_by_pair[p] = std::max({0.0, known_of(p).lower, lower});
  }
}

KnownBound MotionSearch::known_of(std::size_t objects) const noexcept {
  return question_->known_by_pair.empty() ? KnownBound() : question_->known_by_pair[objects];
}

// Omits pairs whose known bound is enough, and those without a margin if only margins count.
void MotionSearch::wait_for_all() noexcept {
  stretches_.clear();
  waiting_.clear();
  const OpenList all = all_pairs();
  for (std::size_t k = all.begin; k < all.end; ++k) {
    const Bundle& bundle = pairs_.bundles()[open_[k].bundle];
    for (std::uint32_t i = 0; i < open_[k].count; ++i) {
      const std::uint32_t pair = order_[bundle.first + i];
      const KnownBound known = known_of(watched_[pair]);
      const bool seeks_least = !question_->only_verdicts;
      if (!known.is_enough && (seeks_least || margin_of(pair) > -kInfinity)) {
        waiting_.push_back({pair, known.lower, seeks_least});
      } else {
        least_of(pair).closed = std::min(least_of(pair).closed, known.lower);
      }
    }
  }
  if (!waiting_.empty())
    stretches_.push_back({posture_.trajectory().whole(), 0, waiting_.size(), kInfinity});
}

// Better bounds of its least distance do not matter.
double MotionSearch::enough_for_least(std::uint32_t pair) noexcept {
  return std::min(question_->far_enough, least_of(pair).reached - question_->tolerance);
}

// A stretch matters to a pair that is not proven to keep its margin in it, if it begins before the
// first such place so far.
bool MotionSearch::seeks_first(const Stretch& stretch, const WaitingPair& of) const noexcept {
  const MarginAnswer& first = answer_->margins.front();
  return !proves(of.lower, margin_of(of.pair)) &&
         stretch.from < std::min(first.above_until, first.below_at);
}

void MotionSearch::close(const Stretch& stretch, const WaitingPair& of) noexcept {
  Least& least = least_of(of.pair);
  least.closed = std::min(least.closed, of.lower);
  MarginAnswer& first = answer_->margins.front();
  if (proves(of.lower, margin_of(of.pair)) || stretch.from >= first.above_until) return;
  first.above_until = stretch.from;
  note_pair(of.pair, first.first, first.second);
}

void MotionSearch::examine(const WaitingStretch& waiting) noexcept {
  const Stretch& stretch = waiting.stretch;
  const double middle = posture_.trajectory().middle(stretch);
  const bool divides = can_divide(stretch, middle);
  const std::size_t begin = waiting_.size();
  bool is_placed = false;
  std::uint32_t bundle = ~0u;
  TipMotion motion;
  double width = 0.0;
  for (std::size_t i = waiting.begin; i < waiting.end; ++i) {
    WaitingPair of = waiting_[i];
    of.seeks_least = of.seeks_least && std::max(0.0, of.lower) < enough_for_least(of.pair);
    if (!of.seeks_least && !seeks_first(stretch, of)) {
      close(stretch, of);
      continue;
    }
    if (!is_placed) place(stretch, middle);
    is_placed = true;
    if (pairs_.pairs()[of.pair].bundle != bundle) {
      bundle = pairs_.pairs()[of.pair].bundle;
      motion = tip_motion(pairs_.bundles()[bundle], stretch, middle, posture_);
    }
    bound_over(stretch, middle, pair_at(of.pair, motion), pairs_.bundles()[bundle], motion, of);
    if (divides && (of.seeks_least || seeks_first(stretch, of))) {
      waiting_.push_back(of);
      const double least = of.seeks_least ? enough_for_least(of.pair) : margin_of(of.pair);
      width = std::max(width, least - of.lower);
    } else {
      close(stretch, of);
    }
  }
  if (begin == waiting_.size()) return;
  stretches_.push_back({Trajectory::before(stretch, middle), begin, waiting_.size(), width});
  std::push_heap(stretches_.begin(), stretches_.end());
  stretches_.push_back({Trajectory::after(stretch, middle), begin, waiting_.size(), width});
  std::push_heap(stretches_.begin(), stretches_.end());
}

// Raises the lower bound, and tells whether divisions of the stretch may raise the least one.
void MotionSearch::bound_over(const Stretch& stretch, double middle, const Pair& at,
                              const Bundle& bundle, const TipMotion& motion,
                              WaitingPair& of) noexcept {
  const double margin = margin_of(of.pair);
  const auto wanted = [&] {
    const double least = of.seeks_least ? enough_for_least(of.pair) : -kInfinity;
    const double first = margin != 0.0 ? margin : 1e-300;
    return seeks_first(stretch, of) ? std::max(least, first) : least;
  };
  const auto is_enough = [&] {
    of.seeks_least = of.seeks_least && std::max(0.0, of.lower) < enough_for_least(of.pair);
    return !of.seeks_least && !seeks_first(stretch, of);
  };
  const double apart = gap(at, of.pair, rounded_up(wanted() + at.loss));
  of.lower = std::max(of.lower, rounded_down(apart - at.loss));
  if (is_enough()) return;
  const bool may_be_less = apart - at.approach.nearing.until_middle < least_of(of.pair).reached;
  const double size = at.tip.sphere_in_world.radius;
  if (!may_be_less && apart + size < wanted() + kShareAlongNormal * at.loss) return;

  const PairAtMiddle found = query(at, of.pair);
  const double nearing = at.approach.nearing.until_middle;
  const double upper =
      nearing < kInfinity ? rounded_up(found.upper + motion.error - nearing) : -kInfinity;
  note_upper(found, std::max(0.0, upper), middle, of.pair);
  of.lower = std::max(of.lower, lower_over(found, at.base, at.tip, bundle.keeps_direction, motion,
                                           at.approach, wanted()));
  if (is_enough()) return;
  of.seeks_least =
      of.seeks_least && !is_as_good_as_at_middle(of.lower, bundle.model_error, found, at);
  MarginAnswer& first = answer_->margins.front();
  if (is_below(upper, margin)) {
    if (!found_ || middle < first.below_at) first.below_at = middle;
    found_ = true;
  }
  if (proves(of.lower, margin)) return;
  // No division helps where the distance at the middle itself is not known well enough.
  const double length = stretch.to - stretch.from;
  const bool is_unclear =
      !is_below(upper, margin) &&
      rounded_down(found.lower - bundle.model_error - nearing) < margin &&
      (of.lower >= margin - question_->margin_tolerance || length <= kUnclear * duration_);
  const bool is_located = found_ && first.below_at - stretch.from <= question_->instant * duration_;
  if (!of.seeks_least && (is_unclear || is_located)) close(stretch, of);
}

}  // namespace clearance
