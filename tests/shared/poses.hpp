// Poses that tests are written with.
#pragma once

#include "core/pose.hpp"

namespace clearance::test {

// Not turned, with the object's origin there, m.
[[nodiscard]] inline Pose at(double x, double y, double z) { return {{x, y, z}, {1, 0, 0, 0}}; }

}  // namespace clearance::test
