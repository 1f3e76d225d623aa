// Pairs of bodies on seeded trajectories, with the true distance at every pose.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/convex_body.hpp"
#include "core/pose.hpp"
#include "tools/bench/truth.hpp"

namespace clearance::bench {

using Body = std::shared_ptr<const ConvexBody>;

// One pair on its trajectory.
struct Trajectory {
  Body a, b;
  std::vector<std::pair<Pose, Pose>> poses;  // world_from_a, world_from_b
};

struct Workload {
  std::string name;
  std::vector<Trajectory> trajectories;
  std::vector<std::vector<Truth>> truth;  // [trajectory][pose]

  [[nodiscard]] std::size_t queries() const;
};

// The same on every machine; 40 trajectories of 100 steps, but for those of overlaps.hpp:
//   fN, vN          §3.5, §4.1: two facet-balls of order N, or their duals; each moves by 0.02
//                   radius and 0.01 rad per step; centres come as close as 2.6 to 7 radii
//   boxes           random boxes on the same kind of trajectory; the least distance of the centres
//                   is 0.8 to 2 m
//   parallel-boxes  boxes of one orientation (half of them along the axes) that slide past each
//                   other face to face
//   links           hulls like those of robot links, 2 mm and 5 mrad per step
//   links24, links400  the same with 24 and 400 vertices each
//   A-B             two bodies of the kinds below, of 0.1 to 0.5 m, on the trajectories of links
//   crossed/D       the standard test of chapter 5, one pose (crossed_ellipsoids.hpp)
// Made at first use and kept. Throws std::invalid_argument for any other name.
[[nodiscard]] const Workload& workload(const std::string& name);
// The same without the true distances.
[[nodiscard]] std::vector<Trajectory> trajectories(const std::string& name);

inline constexpr int kTrajectorySteps = 100;

// The orders of §3.5.
inline constexpr int kOrders[] = {2, 4, 6, 8, 10, 15, 20, 30, 40};

// Every name but those of pairs of kinds, crossed ellipsoids and overlaps.hpp, in the order of the
// tables.
[[nodiscard]] std::vector<std::string> workload_names();

// Kinds of bodies, the curved ones first. `link` is a hull, `rounded_box` a box of half the size
// with a radius around it.
inline constexpr const char* kKinds[] = {"ellipsoid", "cylinder", "cone",   "truncated_cone", "box",
                                         "link",      "capsule",  "sphere", "rounded_box"};
struct KindPair {
  std::string a, b;
  [[nodiscard]] std::string load() const { return a + "-" + b; }
  // "curved" if one of them is, else "pair": rows are curved/tracked/A-B, pair/cold/A-B ...
  [[nodiscard]] std::string group() const;
};
// All pairs of kinds.
[[nodiscard]] std::vector<KindPair> kind_pairs();

}  // namespace clearance::bench
