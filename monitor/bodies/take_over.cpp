#include "monitor/bodies/take_over.hpp"

namespace clearance {
namespace {

// Keeps what follows from the body: bytes and former scenes do not change it.
void keep_body(const TrackedObject& own, TrackedObject& now) noexcept {
  now.landmarks = own.landmarks;
  now.bounding_radius = own.bounding_radius;
}

// The body may be another one.
void take_over(const TrackedObject& before, TrackedObject& now) noexcept {
  const TrackedObject own = now;
  now = before;
  keep_body(own, now);
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

void restore(StateReader& in, const Scene& scene, Inputs& inputs) noexcept {
  constexpr std::uint64_t kMostCycles = std::uint64_t{1} << 62;
  in.take(inputs.cycle);
  in.expect(inputs.cycle < kMostCycles);
  in.take(inputs.time);
  const auto objects = inputs.objects;
  in.take(std::span(inputs.objects));
  for (std::size_t i = 0; i < objects.size(); ++i) {
    in.expect(inputs.objects[i].is_sound(objects[i]));
    in.expect(i >= inputs.robots.first_link() ||
              inputs.objects[i].input.is_of_no_future(inputs.time.now_ns, scene.future_limit_ns));
    // No pose of its own shows that a link is there.
    in.expect(i < inputs.robots.first_link() || inputs.objects[i].absent == objects[i].absent);
    keep_body(objects[i], inputs.objects[i]);
  }
  in.take(std::span(inputs.sensors));
  for (const CarriedSensor& sensor : inputs.sensors) in.expect(has(scene, sensor.carrier));
  inputs.robots.restore(in, inputs.time.now_ns);
  in.take(inputs.sources);
  for (const SourceClock& clock : inputs.sources) in.expect(clock.is_sound());
  in.take(inputs.rejected);
  inputs.visits.visit_all();
}

}  // namespace clearance
