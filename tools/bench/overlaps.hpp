// Pairs of penetrating bodies, to measure the cost of a depth (tools/bench/measured/report.md,
// "Overlapping").
#pragma once

#include <string>
#include <vector>

#include "tools/bench/workload.hpp"

namespace clearance::bench {

inline constexpr const char* kOverlapKinds[] = {"boxes", "links", "f10", "v10", "f40", "v40"};

// One distance of the bodies' origins.
struct OverlapDepth {
  const char* name;
  double apart;  // as a share of the distance at which the bodies touch
};
inline constexpr OverlapDepth kOverlapDepths[] = {
    {"shallow", 0.97}, {"half", 0.5}, {"near", 0.1}, {"nearer", 0.01}, {"middle", 0.0}};

// Ten trajectories of 100 steps, in which B oscillates by a hundredth of the distance and by 0.01
// rad.
[[nodiscard]] std::vector<Trajectory> overlapping(const std::string& kind,
                                                  const OverlapDepth& depth);

// The names of all kinds and depths for workload(): "boxes/shallow", ...
[[nodiscard]] std::vector<std::string> overlap_names();

}  // namespace clearance::bench
