#include "monitor/objects/displacements.hpp"

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

// Sets the bounds over all objects.
void summarise(const std::vector<TrackedObject>& objects, std::span<const std::uint32_t> moving,
               Displacements& displaced) noexcept {
  displaced.any_lost = false;
  displaced.newest_pose_ns = displaced.oldest_pose_ns = 0;
  bool any = false;
  LargestTwo unobserved, farthest;
  for (const std::uint32_t i : moving) {
    const TrackedObject& object = objects[i];
    displaced.any_lost = displaced.any_lost || !object.known() || object.discontinuous;
    if (!object.input.has_value) continue;
    displaced.newest_pose_ns =
        any ? std::max(displaced.newest_pose_ns, object.input.stamp_ns) : object.input.stamp_ns;
    displaced.oldest_pose_ns =
        any ? std::min(displaced.oldest_pose_ns, object.input.stamp_ns) : object.input.stamp_ns;
    any = true;
    if (!object.known()) continue;
    unobserved.add(object.may_have_moved);
    // An unbounded displacement counts as 0 here, since no pair of such an object is culled. A
    // discontinuity counts as infinite.
    const double displacement = object.known_displacement();
    const double bounded = displacement < kInfinity ? displacement : 0.0;
    farthest.add(object.discontinuous ? kInfinity : rounded_up(object.unobserved + bounded));
  }
  displaced.most_unobserved = unobserved.sum();
  displaced.most_displaced = farthest.sum();
}

}  // namespace

std::vector<std::uint32_t> moving_objects(const Scene& scene) {
  std::vector<std::uint32_t> moving;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].fixed) moving.push_back(i);
  }
  return moving;
}

void displace(const Scene& scene, std::span<const std::uint32_t> moving, Inputs& inputs,
              Displacements& displaced) noexcept {
  std::vector<TrackedObject>& objects = inputs.objects;
  displaced.changed.clear();
  if (inputs.cycle == 1) {
    for (std::uint32_t i = 0; i < objects.size(); ++i) displaced.changed.push_back(i);
  }
  // A loop for each step, so that no object waits for the roots and quotients of the one before it.
  bool placed = false;
  for (const std::uint32_t i : moving) {
    // Links come last, when the objects on which robots stand have been advanced.
    if (!placed && i >= inputs.robots.first_link()) {
      inputs.robots.place(inputs.time.now_ns, objects);
      placed = true;
    }
    TrackedObject& object = objects[i];
    const bool was_late = object.input.late;
    const double might_have_moved = object.may_have_moved;
    advance(scene.objects[i], inputs.time.now_ns, object);
    const bool changes =
        object.moved || object.input.late != was_late || object.may_have_moved != might_have_moved;
    if (changes && inputs.cycle > 1) displaced.changed.push_back(i);
  }
  for (const std::uint32_t i : moving) displace(objects[i].bounding_radius, objects[i]);
  summarise(objects, moving, displaced);
}

}  // namespace clearance
