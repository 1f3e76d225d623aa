// The true distance of spheres, capsules, boxes and half-spaces, in long double.
//
// Each core (without the radius) is a centre with generators, c + sum of [-1, 1] g: a box has three
// and a segment one. The Minkowski difference of two such cores is a third one, whose faces are
// spanned by two generators each. All of them are enumerated. It shares nothing with core/.
#pragma once

#include <optional>
#include <vector>

#include "config/scene/scene.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {

// Signed: minus the depth of an overlap. Nothing: a part has another shape.
[[nodiscard]] std::optional<long double> block_distance(const Object& a, const Pose& world_from_a,
                                                        const Object& b, const Pose& world_from_b);

}  // namespace clearance::test
