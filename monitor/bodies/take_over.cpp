#include "monitor/bodies/take_over.hpp"

namespace clearance {
namespace {

// The body may be another one: what follows from the body stays.
void take_over(const TrackedObject& before, TrackedObject& now) noexcept {
  const Landmarks landmarks = now.landmarks;
  const double bounding_radius = now.bounding_radius;
  now = before;
  now.landmarks = landmarks;
  now.bounding_radius = bounding_radius;
  now.rest.holds = false;
}

}  // namespace

void take_over(const Inputs& before, const SceneMap& map, const Scene& scene,
               SourceNumbers& numbers, Inputs& now) noexcept {
  state_owners(scene, numbers, now);
  now.cycle = before.cycle;
  now.time = before.time;
  now.sources = before.sources;
  now.rejected = before.rejected;
  for (std::size_t i = 0; i < now.objects.size(); ++i) {
    const std::uint32_t old = map.objects[i];
    // A sensor's object is unknown until the next frame. Nothing newer comes of one that is not
    // read: its last pose would stay the oldest one.
    if (old != SceneMap::kNone && !scene.objects[i].is_seen() && scene.objects[i].is_read)
      take_over(before.objects[old], now.objects[i]);
  }
  now.robots.take_over(before.robots, map);
  now.visits.visit_all();
}

void save(const Inputs& inputs, StateWriter& out) {
  out.put(inputs.cycle);
  out.put(inputs.time);
  out.put(std::span(inputs.objects));
  out.put(std::span(inputs.sensors));
  inputs.robots.save(out);
  out.put(inputs.sources);
  out.put(inputs.rejected);
}

void restore(StateReader& in, Inputs& inputs) noexcept {
  in.take(inputs.cycle);
  in.take(inputs.time);
  in.take(std::span(inputs.objects));
  in.take(std::span(inputs.sensors));
  inputs.robots.restore(in);
  in.take(inputs.sources);
  in.take(inputs.rejected);
  inputs.visits.visit_all();
}

}  // namespace clearance
