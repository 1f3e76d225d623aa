// The distance over time: the stretch whose bounds are farthest apart is divided next.
#include <algorithm>
#include <cmath>

#include "monitor/ask/motion_search.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {

bool MotionSearch::is_in_profile(const ProfileRequest& request, std::uint32_t pair) const noexcept {
  if (request.first.empty() && request.second.empty()) return true;
  std::uint32_t first = 0, second = 0;
  note_pair(pair, first, second);
  const std::string &a = scene_.objects[first].name, &b = scene_.objects[second].name;
  return (a == request.first && b == request.second) || (a == request.second && b == request.first);
}

void MotionSearch::make_profile(const ProfileRequest& request) {
  OpenList all = all_pairs();
  if (!request.first.empty()) {
    OpenList named{all.begin, all.begin};
    for (std::size_t k = all.begin; k < all.end; ++k) {
      std::uint32_t* const order = &order_[pairs_.bundles()[open_[k].bundle].first];
      std::uint32_t kept = 0;
      for (std::uint32_t i = 0; i < open_[k].count; ++i) {
        if (is_in_profile(request, order[i])) std::swap(order[kept++], order[i]);
      }
      if (kept > 0) open_[named.end++] = {open_[k].bundle, kept};
    }
    all = named;
  }
  if (all.is_empty()) return;
  profiled_ = all;
  pieces_.clear();
  pieces_.push_back({.stretch = posture_.trajectory().whole(), .point = {.upper = kInfinity}});
  bound_piece(pieces_.back());
  while (pieces_.size() < request.most_points) {
    const Piece& widest = pieces_.front();
    if (!widest.divides || widest.width() <= request.tolerance) break;
    if (is_exhausted()) {
      answer_->within_work_limit = false;
      break;
    }
    std::pop_heap(pieces_.begin(), pieces_.end());
    Piece before = pieces_.back(), after = before;
    const double middle = posture_.trajectory().middle(before.stretch);
    before.stretch = Trajectory::before(before.stretch, middle);
    after.stretch = Trajectory::after(after.stretch, middle);
    bound_piece(before);
    bound_piece(after);
    pieces_.back() = before;
    std::push_heap(pieces_.begin(), pieces_.end());
    pieces_.push_back(after);
    std::push_heap(pieces_.begin(), pieces_.end());
  }
  for (const Piece& piece : pieces_) answer_->profile.push_back(piece.point);
  std::sort(answer_->profile.begin(), answer_->profile.end(),
            [](const ProfilePoint& a, const ProfilePoint& b) { return a.from < b.from; });
}

// Bounds of an earlier, longer stretch hold in this one, too: they are in piece.point.
void MotionSearch::bound_piece(Piece& piece) noexcept {
  const Stretch& stretch = piece.stretch;
  const double middle = posture_.trajectory().middle(stretch);
  place(stretch, middle);
  ProfilePoint& point = piece.point;
  point.from = stretch.from;
  point.to = stretch.to;
  piece.divides = can_divide(stretch, middle);
  piece.stated = 0.0;
  double lower = kInfinity, upper = kInfinity, closest = kInfinity;
  const auto look_at = [&](std::uint32_t pair, const Bundle& bundle, const TipMotion& motion) {
    const Pair at = pair_at(pair, motion);
    const double apart = rounded_down(gap(at, pair, rounded_up(upper + at.loss)) - at.loss);
    if (apart >= upper) return;
    const PairAtMiddle found = query(at, pair);
    lower =
        std::min(lower, std::max(apart, lower_over(found, at.base, at.tip, bundle.keeps_direction,
                                                   motion, at.approach, kInfinity)));
    piece.stated = std::max(piece.stated, 2.0 * bundle.model_error);
    upper = std::min(upper, upper_over(found, at.tip, motion, at.approach));
    const double now = std::max(0.0, found.upper + motion.error - at.approach.nearing.until_middle);
    if (now < closest) {
      closest = now;
      note_pair(pair, point.first, point.second);
      note_upper(found, rounded_up(now), middle, pair);
    }
  };

  // The pair that seems closest is first: it decides which others can matter.
  std::uint32_t first = 0;
  double least = kInfinity;
  std::size_t first_list = profiled_.begin;
  for (std::size_t k = profiled_.begin; k < profiled_.end; ++k) {
    const Bundle& bundle = pairs_.bundles()[open_[k].bundle];
    const std::uint32_t* const order = &order_[bundle.first];
    const std::uint32_t count = near_ones(bundle, open_[k].count, {}, least);
    for (std::uint32_t i = 0; i < count; ++i) {
      const double apart = gap(pair_at(order[i], {}), order[i], least);
      if (apart < least || (k == profiled_.begin && i == 0)) {
        least = apart;
        first = order[i];
        first_list = k;
      }
    }
  }
  const Bundle& of_first = pairs_.bundles()[open_[first_list].bundle];
  look_at(first, of_first, tip_motion(of_first, stretch, middle, posture_));
  for (std::size_t k = profiled_.begin; k < profiled_.end; ++k) {
    const Bundle& bundle = pairs_.bundles()[open_[k].bundle];
    const TipMotion motion = tip_motion(bundle, stretch, middle, posture_);
    const std::uint32_t count = near_ones(bundle, open_[k].count, motion, upper);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t pair = order_[bundle.first + i];
      if (pair != first) look_at(pair, bundle, motion);
    }
  }
  point.lower = std::max(point.lower, std::min(lower, upper));
  point.upper = std::max(point.lower, std::min(point.upper, upper));
}

}  // namespace clearance
