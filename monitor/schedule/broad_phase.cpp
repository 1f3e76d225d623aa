#include "monitor/schedule/broad_phase.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/interface/invariant.hpp"

namespace clearance {
namespace {

// m. The rounding of a sum of a few lengths of a cell's size is far less. Farther than 1e4 km from
// the origin, the rounding of the spheres themselves is larger.
constexpr double kSumError = 1e-9;
// An arrived object passes over so many pairs in the time of one that it activates. With thousands
// of objects, the last ones to arrive have met nearly all others.
constexpr std::size_t kPassedPerActivated = 8;
constexpr double kSmoothing = 0.125;   // of the usual displacement: over eight ticks
constexpr double kStandstill = 1e-12;  // m a tick: less counts as no motion
// The slower object's share of the allowance is at least this, in case it suddenly moves fast.
constexpr double kLeastShare = 0.125;

double share_of_a(double usual_a, double usual_b) noexcept {
  const double sum = usual_a + usual_b;
  return sum > 0.0 ? std::clamp(usual_a / sum, kLeastShare, 1.0 - kLeastShare) : 0.5;
}

// The largest distance, m, between the object's position now and its position at any instant since
// the last tick. A discontinuity does not count here: it makes every zone of the object active by
// itself.
double displacement_since_last_tick(const TrackedObject& object) noexcept {
  return object.unobserved + (object.discontinuous ? 0.0 : object.known_displacement());
}

}  // namespace

BroadPhase::BroadPhase(const Scene& scene, const std::vector<PosedPart>& parts,
                       const PairTable& table, const ZoneLevels& zone_levels,
                       std::vector<double> urgent, std::span<const std::uint32_t> left_out,
                       std::size_t most_activated)
    : most_activated_(most_activated),
      most_met_(most_activated / 2),
      bodies_(scene.objects.size()),
      usual_displacement_(scene.objects.size(), 0.0),
      table_(table),
      left_out_(scene.pairs.size(), 0),
      zone_levels_(zone_levels),
      urgent_(std::move(urgent)),
      by_object_(scene),
      wheels_(scene.objects.size(), scene.pairs.size()) {
  const std::vector<BoundingSphere> spheres = bounding_spheres(scene.objects.size(), parts);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i].sphere = spheres[i];
    bodies_[i].fixed = scene.objects[i].fixed;
  }
  for (const std::uint32_t pair : left_out) left_out_[pair] = 1;
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    if (!left_out_[p])
      bodies_[scene.pairs[p].first].idle = bodies_[scene.pairs[p].second].idle = false;
  }
  activated_.reserve(scene.pairs.size());
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].idle) busy_.push_back(i);
  }
  advanced_.reserve(busy_.size());
  arrived_.reserve(bodies_.size());
}

void BroadPhase::begin(const OpenTick& tick, std::span<const std::uint32_t> changed) noexcept {
  largest_advance_ = 0.0;
  advanced_.clear();
  const std::size_t arrived_before = arrived_.size();
  for (double& usual : usual_displacement_)
    usual = usual > kStandstill ? (1.0 - kSmoothing) * usual : 0.0;
  for (const std::uint32_t i : changed) {
    const TrackedObject& object = tick.objects[i];
    if (!object.input.has_value) continue;
    Body& body = bodies_[i];
    if (body.forgotten || !(object.displacement < kInfinity)) jump(i, tick.table);
    body.forgotten = false;
    if (body.idle) continue;
    if (object.moved) body.placed = false;
    if (!body.arrival.has_arrived()) arrive(i, object);
    double by = object.displacement < kInfinity ? object.displacement : 0.0;
    usual_displacement_[i] += kSmoothing * by;
    if (object.may_have_moved < kInfinity) {
      by += std::max(0.0, object.may_have_moved - body.may_have_moved);
      body.may_have_moved = object.may_have_moved;
    }
    if (!(by > 0.0)) continue;
    wheels_.advance(i, rounded_up(by));
    advanced_.push_back(i);
    largest_advance_ = std::max(largest_advance_, rounded_up(by));
  }
  take_due(overdue_ ? busy_ : advanced_);
  // An arriving object costs as much as a pair that is met for the first time.
  const std::size_t arrived = std::min(arrived_.size() - arrived_before, most_met_);
  pair_arrivals(most_met_ - arrived);
}

void BroadPhase::arrive(std::uint32_t object, const TrackedObject& state) noexcept {
  bodies_[object].state = &state;
  bodies_[object].arrival.rank = static_cast<std::uint32_t>(arrived_.size());
  arrived_.push_back(object);
}

void BroadPhase::forget_object(std::uint32_t object, PairTable& table) noexcept {
  bodies_[object].forgotten = true;
  for (const std::uint32_t pair : by_object_.pairs_of(object)) forget_pair(pair, table);
}

void BroadPhase::jump(std::uint32_t object, PairTable& table) noexcept {
  for (const std::uint32_t pair : by_object_.pairs_of(object)) {
    forget_bounds(pair, table);
    if (is_culled(pair)) activate(pair);
  }
}

void BroadPhase::activate(std::uint32_t pair) noexcept {
  wheels_.cancel(2 * pair);
  wheels_.cancel(2 * pair + 1);
  activated_.push_back(pair);
}

// Activates the pairs of objects that have become known, each pair once. Objects take turns in the
// order of their arrival. A pair is activated in the first turn of one of its objects at which the
// other has arrived as well. When all objects arrive at once, pairs are thus visited in memory
// order.
void BroadPhase::pair_arrivals(std::size_t most) noexcept {
  std::size_t passes = kPassedPerActivated * most;
  for (most += activated_.size(); !everyone_met();) {
    const std::uint32_t object = arrived_[met_];
    Arrival& arrival = bodies_[object].arrival;
    if (met_pairs_ == 0) arrival.met = static_cast<std::uint32_t>(arrived_.size());
    const auto pairs = by_object_.pairs_of(object);
    for (; met_pairs_ < pairs.size(); ++met_pairs_) {
      if (activated_.size() >= most || passes == 0) return;
      --passes;
      const auto [a, b] = ends(pairs[met_pairs_]);
      const Arrival& other = bodies_[a == object ? b : a].arrival;
      const bool met_before = other.rank < arrival.rank && arrival.rank < other.met;
      if (met_before || other.rank >= arrival.met) continue;
      if (!left_out_[pairs[met_pairs_]]) activated_.push_back(pairs[met_pairs_]);
    }
    met_pairs_ = 0;
    ++met_;
  }
}

// Activates the pairs whose timers on these objects' wheels are due. No other object has timers
// that are due.
void BroadPhase::take_due(std::span<const std::uint32_t> objects) noexcept {
  const bool all = std::all_of(objects.begin(), objects.end(), [this](std::uint32_t object) {
    return wheels_.take_due(object, most_activated_, activated_);
  });
  // A timer that is left on its wheel became due in this tick, or its pair has waited since an
  // earlier one. So W loses no more than this tick's advances of both objects.
  const double overtaken = rounded_up(2.0 * largest_advance_);
  const double lower = overdue_ ? std::min(overdue_lower_, horizon_) : horizon_;
  if (!all) overdue_lower_ = rounded_down(lower - overtaken);
  overdue_ = !all;
}

double BroadPhase::waiting_lower() const noexcept {
  if (!everyone_met()) return -kInfinity;
  return overdue_ ? overdue_lower_ : kInfinity;
}

// max(H, Z) + U, m: at this distance or farther, a pair is neither the minimum nor in a zone. U
// also counts the displacement since the last tick. Both H and Z are raised by the margin that
// makes the pair active well before it is urgent.
double BroadPhase::level_of(std::uint32_t pair) const noexcept {
  const auto [a, b] = ends(pair);
  const double urgent = urgent_[a] + urgent_[b];
  const double since = displacement_since_last_tick(*bodies_[a].state) +
                       displacement_since_last_tick(*bodies_[b].state);
  const double zones = zone_levels_.largest_threshold(pair) + urgent;
  return std::max(std::max(horizon_, urgent), zones) + since + kSumError;
}

bool BroadPhase::is_far(std::uint32_t pair, double lower) const noexcept {
  return horizon_ > -kInfinity && lower > level_of(pair);
}

bool BroadPhase::cull(std::uint32_t pair, double lower) noexcept {
  if (!(horizon_ > -kInfinity)) return false;
  const auto [a, b] = ends(pair);
  const Body& body_a = bodies_[a];
  const Body& body_b = bodies_[b];
  // s, at most L - max(H, Z) - U; the last term is for its rounding where L is large.
  const double allowance = lower - level_of(pair) - 0x1p-51 * std::abs(lower);
  const double usual = usual_displacement_[a] + usual_displacement_[b];
  if (!(allowance >= kLeastAllowance + kLeastTicks * usual)) return false;
  CLEARANCE_INVARIANT(lower - allowance >= level(pair, horizon_));
  // A fixed object needs no part of the allowance.
  if (body_b.fixed) return wheels_.set(2 * pair, a, allowance);
  if (body_a.fixed) return wheels_.set(2 * pair + 1, b, allowance);
  const double share = share_of_a(usual_displacement_[a], usual_displacement_[b]);
  const double part_a = rounded_down(allowance * share);
  const double part_b = rounded_down(allowance - part_a);
  CLEARANCE_INVARIANT(part_a > 0.0 && part_b > 0.0 && part_a + part_b <= allowance);
  if (!wheels_.set(2 * pair, a, part_a)) return false;
  if (wheels_.set(2 * pair + 1, b, part_b)) return true;
  wheels_.cancel(2 * pair);
  return false;
}

// The level of level_of() without its margins, for the motion alone that is unobserved now, m.
double BroadPhase::level(std::uint32_t pair, double horizon) const noexcept {
  return std::max(horizon, zone_levels_.largest_threshold(pair)) +
         bodies_[ends(pair).a].state->may_have_moved + bodies_[ends(pair).b].state->may_have_moved;
}

bool BroadPhase::is_culled(std::uint32_t pair) const noexcept {
  return wheels_.is_set(2 * pair) || wheels_.is_set(2 * pair + 1);
}

// D - U >= H and Z; only D >= W while some pairs' timers are overdue.
bool BroadPhase::may_be_culled(std::uint32_t pair, double upper) const noexcept {
  if (!is_culled(pair)) return true;
  const TrackedObject& a = *bodies_[ends(pair).a].state;
  const TrackedObject& b = *bodies_[ends(pair).b].state;
  if (!a.known() || !b.known()) return true;
  return overdue_ ? upper >= std::min(horizon_, overdue_lower_) : upper >= level(pair, horizon_);
}

void BroadPhase::check_some() noexcept {
  for (std::uint32_t i = 0; i < std::min<std::size_t>(kCheckedPerTick, left_out_.size()); ++i) {
    next_checked_ = next_checked_ + 1 < left_out_.size() ? next_checked_ + 1 : 0;
    if (!is_culled(next_checked_)) continue;
    CLEARANCE_INVARIANT(may_be_culled(next_checked_, by_spheres(next_checked_).upper));
  }
}

const Sphere& BroadPhase::sphere_of(Body& body) noexcept {
  if (!body.placed) body.sphere_in_world = placed(body.sphere, body.state->pose);
  body.placed = true;
  return body.sphere_in_world;
}

DistanceBounds BroadPhase::by_spheres(std::uint32_t pair) noexcept {
  const Sphere& a = sphere_of(bodies_[ends(pair).a]);
  const Sphere& b = sphere_of(bodies_[ends(pair).b]);
  const double error = table_.largest_error(table_.first_part_pair(pair));
  return widened({.lower = least_between(a, b), .upper = most_between(a, b)}, error);
}

// The horizon is raised by d as if every object had moved by d.
void BroadPhase::move_horizon(double to) noexcept {
  if (to > horizon_ && horizon_ > -kInfinity) {
    const double by = rounded_up(to - horizon_);
    for (const std::uint32_t i : busy_) wheels_.advance(i, by);
    largest_advance_ = by;
    horizon_ = to;
    take_due(busy_);
    return;
  }
  horizon_ = to;
}

}  // namespace clearance
