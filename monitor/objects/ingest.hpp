// Stage 1 of a tick: the samples that came in become the pose in use of each object.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "monitor/inputs/source_clock.hpp"
#include "monitor/objects/robot_inputs.hpp"
#include "monitor/objects/tracked_object.hpp"

namespace clearance {

// What all ticks so far have been told.
struct Inputs {
  std::uint64_t cycle = 0;  // counts ticks from 1
  TickTime time{std::numeric_limits<std::int64_t>::min()};
  std::vector<TrackedObject> objects;  // as in Scene::objects
  RobotInputs robots;
  std::array<SourceClock, kMaxSources> sources;    // by PoseSample::source
  std::array<std::uint64_t, kRejects> rejected{};  // samples, by cause
};

// Before the first tick.
[[nodiscard]] Inputs initial_inputs(const Scene& scene);

// Begins a tick and takes the samples in the given order, those of joints first: one that must not
// be used is counted and leaves its object's pose, or its joint's position, as it is.
void ingest(std::span<const PoseSample> samples, std::span<const JointSample> joints,
            const TickTime& time, const Scene& scene, Inputs& inputs) noexcept;

// Counts a sample that was refused; of an object that the scene does not have, in the totals only.
void refuse(std::uint32_t object, Reject cause, Inputs& inputs) noexcept;

}  // namespace clearance
