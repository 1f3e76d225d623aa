#include "monitor/schedule/swept_search.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// The rounding of a direction, and of a centre rotated into another frame, relative to the lengths
// that take part.
constexpr double kDirectionError = 0x1p-44;
constexpr double kLeastGap = 0x1p-20;  // shorter gaps between instants are not divided

struct Meeting {
  double value, at;
};

// The least value of max(left + t * fall_right, right + (1 - t) * fall_left) for 0 <= t <= 1.
Meeting least_between(double left, double fall_right, double right, double fall_left) noexcept {
  const Meeting start{std::max(left, right + fall_left), 0.0};
  const Meeting end{std::max(left + fall_right, right), 1.0};
  Meeting least = start.value <= end.value ? start : end;
  const double t = (right + fall_left - left) / (fall_right + fall_left);
  if (t > 0.0 && t < 1.0) {
    const Meeting crossing{left + t * fall_right, t};
    if (crossing.value < least.value) least = crossing;
  }
  return least;
}

// Places a part at its object's pose after the share `s`, 0 to 1, of the object's motion. The
// part's errors hold for that pose.
void place_between(const InterpolatedMotion& motion, double s, PosedPart& part) noexcept {
  place_at(pose_at(motion, s), part);
  if (s <= 0.0 || s >= 1.0) return;
  const double lengths = motion.from.position.norm() + motion.to.position.norm();
  const double offset = motion.turns ? part.object_from_part.position.norm() : 0.0;
  part.shift_error += kInterpolationError * (lengths + offset);
  if (motion.turns) part.turn_error += kInterpolationError;
}

}  // namespace

SweptSearch::SweptSearch(std::uint32_t part_pair, const TickView& view) noexcept
    : part_pair_(part_pair),
      clouds_(is_of_cloud(part_pair, view) ? view.clouds : nullptr),
      a_(view.parts[view.pairs.part_a(part_pair)]),
      b_(view.parts[view.pairs.part_b(part_pair)]),
      motion_a_(view.objects[a_.object].interpolated()),
      motion_b_(view.objects[b_.object].interpolated()),
      model_error_(view.pairs.largest_error(part_pair)),
      directed_(a_.keeps_direction && b_.keeps_direction),
      tracking_(view.pairs.evaluations[part_pair].tracking) {
  place_between(motion_a_, 0.0, a_);
  place_between(motion_b_, 0.0, b_);
  const RelativeMotion motion_a =
      seen_from(motion_b_, motion_a_, a_.sphere_in_world.centre, a_.sphere_in_world.radius);
  const RelativeMotion motion_b =
      seen_from(motion_a_, motion_b_, b_.sphere_in_world.centre, b_.sphere_in_world.radius);
  from_b_ = motion_a.speed < motion_b.speed;
  relative_ = from_b_ ? motion_a : motion_b;
  for (const Vec3& place :
       {motion_a_.from.position, motion_a_.to.position, motion_b_.from.position,
        motion_b_.to.position, a_.sphere_in_world.centre, b_.sphere_in_world.centre}) {
    direction_error_ += kDirectionError * place.norm();
  }
}

SweptBounds SweptSearch::decide(double level, Budget& budget) noexcept {
  SweptBounds bounds;
  if (!(relative_.speed < kInfinity) || budget.left() < kLeastQueries) return bounds;
  insert(query_at(0.0, budget));
  insert(query_at(1.0, budget));
  while (true) {
    const Gap lowest = lowest_gap();
    bounds.lower = lowest.lower;
    for (std::size_t i = 0; i < size_; ++i)
      bounds.upper = std::min(bounds.upper, instants_[i].upper);
    if (bounds.lower >= level || bounds.upper < level) return bounds;
    const Instant& left = instants_[lowest.before];
    const double width = instants_[lowest.before + 1].s - left.s;
    if (size_ == kMostQueries || budget.left() == 0 || width < kLeastGap) return bounds;
    insert(query_at(left.s + width * std::clamp(lowest.deepest, 0.25, 0.75), budget));
  }
}

SweptSearch::Instant SweptSearch::query_at(double s, Budget& budget) noexcept {
  place_between(motion_a_, s, a_);
  place_between(motion_b_, s, b_);
  DistanceBounds bounds;
  Vec3 normal_in_a = Vec3::Zero();
  if (clouds_ != nullptr) {
    bounds = clouds_->query(part_pair_, a_, b_).bounds;
  } else {
    const DistanceResult found = distance(
        *a_.shape, *b_.shape, relative_pose(a_.world_from_part, b_.world_from_part), tracking_);
    bounds = for_exact_poses(found, a_, b_);
    normal_in_a = found.normal;
  }
  bounds = widened(bounds, model_error_);
  budget.spend();
  Instant instant{.s = s, .lower = bounds.lower, .upper = bounds.upper};
  const PosedPart& other = from_b_ ? a_ : b_;
  const Pose frame = pose_at(from_b_ ? motion_b_ : motion_a_, s);
  const Mat3 into = frame.orientation.normalized().toRotationMatrix().transpose();
  instant.centre = into * (other.sphere_in_world.centre - frame.position);
  // Only a direction that separates bounds the distance at other instants.
  if (directed_ && bounds.lower >= 0.0) {
    instant.normal = into * (a_.world_from_part_rotation * normal_in_a) * (from_b_ ? -1.0 : 1.0);
  }
  return instant;
}

void SweptSearch::insert(const Instant& instant) noexcept {
  std::size_t at = size_++;
  for (; at > 0 && instants_[at - 1].s > instant.s; --at) instants_[at] = instants_[at - 1];
  instants_[at] = instant;
}

SweptSearch::Gap SweptSearch::lowest_gap() const noexcept {
  Gap lowest = gap_after(0);
  for (std::size_t i = 1; i + 1 < size_; ++i) {
    const Gap gap = gap_after(i);
    if (gap.lower < lowest.lower) lowest = gap;
  }
  return lowest;
}

// Counted from either end, the distance falls no faster than the parts approach. It also falls no
// faster than they approach along the direction that separates them at that end.
SweptSearch::Gap SweptSearch::gap_after(std::size_t before) const noexcept {
  const Instant& left = instants_[before];
  const Instant& right = instants_[before + 1];
  const double onward = fall(left, right), back = fall(right, left);
  const Meeting least = least_between(left.lower, onward, right.lower, back);
  const double error = 0x1p-48 * (std::abs(left.lower) + std::abs(right.lower) - onward - back);
  return {.before = before, .lower = least.value - std::abs(error), .deepest = least.at};
}

// A lower bound of the change of the distance from `from` to `to`, m; negative where it may fall.
// Between the two the distance falls at most in proportion.
double SweptSearch::fall(const Instant& from, const Instant& to) const noexcept {
  const double width = std::abs(to.s - from.s);
  const double by_speed = -rounded_up(relative_.speed * width);
  if (from.normal.isZero(0.0)) return by_speed;
  const double bent = relative_.turning * width + 0.5 * relative_.bending * width * width;
  const double along = from.normal.dot(to.centre - from.centre);
  return std::max(by_speed, along - rounded_up(bent + direction_error_));
}

}  // namespace clearance
