// Pairs of a robot's own links that its build keeps near each other in every posture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

// Returns the pairs, as indices into Scene::pairs in ascending order, whose distance is certainly
// below `metres` at all positions of the joints between the two links. So no motion of the robot
// could keep that distance.
//
// Only two links of one robot with one or two joint variables between them are examined, within
// the limits of these; for others nothing is proved, and they are not returned. The proof divides
// the box of the variables: the distance in a cell is at most that in its middle, plus what the
// joints displace of either link from there. It takes some ms a pair, and at most a tenth of a
// second.
[[nodiscard]] std::vector<std::uint32_t> kept_nearer(const Scene& scene, double metres);

// One sentence that names these pairs and says how that is known.
[[nodiscard]] std::string kept_nearer_text(const Scene& scene, double metres,
                                           const std::vector<std::uint32_t>& pairs);

}  // namespace clearance
