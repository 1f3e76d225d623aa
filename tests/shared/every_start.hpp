// A query from every pair of features that the bodies have.
#pragma once

#include <string>

#include "tests/shared/distance_judge.hpp"

namespace clearance::test {

// What the first wrong answer gets wrong, and from where; empty when none is. A body may also have
// no feature to begin at.
[[nodiscard]] std::string fault_from_any_start(DistanceJudge& judge, const Pose& pose_a,
                                               const Pose& pose_b);

}  // namespace clearance::test
