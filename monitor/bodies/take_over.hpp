// A monitor of a changed scene takes over the inputs of the monitor before it.
#pragma once

#include "config/scene/scene_map.hpp"
#include "monitor/bodies/ingest.hpp"
#include "monitor/inputs/state_bytes.hpp"

namespace clearance {

// Goes on with `before`, the inputs after a tick of the scene before. `now` has the initial inputs
// of the changed scene and the bounding radii of its objects. `map` is that of the two scenes.
// Everything that has no counterpart keeps its initial state, with the owner that the changed scene
// states. `numbers` has numbered the sources of `before`. Does not allocate.
void take_over(const Inputs& before, const SceneMap& map, const Scene& scene,
               SourceNumbers& numbers, Inputs& now) noexcept;

// The same through bytes, for inputs of the same scene in another process.
void save(const Inputs& inputs, StateWriter& out);
void restore(StateReader& in, const Scene& scene, Inputs& inputs) noexcept;

}  // namespace clearance
