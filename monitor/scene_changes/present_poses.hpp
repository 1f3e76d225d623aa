// Fills in the poses that changes leave out: where an object is now.
#pragma once

#include <atomic>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/loop/tick_loop.hpp"

namespace clearance {

// Present poses by the name of the object or link. Names that the scene lacks are left out.
using PresentPoses = std::map<std::string, PresentPose>;

// Asks the loop, which ticks this scene, where objects and links are: all at one tick. Returns
// nothing if the loop ends meanwhile.
[[nodiscard]] std::optional<PresentPoses> present_poses(const std::vector<std::string>& names,
                                                        const Scene& scene, TickLoop& loop,
                                                        const std::atomic<bool>& loop_ended);

// Pose of B in the frame of A.
[[nodiscard]] Pose a_from_b(const Pose& world_from_a, const Pose& world_from_b);

// Why a pose cannot be used, as the end of a sentence: "it is absent". Empty: it can.
[[nodiscard]] std::string why_unusable(const PresentPose& pose);

}  // namespace clearance
