// Runs a query from every pair of features of the two bodies.
#pragma once

#include <string>

#include "tests/shared/distance_judge.hpp"

namespace clearance::test {

// Describes the first wrong answer and its initial features; empty if all answers are right. The
// initial state may also have no feature of a body. It says that the bodies touched, or that they
// did not.
[[nodiscard]] std::string fault_from_any_start(DistanceJudge& judge, const Pose& pose_a,
                                               const Pose& pose_b);

}  // namespace clearance::test
