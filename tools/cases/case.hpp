// Reads a line of a file of cases: two bodies and their poses. clearance-ask reads its poses so,
// too.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance {

// A line that cannot be used; the message lets its author correct it.
struct BadLine : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct DistanceCase {
  nlohmann::json id;
  ConvexBody a, b;
  std::vector<std::pair<Pose, Pose>> poses;  // of a and b; one, or those of a motion
  bool motion = false;
};

// Reads a line of JSON. Throws BadLine for a key that stands twice in an object, and
// nlohmann::json::exception for what is no JSON.
[[nodiscard]] nlohmann::json parse_line(const std::string& text);

// Throws BadLine for what is no object, and for a key that is not known. `what` names the object:
// "a payload".
void refuse_unknown_keys(const nlohmann::json& object, const std::vector<std::string>& known,
                         const std::string& what);

// Throws BadLine for what is no list of `size` entries. `expected` shows one: "[x, y, z]".
void expect_list(const nlohmann::json& list, std::size_t size, const std::string& where,
                 const char* expected);

// Read parts of a line. `where` names the place ("pose_a") for the message. All throw BadLine.
[[nodiscard]] const nlohmann::json& member(const nlohmann::json& object, const char* key,
                                           const std::string& where);
[[nodiscard]] Pose read_pose(const nlohmann::json& entry, const std::string& where);
[[nodiscard]] ConvexBody read_body(const nlohmann::json& body, const std::string& where);
[[nodiscard]] std::vector<std::pair<Pose, Pose>> read_poses(const nlohmann::json& line);

[[nodiscard]] DistanceCase read_case(const nlohmann::json& line);

}  // namespace clearance
