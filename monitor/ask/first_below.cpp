// Margins: whether a motion is above them at all instants, and else the first instant that is not.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "config/scene/pairs_between.hpp"
#include "monitor/ask/motion_search.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/pairs/kept_near.hpp"

namespace clearance {

// Pairs are exempt by margin, so a proof for one margin says nothing about another.
void MotionSearch::exempt_kept(double margin) {
  const auto [kept, is_new] = kept_.try_emplace(margin);
  if (is_new) kept->second = kept_nearer(scene_, margin);
  exempt_.clear();
  if (kept->second.empty()) return;
  exempt_.assign(pairs_.pairs().size(), 0);
  mark(kept->second, 1);
  proven_until_ = posture_.trajectory().begin();
}

void MotionSearch::exempt_all_but(const MarginBetween& margin) {
  exempt_.assign(pairs_.pairs().size(), 1);
  mark(pairs_between(scene_, margin.a, margin.b), 0);
  proven_until_ = posture_.trajectory().begin();
}

void MotionSearch::mark(const std::vector<std::uint32_t>& pairs, std::uint8_t value) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> objects;
  for (const std::uint32_t pair : pairs)
    objects.emplace(scene_.pairs[pair].first, scene_.pairs[pair].second);
  for (std::uint32_t pair = 0; pair < exempt_.size(); ++pair) {
    std::uint32_t first = 0, second = 0;
    note_pair(pair, first, second);
    if (objects.contains(std::minmax(first, second))) exempt_[pair] = value;
  }
}

// A larger margin is violated no later than a smaller one.
void MotionSearch::decide_margins() {
  proven_until_ = posture_.trajectory().begin();
  if (!question_->margins.empty() || !question_->margins_between.empty()) end_contacts();
  const std::vector<double>& margins = question_->margins;
  double last = kInfinity;
  for (std::size_t n = 0; n < margins.size(); ++n) {
    double next = -1.0;
    for (const double margin : margins) {
      if (margin < last) next = std::max(next, margin);
    }
    if (next < 0.0) break;
    last = next;
    MarginAnswer decided{.margin = next};
    exempt_kept(next);
    decide(decided);
    if (!exempt_.empty()) proven_until_ = posture_.trajectory().begin();
    const bool keeps_distance =
        decided.verdict == Verdict::kFree && contacts_.empty() && exempt_.empty();
    if (keeps_distance && question_->only_margins) answer_->lower = std::max(answer_->lower, next);
    for (std::size_t i = 0; i < margins.size(); ++i) {
      if (margins[i] == next) answer_->margins[i] = decided;
    }
  }
  for (std::size_t i = 0; i < question_->margins_between.size(); ++i) {
    const MarginBetween& of = question_->margins_between[i];
    exempt_all_but(of);
    MarginAnswer& decided = answer_->margins[margins.size() + i];
    decided = {.margin = of.margin};
    decide(decided);
  }
  exempt_.clear();
}

void MotionSearch::decide(MarginAnswer& answer) noexcept {
  if (!answer_->has_pair || (!only_stops_ && proves(answer_->lower, answer.margin))) {
    answer.verdict = Verdict::kFree;
    return;
  }
  const Stretch whole = posture_.trajectory().whole();
  answer.above_until = whole.from;
  const bool any_pair_counts =
      question_->only_verdicts && !only_stops_ && contacts_.empty() && exempt_.empty();
  if (any_pair_counts && is_below(answer_->upper, answer.margin)) {
    answer.verdict = Verdict::kBelow;
    answer.below_at = answer_->time;
    answer.first = answer_->first;
    answer.second = answer_->second;
    return;
  }
  found_ = uncertain_ = false;
  find_first(whole, all_pairs(), answer);
  answer.verdict = found_ ? Verdict::kBelow : uncertain_ ? Verdict::kUndecided : Verdict::kFree;
  if (question_->only_verdicts && found_)
    answer.above_until = whole.from;
  else if (found_ && !uncertain_)
    answer.above_until = answer.below_at;
  if (answer.verdict != Verdict::kFree) proven_until_ = std::max(proven_until_, answer.above_until);
}

void MotionSearch::find_first(const Stretch& stretch, const OpenList& list,
                              MarginAnswer& answer) noexcept {
  if (list.is_empty()) return;
  if (found_ && (stretch.from >= answer.below_at || question_->only_verdicts)) return;
  if (stretch.to <= proven_until_ && stretch.from < stretch.to) return;
  const auto note_uncertain = [&](std::uint32_t pair) {
    if (!uncertain_ || stretch.from < answer.above_until) {
      answer.above_until = stretch.from;
      if (!found_) note_pair(pair, answer.first, answer.second);
    }
    uncertain_ = true;
  };
  if (is_exhausted()) {
    answer_->within_work_limit = false;
    note_uncertain(order_[pairs_.bundles()[open_[list.begin].bundle].first]);
    return;
  }
  const double middle = posture_.trajectory().middle(stretch);
  place(stretch, middle);
  const bool divides = can_divide(stretch, middle);
  const bool one_limit = contacts_.empty() && exempt_.empty();
  OpenList left{list.end, list.end};
  for (std::size_t k = list.begin; k < list.end; ++k) {
    const Bundle& bundle = pairs_.bundles()[open_[k].bundle];
    const TipMotion motion = tip_motion(bundle, stretch, middle, posture_);
    std::uint32_t* const order = &order_[bundle.first];
    std::uint32_t count = open_[k].count, kept = 0;
    if (one_limit) count = near_ones(bundle, count, motion, answer.margin);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t pair = order[i];
      const Pair at = pair_at(pair, motion);
      const double limit = limit_until(stretch.to, false, pair, answer.margin);
      if (limit == -kInfinity) continue;
      const double enough = limit != 0.0 ? limit : 1e-300;
      double apart = gap(at, pair, rounded_up(enough + at.loss));
      // Boxes and spheres say nothing of a depth.
      if (limit < 0.0 && apart < 0.0) apart = -kInfinity;
      double lower = rounded_down(apart - at.loss);
      if (proves(lower, limit)) continue;
      const double size = at.tip.sphere_in_world.radius;
      const bool may_be_below = apart - at.approach.nearing.until_middle < enough;
      const bool may_decide = apart + size >= enough + kShareAlongNormal * at.loss;
      bool below = false, near = false, unclear = false;
      if (may_be_below || may_decide || !divides) {
        const PairAtMiddle found = query(at, pair);
        lower = std::max(lower, lower_over(found, at.base, at.tip, bundle.keeps_direction, motion,
                                           at.approach, enough));
        // An object that may move without a limit may be at any depth.
        const double nearing = at.approach.nearing.until_middle;
        const double upper =
            nearing < kInfinity ? rounded_up(found.upper + motion.error - nearing) : -kInfinity;
        note_upper(found, std::max(0.0, upper), middle, pair);
        if (proves(lower, limit)) continue;
        below = is_below(upper, limit_until(middle, true, pair, answer.margin));
        near = !below && lower >= limit - question_->margin_tolerance &&
               upper <= limit + question_->margin_tolerance;
        // No division helps where the distance at the middle itself is not known well enough.
        unclear = !below && rounded_down(found.lower - bundle.model_error - nearing) < limit &&
                  found.upper - found.lower + bundle.model_error > question_->margin_tolerance &&
                  stretch.to - stretch.from <= kUnclear * duration_;
      }
      if (below && (!found_ || middle < answer.below_at)) {
        found_ = true;
        answer.below_at = middle;
        note_pair(pair, answer.first, answer.second);
      }
      const bool located = found_ && answer.below_at <= stretch.to &&
                           answer.below_at - stretch.from <= question_->instant * duration_;
      if (near || unclear || located || !divides) {
        note_uncertain(pair);
        continue;
      }
      std::swap(order[kept++], order[i]);
    }
    if (kept > 0) open_[left.end++] = {open_[k].bundle, kept};
  }
  if (!left.is_empty()) find_first_in_halves(stretch, middle, left, answer);
}

void MotionSearch::find_first_in_halves(const Stretch& stretch, double middle, const OpenList& list,
                                        MarginAnswer& answer) noexcept {
  const Stretch whole = posture_.trajectory().whole();
  const bool is_whole = stretch.from == whole.from && stretch.to == whole.to;
  if (is_whole && proven_until_ <= whole.from) {
    // The first instant by itself: otherwise a motion that begins too near is divided to the end.
    const bool was_uncertain = uncertain_;
    find_first({0, 0, whole.from, whole.from}, list, answer);
    if (!found_) uncertain_ = was_uncertain;
  }
  find_first(Trajectory::before(stretch, middle), list, answer);
  find_first(Trajectory::after(stretch, middle), list, answer);
}

}  // namespace clearance
