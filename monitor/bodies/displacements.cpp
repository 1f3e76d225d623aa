#include "monitor/bodies/displacements.hpp"

#include <algorithm>
#include <utility>

#include "monitor/bodies/directed_rounding.hpp"

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

std::int64_t stamp_of(const InputRecord& input) noexcept {
  return input.has_value && input.ages ? input.stamp_ns : PoseStamps::kNone;
}

// The last time at which the pose in use is not late.
std::int64_t in_time_until(const TrackedObject& state, const Object& object,
                           std::int64_t response_left_ns) noexcept {
  const std::int64_t stamp = stamp_of(state.input);
  const std::int64_t most_ns = std::min(object.age_limit_ns, response_left_ns);
  return stamp == PoseStamps::kNone ? PoseStamps::kNone : less(stamp, -most_ns);
}

}  // namespace

Displacer::Displacer(const Scene& scene) : scene_(scene), is_lost_(scene.objects.size()) {
  displaced_.changed.reserve(scene.objects.size());
  visited_.reserve(scene.objects.size());
  for (const Sensor& sensor : scene.sensors) seen_.push_back(sensor.object);
  std::ranges::sort(seen_);
}

// Links come when the objects on which robots stand have been advanced. What sensors see comes
// last, when all that carries them has been.
void Displacer::displace(Inputs& inputs) noexcept {
  const std::int64_t now_ns = inputs.time.now_ns;
  const std::size_t count = inputs.objects.size(), first_link = inputs.robots.first_link();
  displaced_.changed.clear();
  displaced_.response_is_late = false;
  visited_.clear();
  const bool first = std::exchange(first_, false);
  if (first) {
    for (std::uint32_t i = 0; i < count; ++i) displaced_.changed.push_back(i);
  }
  const auto visit_due = [&](std::size_t i) {
    visit(static_cast<std::uint32_t>(i), first, inputs);
  };
  std::size_t next = 0;
  for (const std::uint32_t seen : seen_) {
    inputs.visits.each_due(next, seen, now_ns, visit_due);
    next = seen + 1;
  }
  inputs.visits.each_due(next, first_link, now_ns, visit_due);
  if (first_link < count) inputs.robots.place(now_ns, inputs.objects, inputs.response_left_ns);
  inputs.visits.each_due(first_link, count, now_ns, visit_due);
  visit_seen(first, inputs);
  // A loop for each step, so that no object waits for the roots and quotients of the one before it.
  for (const std::uint32_t i : visited_)
    clearance::displace(inputs.objects[i].bounding_radius, inputs.objects[i]);
  summarise(inputs);
}

// A frame is placed by what was heard of its carrier around its stamp, which a contradiction puts
// in doubt. Later frames are trusted again. A late frame that tf places is not trusted either: a
// contradiction in tf may have ended the frames.
void Displacer::visit_seen(bool first, Inputs& inputs) noexcept {
  for (const std::uint32_t i : seen_) {
    const std::uint32_t sensor = scene_.objects[i].sensor;
    auto& [carrier, lost_ns] = inputs.sensors[sensor];
    const InputRecord& input = inputs.objects[i].input;
    const bool is_lost =
        carrier.kind == RobotBase::Kind::kObject
            ? !inputs.objects[carrier.object].known()
            : carrier.kind == RobotBase::Kind::kLink &&
                  inputs.robots.is_lost(carrier.robot, carrier.link, inputs.objects);
    if (is_lost) lost_ns = inputs.time.now_ns;
    const Trust on_time = scene_.sensors[sensor].is_on_tf() ? Trust::kWhileOnTime : Trust::kAlways;
    visit(i, first, inputs, input.stamp_ns <= lost_ns ? Trust::kNever : on_time);
  }
}

void Displacer::visit(std::uint32_t i, bool first, Inputs& inputs, Trust trust) noexcept {
  TrackedObject& object = inputs.objects[i];
  const bool was_late = object.input.late;
  const double might_have_moved = object.may_have_moved;
  const std::int64_t now_ns = inputs.time.now_ns;
  advance(scene_.objects[i], now_ns, object, trust, inputs.response_left_ns);
  if (!object.follows_joints &&
      object.input.response_is_late(now_ns, scene_.objects[i].age_limit_ns))
    displaced_.response_is_late = true;
  const bool changes =
      object.moved || object.input.late != was_late || object.may_have_moved != might_have_moved;
  if (changes && !first) displaced_.changed.push_back(i);
  visited_.push_back(i);
}

// An object at rest has not moved, and is not late: it adds nothing to the sums.
void Displacer::summarise(Inputs& inputs) noexcept {
  LargestTwo unobserved, farthest;
  for (const std::uint32_t i : visited_) {
    const TrackedObject& object = inputs.objects[i];
    const bool is_lost = !object.known() || object.discontinuous;
    if (is_lost != is_lost_[i]) lost_ = is_lost ? lost_ + 1 : lost_ - 1;
    is_lost_[i] = is_lost;
    inputs.stamps.set(i, stamp_of(object.input));
    if (object.at_rest())
      inputs.visits.rest_until(i,
                               in_time_until(object, scene_.objects[i], inputs.response_left_ns));
    if (!object.known()) continue;
    unobserved.add(object.may_have_moved);
    // An unbounded displacement counts as 0 here, since no pair of such an object is culled. A
    // discontinuity counts as infinite.
    const double displacement = object.known_displacement();
    const double bounded = displacement < kInfinity ? displacement : 0.0;
    farthest.add(object.discontinuous ? kInfinity : rounded_up(object.unobserved + bounded));
  }
  displaced_.any_lost = lost_ > 0;
  displaced_.most_unobserved = unobserved.sum();
  displaced_.most_displaced = farthest.sum();
  inputs.stamps.update();
  displaced_.oldest_pose_ns = inputs.stamps.oldest();
  displaced_.newest_pose_ns = inputs.stamps.newest();
}

}  // namespace clearance
