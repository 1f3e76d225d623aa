// Reads a line of a file of cases in which a body is curved or of several parts.
#pragma once

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "tools/cases/case.hpp"

namespace clearance {

struct CurvedPart {
  Pose body_from_part;
  ConvexBody shape;
};

// The union of the parts.
using CurvedCaseBody = std::vector<CurvedPart>;

struct CurvedCase {
  nlohmann::json id;
  CurvedCaseBody a, b;
  std::vector<std::pair<Pose, Pose>> poses;  // of a and b; one, or those of a motion
  bool motion = false;
};

// Returns true when a or b has a key that polyhedra do not have.
[[nodiscard]] bool is_curved_case(const nlohmann::json& line);

// Throws BadLine.
[[nodiscard]] CurvedCase read_curved_case(const nlohmann::json& line);

}  // namespace clearance
