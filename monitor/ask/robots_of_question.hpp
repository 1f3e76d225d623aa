// The robots that a question is about.
#pragma once

#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

// True, by robot, for those with a joint that has waypoints, for those that stand on a link of such
// a robot, and for those that carry it: a gripper belongs to its arm. The joints of all others move
// as Question::others says.
[[nodiscard]] std::vector<bool> robots_of_question(const Scene& scene, const Question& question);

}  // namespace clearance
