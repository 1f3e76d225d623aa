// Other libraries on the frame of the rows of clouds.
//
// cloud/NAME/build: from the points to the library's structure. cloud/NAME/cold: the distance of
// the nearest point to the box. Counters: max_error, m, against the nearest point by Clearance's
// certified query; mean_error. A positive error is a distance that is too large.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

#include "core/pose.hpp"

namespace clearance::bench {

// nanoflann: a k-d tree of the points. cloud/nanoflann/...: all points that can be nearest, by the
// ball around the box, and the closed form for each. cloud/nanoflann-spheres/...: 27 spheres that
// cover the box, as collision checkers of robots have them.
void register_nanoflann_clouds();

// FCL's distance of a box and an octomap of the points, with leaves of 15 and 25 mm.
void register_octomap_clouds();

// Times `distance` of the box at each place, and compares it with the certified distance of the
// nearest point.
void run_cloud_peer(benchmark::State& state, const std::function<double(const Pose&)>& distance);

}  // namespace clearance::bench
