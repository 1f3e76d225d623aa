// Stage 1 of a tick: the samples that came in become the pose in use of each object.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "monitor/objects/tracked_object.hpp"

namespace clearance {

// What all ticks so far have been told.
struct Inputs {
  std::uint64_t cycle = 0;                                         // counts ticks from 1
  std::int64_t now_ns = std::numeric_limits<std::int64_t>::min();  // never decreases
  std::vector<TrackedObject> objects;                              // as in Scene::objects
  std::array<std::uint64_t, kRejects> rejected{};                  // samples, by cause
};

// Before the first tick.
[[nodiscard]] Inputs initial_inputs(const Scene& scene);

// Begins a tick at `now_ns`, or at the last tick's time if that is later, and takes the samples in
// the given order: one that must not be used is counted and leaves its object as it is.
void ingest(std::span<const PoseSample> samples, std::int64_t now_ns, const Scene& scene,
            Inputs& inputs) noexcept;

// Counts a sample that was refused; of an object that the scene does not have, in the totals only.
void refuse(std::uint32_t object, Reject cause, Inputs& inputs) noexcept;

}  // namespace clearance
