// Cells in motion, mostly generated ones, which show how the cost of a tick grows with the number
// of objects and pairs.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance::bench {

// A cell and the motion of its objects.
struct Crowd {
  // Moves on a circle at a constant speed and spins at a constant rate.
  struct Orbit {
    std::uint32_t object = 0;
    Vec3 centre, across, along;  // radii of the circle, orthogonal, m
    double turn_rate = 0.0;      // about the centre of the circle, rad/s
    Vec3 spin_axis;              // unit
    double spin_rate = 0.0;      // rad/s
  };
  std::string name;
  Scene scene;
  Simulation simulation;
  std::vector<Orbit> orbits;
  std::map<std::string, double> swept;  // parameters of a sweep, which become counters

  // One sample for each moving object at `t_s` seconds, stamped `stamp_ns`.
  void samples_at(double t_s, std::int64_t stamp_ns, std::vector<PoseSample>& samples) const;
};

struct OrbitingOptions {
  std::uint32_t count = 100, moving = 100;
  double speed = 1.0;    // m/s; they spin at 2 rad/s for each
  double spacing = 1.0;  // of the grid, m; at least 1
  int order = 0;         // all are facet-balls of this order; 0: of different kinds
};

// Boxes, facet-balls, capsules and tetrahedra of 0.15 to 0.28 m radius, one in each cell of a cubic
// grid. `moving` of them move on circles of 0.18 m radius. No two ever meet; in a grid of 1 m
// neighbours come as near as 0.08 m. All pairs are watched. Objects that do not move send the same
// pose in every tick.
[[nodiscard]] Crowd orbiting_crowd(const OrbitingOptions& options);

// A serial arm of 20 links among `obstacles` fixed bodies around it. Watched are all pairs of a
// link and an obstacle, and all pairs of links that are neither neighbours nor next neighbours.
[[nodiscard]] Crowd robot_in_crowd(std::uint32_t obstacles);

// The generated warehouse of config/write/warehouse_cell.hpp: objects of up to eight parts, of
// which one in twenty moves.
[[nodiscard]] Crowd warehouse_crowd(std::uint32_t objects);

// A shipped cell, config/cells/NAME.yaml, along its simulated motion.
[[nodiscard]] Crowd shipped_crowd(const std::string& name);

}  // namespace clearance::bench
