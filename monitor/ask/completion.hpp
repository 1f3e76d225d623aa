// Completes the question of a client by what the daemon knows: positions of joints and poses of
// objects that the client has not stated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/motion_question.hpp"
#include "monitor/interface/present_inputs.hpp"

namespace clearance {

// Adds to `held`, `joints`, `poses`, `seen` and `contacts` what the question lacks. `frames` are
// the last ones of the sensors; their ages are those of the frames in use. Returns why it cannot: a
// sentence that names the inputs which are unknown, late or contradicted, or a joint that is taken
// to stay and moves. Names that the scene lacks stay, for Asker to refuse.
[[nodiscard]] std::optional<std::string> complete(const Scene& scene, const InputState& state,
                                                  std::vector<SeenFrame> frames,
                                                  Question& question);

// The joint whose first waypoint differs most from its present position.
struct StartDeviation {
  double deviation = 0.0;  // rad or m; infinite: the position is not usable
  std::string joint = {};
};
[[nodiscard]] StartDeviation start_deviation(const Scene& scene, const InputState& state,
                                             const JointTrajectory& motion);

}  // namespace clearance
