// The rows of clearance-bench, by the file that registers them.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/bench/solver_rows.hpp"

namespace clearance::bench {

// tracked/f2 ... cold/v40: the core on every workload. For the thesis: facet-balls, and
// interval/N/f2.
void register_ours(RowSet set);

// nearness/cold/KIND/GAP and nearness/tracked/KIND/GAP for every kind of nearness.cpp, with 60
// random pairs at each gap. Gaps are 1e-9 to 1e3 of the bodies' larger semi-axes. They show whether
// a query of curved bodies costs more for nearer or thinner bodies. Counters: iterations, the mean
// number of support points; most_iterations; wide, the queries whose bounds differ by more than
// 1e-13 of sizes and distance.
void register_nearness();

// robot/kinematics/NAME, robot/tick/poses/NAME, robot/tick/joints/NAME and
// robot/tick/gradients/NAME for each of these cells that has a robot. They measure the cost of
// kinematics, and of a tick with and without it.
void register_robots(const std::vector<std::filesystem::path>& cells);

// cloud/build/..., cloud/cold/..., cloud/tracked/... and cloud/brute_force/balls: a made frame of
// 640 x 480 pixels as slabs and as balls, and the element nearest to a box. Times are a frame and a
// query. Counters: pixels; queries, the mean number of the core's; widest_gap, m.
void register_clouds();

// cloud/tick/with and cloud/tick/without: one tick of an arm of seven links (20 boxes) with and
// without the pairs of a camera, whose frames of 307,200 slabs come at 30 Hz. Counters, us: p50,
// p99, p999, max; queries a tick.
//
// cloud/tick/deep/boxes and cloud/tick/deep/cylinders: ticks of that arm deep in 300,000 balls.
void register_cloud_ticks();

// cloud/deep/CLOUD/PART: cold queries of a part that is deep in a cloud: in 300,000 balls that fill
// a cube of half a metre, or on the surfaces of a depth image. Counters: max_us; work, the cost in
// overlaps; widest_gap, m.
void register_deep_clouds();

// parts/NAME: splitting a mesh into convex parts, for drawn meshes and for these files, STL, OBJ,
// PLY or DAE in metres. Counters: parts, error_mm (certified) and triangles; the time is that of
// all threads. Returns false if a file cannot be read, and says why.
[[nodiscard]] bool register_splits(const std::vector<std::filesystem::path>& mesh_files);

}  // namespace clearance::bench
