// The places of robots' links along a motion, for pictures. No answer depends on them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

struct PathFrame {
  struct Placed {
    std::uint32_t object = 0;  // a link; index into Scene::objects
    Pose world_from_object;
  };
  double time = 0.0;  // s, of the waypoints
  std::vector<Placed> links;
};

// The links that joints with waypoints move: at `count` instants, at least two, that divide the
// motion evenly, and at the instants `more`, in the order of time. `positions` are those of all
// variables at present, NaN where they are not known: joints of Question::held and with waypoints
// need none. `carriers`, by robot: the pose of the object on which it stands, or anything. Links
// behind a joint without a position are left out. Empty if the motion has faults.
[[nodiscard]] std::vector<PathFrame> path_frames(const Scene& scene, const Question& question,
                                                 std::span<const double> positions,
                                                 std::span<const Pose> carriers, std::size_t count,
                                                 std::span<const double> more);

}  // namespace clearance
