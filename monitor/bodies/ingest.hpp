// Stage 1 of a tick: turns the samples that came in into the pose in use of each object.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "config/scene/carrier.hpp"
#include "monitor/bodies/large_column.hpp"
#include "monitor/bodies/pose_stamps.hpp"
#include "monitor/bodies/robot_inputs.hpp"
#include "monitor/bodies/tracked_object.hpp"
#include "monitor/bodies/visit_times.hpp"
#include "monitor/inputs/refused_value.hpp"
#include "monitor/inputs/source_clock.hpp"
#include "monitor/inputs/source_numbers.hpp"

namespace clearance {

// The carrier of a sensor at the frame in use. Frames stamped up to `lost_ns`, in the tick's time,
// have no place that is trusted: until then, an input of the carrier was unknown or contradicted.
struct CarriedSensor {
  Carrier carrier;
  std::int64_t lost_ns = std::numeric_limits<std::int64_t>::min();
};

// The state of all inputs, from the samples of all ticks so far.
struct Inputs {
  std::uint64_t cycle = 0;  // counts ticks from 1
  TickTime time{std::numeric_limits<std::int64_t>::min()};
  // The age from which on the response to a value comes too late (Scene::response_limit_ns).
  std::int64_t response_left_ns = kAnyAge;
  LargeColumn<TrackedObject> objects;       // same order as Scene::objects
  std::vector<std::int64_t> age_limits_ns;  // Object::age_limit_ns, side by side
  VisitTimes visits;  // a sample makes its object due, unless the object is at rest
  PoseStamps stamps;  // of the objects that are not fixed
  RobotInputs robots;
  std::vector<CarriedSensor> sensors;
  std::array<SourceClock, kMaxSources> sources;    // indexed by PoseSample::source
  std::array<std::uint64_t, kRejects> rejected{};  // refused samples, by cause
  // For people: by object and by joint variable. No tick reads them, and no partner has them.
  std::vector<RefusedValue> refused_poses, refused_positions;
};

// The state before the first tick.
[[nodiscard]] Inputs initial_inputs(const Scene& scene);

// Sets the owners that the scene states, of inputs that no sample has come for.
void state_owners(const Scene& scene, SourceNumbers& numbers, Inputs& inputs) noexcept;

// Begins a tick and takes the samples in the given order, those of joints first. A sample that must
// not be used is counted. It does not change the pose of its object or the position of its joint.
void ingest(std::span<const PoseSample> samples, std::span<const JointSample> joints,
            const TickTime& time, const Scene& scene, Inputs& inputs) noexcept;

// Counts a refused sample. If the scene has no such object, only the totals count it.
void refuse(std::uint32_t object, Reject cause, Inputs& inputs) noexcept;

}  // namespace clearance
