// Reads a line of a file of cases: two bodies and their poses.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/convex_polyhedron.hpp"
#include "core/pose.hpp"

namespace clearance {

// A line that cannot be used; the message lets its author correct it.
struct BadLine : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct DistanceCase {
  nlohmann::json id;
  ConvexPolyhedron a, b;
  std::vector<std::pair<Pose, Pose>> poses;  // of a and b; one, or those of a motion
  bool motion = false;
};

// Throws BadLine.
[[nodiscard]] DistanceCase read_case(const nlohmann::json& line);

}  // namespace clearance
