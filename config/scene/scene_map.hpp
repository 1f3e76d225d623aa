// Tells which objects, joints and zones of a changed scene are those of the scene before it.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

// Indices into one scene by indices into the other; kNone: the other scene has no such thing.
struct SceneMap {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  // By index in the changed scene: the index in the scene before.
  std::vector<std::uint32_t> objects, robots, variables, zones;
  std::vector<std::uint32_t> contact_pairs;  // indices into contact_pairs() of both scenes
  // By index in the scene before: the index in the changed scene.
  std::vector<std::uint32_t> objects_now, variables_now;
};

// Things correspond by their names. What is known of an input stays valid only if the same source
// sends it in the same manner. So these have no counterpart:
//  - an object that is fixed in one of the scenes, since its state follows from the scene;
//  - an object that is a robot's link in one scene only, or of another robot, or of a robot whose
//    joints or base are placed otherwise, or held otherwise, or whose base has no counterpart;
//  - an object or joint variable for which the scenes state different sources or frames;
//  - an object that is absent by one of the scenes;
//  - a robot whose joint variables are not all the same, or that is another person, or whose base
//    or joints come from another frame or topic, with its links and variables.
// A pair of a contact has a counterpart if a contact of the same name, depth and end is allowed for
// objects of the same names. Any other allowance begins anew.
//
// A pose or position that was sent for the scene before is passed on by `objects_now` and
// `variables_now`, which need the name and the same person, frame and topic.
[[nodiscard]] SceneMap scene_map(const Scene& before, const Scene& now);

}  // namespace clearance
