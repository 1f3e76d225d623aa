// The rivals of the suite, and Clearance itself. A new one is a file with a function, a row in
// rivals.cpp, and a line in tools/CMakeLists.txt.
#pragma once

#include <vector>

#include "tools/bench/suite/rival.hpp"

namespace clearance::bench {

[[nodiscard]] std::vector<Rival> clearance_rivals();

// Packaged by Debian; their solvers are those of the rows peer/.
[[nodiscard]] std::vector<Rival> fcl_rivals();
[[nodiscard]] std::vector<Rival> bullet_rivals();
[[nodiscard]] std::vector<Rival> libccd_rivals();

// Installed in a folder that CMake is given: CLEARANCE_BENCH_COAL and so on. Each is a library of
// its own, which exports this function only.
#define CLEARANCE_RIVAL __attribute__((visibility("default")))
[[nodiscard]] CLEARANCE_RIVAL std::vector<Rival> coal_rivals();
[[nodiscard]] CLEARANCE_RIVAL std::vector<Rival> opengjk_rivals();
[[nodiscard]] CLEARANCE_RIVAL std::vector<Rival> vclip_rivals();
[[nodiscard]] CLEARANCE_RIVAL std::vector<Rival> jolt_rivals();
[[nodiscard]] CLEARANCE_RIVAL std::vector<Rival> box3d_rivals();
[[nodiscard]] CLEARANCE_RIVAL std::vector<Rival> mujoco_rivals();

// All that this program was compiled with, Clearance first.
[[nodiscard]] std::vector<Rival> all_rivals();

}  // namespace clearance::bench
