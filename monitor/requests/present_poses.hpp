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

// Returns where the joint variables of the scene are, in their order, likewise.
[[nodiscard]] std::optional<std::vector<PresentJoint>> present_joints(
    const Scene& scene, TickLoop& loop, const std::atomic<bool>& loop_ended);

// Null: the scene has no robot of this name.
[[nodiscard]] const Robot* find_robot(const Scene& scene, const std::string& name) noexcept;

// Null: the scene has no such object.
[[nodiscard]] const Object* find_object(const Scene& scene, const std::string& name) noexcept;

// The carrier of an attached object or of a robot's root link, and the pose in its frame.
struct AttachedCarrier {
  std::string name;
  Pose carrier_from_object;
};
// Returns nothing if nothing moves the object: it is not attached, or to what is fixed.
[[nodiscard]] std::optional<AttachedCarrier> carrier_of(const std::string& name,
                                                        const Scene& scene);

// The names, and those of the objects and links that carry them in this scene.
[[nodiscard]] std::vector<std::string> with_carriers(const std::vector<std::string>& names,
                                                     const Scene& scene);

// Returns where an object or a link of a changed scene is, before the loop ticks that: what is
// attached is where its carrier takes it, and what is fixed is where the scene says. Anything else
// is where the loop has it in `running`, by `present`, if its poses go on.
[[nodiscard]] PresentPose pose_in_changed(const std::string& name, const Scene& changed,
                                          const Scene& running, const PresentPoses& present);

// Pose of B in the frame of A.
[[nodiscard]] Pose a_from_b(const Pose& world_from_a, const Pose& world_from_b);

// Why a pose cannot be used, as the end of a sentence: "it is absent". Empty: it can.
[[nodiscard]] std::string why_unusable(const PresentPose& pose);

}  // namespace clearance
