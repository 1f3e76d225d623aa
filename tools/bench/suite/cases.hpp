// The cases of `clearance-bench --suite`: pairs of bodies on motions with known distances.
//
// Every distance follows from the construction, not from an algorithm:
//   riding  A motion of the benchmark's workloads. B is translated along the normal, so that its
//           distance becomes the one asked for. A translation along the normal keeps both support
//           points, so it changes the distance by exactly its length. Depths are known so
//           for spheres and capsules, whose axes stay disjoint.
//   reported  A pair for which users reported a wrong answer of a library; the name of the case
//           has the number of the report. The motion is made as for `riding`.
//   level   Boxes of one orientation: the distances along the three axes give the distance.
//           Spinning boxes and cans stay above the top face, so the vertical distance counts. The
//           same holds for a box that turns about a corner above a corner.
//   grazing A box above a larger one, tilted by 0.1 to 1e-12 rad: the height of its lowest vertex.
//   deep    A body in the top of a table of 10 x 10 x 1 m: the depth of its lowest point.
// The answers are exact for real numbers. Poses are doubles, so the true distance of the rounded
// poses differs by up to kRoundedPoses.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/bench/workload.hpp"

namespace clearance::bench {

struct SuiteCase {
  std::string kind;         // the class of cases, a row of the table
  double separation = 0.0;  // m, of the motion as a whole; negative: a depth
  Trajectory motion;
  std::vector<double> exact;  // [pose]: m, signed
  double size = 0.0;          // m, bounding radius of the larger body
};

// m: an answer may differ by this from the distance of the rounded poses. The bound is for the
// poses of the cases, whose coordinates are below 13 m.
inline constexpr double kRoundedPoses = 1e-14;

// The classes, in the order of the table.
[[nodiscard]] std::vector<std::string> suite_kinds();

// All cases of a class: `motions` pairs of bodies for each separation, `steps` poses each (at most
// kTrajectorySteps). Seeded: the same on every machine. Throws std::invalid_argument for a name
// that suite_kinds() does not have.
[[nodiscard]] std::vector<SuiteCase> suite_cases(const std::string& kind, int motions, int steps);

}  // namespace clearance::bench
