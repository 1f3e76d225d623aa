#include "monitor/broad_phase/broad_phase.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

// A pair with less slack than this is cheaper awake: it would be back within a few ticks.
constexpr double kLeastSlack = 16.0 * MotionWheels::kUnit;  // 4 mm
constexpr double kLeastTicks = 4.0;                         // of both objects' usual travel
// Sums of a few doubles of a cell's size are off by far less, m; beyond 1e4 km from the origin the
// balls' own rounding takes over.
constexpr double kSumError = 1e-9;
constexpr double kSmoothing = 0.125;  // of usual travel: eight ticks
constexpr double kRest = 1e-12;       // m a tick: none
// The slower object's part of the slack is no less than this, in case it darts.
constexpr double kLeastShare = 0.125;

double share_of_a(double usual_a, double usual_b) noexcept {
  const double sum = usual_a + usual_b;
  return sum > 0.0 ? std::clamp(usual_a / sum, kLeastShare, 1.0 - kLeastShare) : 0.5;
}

// How far from where it is now the object may have been since the last tick, m. After a leap every
// zone of it says so itself.
double strayed_since(const TrackedObject& object) noexcept {
  return object.unseen_since + (object.leapt ? 0.0 : object.travel_since());
}

}  // namespace

BroadPhase::BroadPhase(const Scene& scene, const std::vector<PosedPart>& parts, Levels levels,
                       std::span<const std::uint32_t> left_out, std::size_t most_woken)
    : most_woken_(most_woken),
      most_met_(most_woken / 2),
      bodies_(scene.objects.size()),
      usual_travel_(scene.objects.size(), 0.0),
      left_out_(scene.pairs.size(), 0),
      levels_(std::move(levels)),
      first_pair_(scene.objects.size() + 1, 0),
      pairs_(2 * scene.pairs.size()),
      others_(2 * scene.pairs.size()),
      wheels_(scene.objects.size(), scene.pairs.size()) {
  const std::vector<BoundingSphere> balls = bounding_spheres(scene.objects.size(), parts);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i].ball = balls[i];
    bodies_[i].fixed = scene.objects[i].fixed;
  }
  for (const std::uint32_t pair : left_out) left_out_[pair] = 1;
  object_a_.reserve(scene.pairs.size());
  object_b_.reserve(scene.pairs.size());
  for (const ObjectPair& pair : scene.pairs) {
    object_a_.push_back(pair.first);
    object_b_.push_back(pair.second);
    ++first_pair_[pair.first + 1];
    ++first_pair_[pair.second + 1];
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) first_pair_[i + 1] += first_pair_[i];
  std::vector<std::uint32_t> next(first_pair_.begin(), first_pair_.end() - 1);
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    const std::uint32_t a = object_a_[p], b = object_b_[p];
    others_[next[a]] = b;
    others_[next[b]] = a;
    pairs_[next[a]++] = pairs_[next[b]++] = p;
    if (!left_out_[p]) bodies_[a].idle = bodies_[b].idle = false;
  }
  woken_.reserve(scene.pairs.size());
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].idle) busy_.push_back(i);
  }
  advanced_.reserve(busy_.size());
  arrived_.reserve(bodies_.size());
}

void BroadPhase::begin(const std::vector<TrackedObject>& objects,
                       std::span<const std::uint32_t> changed, PairTable& table) noexcept {
  farthest_travel_ = 0.0;
  advanced_.clear();
  const std::size_t arrived_before = arrived_.size();
  for (double& usual : usual_travel_) usual = usual > kRest ? (1.0 - kSmoothing) * usual : 0.0;
  for (const std::uint32_t i : changed) {
    const TrackedObject& object = objects[i];
    if (!object.seen) continue;
    Body& body = bodies_[i];
    if (!(object.travel < kInfinity)) jump(i, table);
    if (body.idle) continue;
    if (object.moved) body.placed = false;
    if (!body.arrival.here()) arrive(i, object);
    double by = object.travel < kInfinity ? object.travel : 0.0;
    usual_travel_[i] += kSmoothing * by;
    if (object.may_have_moved < kInfinity) {
      by += std::max(0.0, object.may_have_moved - body.may_have_moved);
      body.may_have_moved = object.may_have_moved;
    }
    if (!(by > 0.0)) continue;
    wheels_.advance(i, rounded_up(by));
    advanced_.push_back(i);
    farthest_travel_ = std::max(farthest_travel_, rounded_up(by));
  }
  take_due(overdue_ ? busy_ : advanced_);
  // To take in an object that arrives costs as much as to meet a pair.
  const std::size_t arrived = std::min(arrived_.size() - arrived_before, most_met_);
  meet_arrivals(most_met_ - arrived);
}

void BroadPhase::arrive(std::uint32_t object, const TrackedObject& state) noexcept {
  bodies_[object].state = &state;
  bodies_[object].arrival.rank = static_cast<std::uint32_t>(arrived_.size());
  arrived_.push_back(object);
}

void BroadPhase::jump(std::uint32_t object, PairTable& table) noexcept {
  for (const std::uint32_t pair : pairs_of(object)) {
    forget(pair, table);
    if (wheels_.is_set(2 * pair) || wheels_.is_set(2 * pair + 1)) wake(pair);
  }
}

void BroadPhase::wake(std::uint32_t pair) noexcept {
  wheels_.cancel(2 * pair);
  wheels_.cancel(2 * pair + 1);
  woken_.push_back(pair);
}

// Every pair is met once: in the turn of the first of its objects, if the other is there by then;
// so that pairs are met in the order in which they lie in memory when all objects come at once.
void BroadPhase::meet_arrivals(std::size_t most) noexcept {
  for (most += woken_.size(); !everyone_met();) {
    const std::uint32_t object = arrived_[met_];
    Arrival& own = bodies_[object].arrival;
    if (met_pairs_ == 0) own.met = static_cast<std::uint32_t>(arrived_.size());
    const std::uint32_t first = first_pair_[object];
    const std::uint32_t count = first_pair_[object + 1] - first;
    for (; met_pairs_ < count; ++met_pairs_) {
      if (woken_.size() >= most) return;
      const Arrival& other = bodies_[others_[first + met_pairs_]].arrival;
      const bool met_before = other.rank < own.rank && own.rank < other.met;
      if (met_before || other.rank >= own.met) continue;
      const std::uint32_t pair = pairs_[first + met_pairs_];
      if (!left_out_[pair]) woken_.push_back(pair);
    }
    met_pairs_ = 0;
    ++met_;
  }
}

// Of these objects, and there are none due of others.
void BroadPhase::take_due(std::span<const std::uint32_t> objects) noexcept {
  const bool all = std::all_of(objects.begin(), objects.end(), [this](std::uint32_t object) {
    return wheels_.take_due(object, most_woken_, woken_);
  });
  // A hook that is due has been so for no longer than its pair has been overdue.
  const double overtaken = rounded_up(2.0 * farthest_travel_);
  const double lower = overdue_ ? std::min(overdue_lower_, horizon_) : horizon_;
  if (!all) overdue_lower_ = rounded_down(lower - overtaken);
  overdue_ = !all;
}

double BroadPhase::pending_lower() const noexcept {
  return everyone_met() ? overdue_lower_ : -kInfinity;
}

double BroadPhase::level_of(std::uint32_t pair) const noexcept {
  const std::uint32_t a = object_a_[pair], b = object_b_[pair];
  const double near = std::max(horizon_, levels_.urgent[a] + levels_.urgent[b]);
  const double since = strayed_since(*bodies_[a].state) + strayed_since(*bodies_[b].state);
  return std::max(near, levels_.zones[pair] + since) + kSumError;
}

bool BroadPhase::is_far(std::uint32_t pair, double lower) const noexcept {
  return horizon_ > -kInfinity && lower > level_of(pair);
}

bool BroadPhase::sleep(std::uint32_t pair, double lower) noexcept {
  if (!(horizon_ > -kInfinity)) return false;
  const std::uint32_t a = object_a_[pair], b = object_b_[pair];
  const Body& body_a = bodies_[a];
  const Body& body_b = bodies_[b];
  const double slack = lower - level_of(pair);
  const double usual = usual_travel_[a] + usual_travel_[b];
  if (!(slack >= kLeastSlack + kLeastTicks * usual)) return false;
  if (body_b.fixed) return wheels_.set(2 * pair, a, slack);  // two fixed ones: the horizon's moves
  if (body_a.fixed) return wheels_.set(2 * pair + 1, b, slack);
  const double part_a = rounded_down(slack * share_of_a(usual_travel_[a], usual_travel_[b]));
  if (!wheels_.set(2 * pair, a, part_a)) return false;
  if (wheels_.set(2 * pair + 1, b, rounded_down(slack - part_a))) return true;
  wheels_.cancel(2 * pair);
  return false;
}

const Ball& BroadPhase::ball_of(Body& body) noexcept {
  if (!body.placed) body.ball_in_world = placed(body.ball, body.state->pose);
  body.placed = true;
  return body.ball_in_world;
}

RowBounds BroadPhase::by_balls(std::uint32_t pair) noexcept {
  const Ball& a = ball_of(bodies_[object_a_[pair]]);
  const Ball& b = ball_of(bodies_[object_b_[pair]]);
  return {.lower = least_between(a, b), .upper = most_between(a, b)};
}

// Raising the horizon is every object travelling that far at once.
void BroadPhase::move_horizon(double to) noexcept {
  if (to > horizon_ && horizon_ > -kInfinity) {
    const double by = rounded_up(to - horizon_);
    for (const std::uint32_t i : busy_) wheels_.advance(i, by);
    farthest_travel_ = by;
    horizon_ = to;
    take_due(busy_);
    return;
  }
  horizon_ = to;
}

std::span<const std::uint32_t> BroadPhase::pairs_of(std::uint32_t object) const noexcept {
  return std::span(pairs_).subspan(first_pair_[object],
                                   first_pair_[object + 1] - first_pair_[object]);
}

}  // namespace clearance
