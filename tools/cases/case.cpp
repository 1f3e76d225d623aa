#include "tools/cases/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <variant>

#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

using Json = nlohmann::json;

// A value shortened to what fits into a message.
std::string shown(const Json& value) {
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= 80 ? text : fmt::format("{}...", text.substr(0, 77));
}

}  // namespace

// The parser keeps the last of two values of one key, so that the first would be hidden.
Json parse_line(const std::string& text) {
  std::vector<std::set<std::string>> keys;  // of the objects around the present place
  return Json::parse(text, [&](int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event != Json::parse_event_t::key) return true;
    if (!keys.back().insert(parsed.get<std::string>()).second)
      throw BadLine(fmt::format("found the key {} again; expected it once", shown(parsed)));
    return true;
  });
}

void refuse_unknown_keys(const Json& object, const std::vector<std::string>& known,
                         const std::string& what) {
  if (!object.is_object()) throw BadLine(fmt::format("{} is not a JSON object", what));
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    throw BadLine(fmt::format("found the unknown key '{}' in {}; expected {}{}", key, what,
                              one_of(known), did_you_mean(key, known)));
  }
}

const Json& member(const Json& object, const char* key, const std::string& where) {
  if (!object.is_object()) throw BadLine(fmt::format("{} is not a JSON object", where));
  const auto found = object.find(key);
  if (found == object.end()) throw BadLine(fmt::format("{} has no \"{}\"", where, key));
  return *found;
}

void expect_list(const Json& list, std::size_t size, const std::string& where,
                 const char* expected) {
  if (!list.is_array() || list.size() != size)
    throw BadLine(fmt::format("{}: expected {}, found {}", where, expected, shown(list)));
}

namespace {

template <std::size_t N>
std::array<double, N> numbers(const Json& list, const std::string& where, const char* expected) {
  expect_list(list, N, where, expected);
  std::array<double, N> out{};
  for (std::size_t k = 0; k < N; ++k) {
    if (!list[k].is_number())
      throw BadLine(fmt::format("{}: {} is not a number", where, shown(list[k])));
    out[k] = list[k].get<double>();
  }
  return out;
}

constexpr double kFarthest = kLargestCoordinate;  // m

}  // namespace

Pose read_pose(const Json& entry, const std::string& where) {
  constexpr const char* kForm =
      R"({"xyz": [x, y, z], "quaternion": [x, y, z, w]}, as in a cell, with one of the two or both)";
  if (!entry.is_object() || entry.empty() ||
      entry.size() != entry.count("xyz") + entry.count("quaternion")) {
    throw BadLine(fmt::format("{}: expected {}; found {}", where, kForm, shown(entry)));
  }
  Pose pose;
  if (const auto xyz = entry.find("xyz"); xyz != entry.end()) {
    const auto v = numbers<3>(*xyz, where + ".xyz", "[x, y, z]");
    pose.position = {v[0], v[1], v[2]};
  }
  if (const auto quaternion = entry.find("quaternion"); quaternion != entry.end()) {
    const auto v = numbers<4>(*quaternion, where + ".quaternion", "[x, y, z, w]");
    pose.orientation = {v[3], v[0], v[1], v[2]};
  }
  const double norm = pose.orientation.norm();
  if (!pose.position.allFinite() || !std::isfinite(norm)) {
    throw BadLine(fmt::format("{} is not finite", where));
  }
  if (!(pose.position.cwiseAbs().maxCoeff() <= kFarthest)) {
    throw BadLine(fmt::format("{} lies more than 1e12 m from the origin", where));
  }
  if (!is_unit(pose.orientation)) {
    throw BadLine(
        fmt::format("{}: the quaternion has length {}; expected 1 to within 1e-6", where, norm));
  }
  return pose;
}

namespace {

ShapeResult shape_of_rows(const Json& list, const std::string& where) {
  std::vector<HalfSpace> rows;
  for (const Json& entry : list) {
    const std::string row = fmt::format("{}.halfspaces[{}]", where, rows.size());
    const auto v = numbers<4>(entry, row, "[nx, ny, nz, d]");
    rows.push_back({{v[0], v[1], v[2]}, v[3]});
  }
  return polyhedron_from_halfspaces(rows);
}

ShapeResult shape_of_vertices(const Json& list, const std::string& where, double radius) {
  std::vector<Vec3> points;
  for (const Json& entry : list) {
    const std::string row = fmt::format("{}.vertices[{}]", where, points.size());
    const auto v = numbers<3>(entry, row, "[x, y, z]");
    points.emplace_back(v[0], v[1], v[2]);
  }
  if (points.size() == 1) return point(points[0], radius);
  if (points.size() == 2) return segment(points[0], points[1], radius);
  return polyhedron_from_vertices(points);
}

}  // namespace

ConvexBody read_body(const Json& body, const std::string& where) {
  refuse_unknown_keys(body, {"halfspaces", "vertices", "radius"}, where);
  double radius = 0.0;
  if (const auto found = body.find("radius"); found != body.end() && !found->is_null()) {
    if (!found->is_number() || !(found->get<double>() >= 0.0) ||
        !(found->get<double>() <= kFarthest)) {
      throw BadLine(fmt::format("{}.radius: expected a length in metres, at most 1e12, found {}",
                                where, shown(*found)));
    }
    radius = found->get<double>();
  }
  const auto list_named = [&](const char* key) -> const Json* {
    const auto found = body.find(key);
    if (found == body.end() || found->is_null()) return nullptr;
    if (!found->is_array()) throw BadLine(fmt::format("{}.{} is not a list", where, key));
    return &*found;
  };
  const Json* rows = list_named("halfspaces");
  const Json* vertices = list_named("vertices");
  if (rows == nullptr && vertices == nullptr) {
    throw BadLine(fmt::format("{} has neither \"halfspaces\" nor \"vertices\"", where));
  }
  ShapeResult shape =
      rows != nullptr ? shape_of_rows(*rows, where) : shape_of_vertices(*vertices, where, radius);
  if (const auto* error = std::get_if<ShapeError>(&shape)) {
    throw BadLine(fmt::format("{}: {}", where, error->reason));
  }
  ConvexBody& polyhedron = std::get<ConvexBody>(shape);
  polyhedron.radius = radius;
  return std::move(polyhedron);
}

namespace {

std::vector<std::pair<Pose, Pose>> read_motion(const Json& list) {
  if (!list.is_array()) throw BadLine("poses is not a list");
  std::vector<std::pair<Pose, Pose>> out;
  for (const Json& step : list) {
    const std::string where = fmt::format("poses[{}]", out.size());
    if (!step.is_array() || step.size() != 2) {
      throw BadLine(fmt::format("{}: expected [pose_a, pose_b], found {}", where, shown(step)));
    }
    out.emplace_back(read_pose(step[0], fmt::format("{}[0]", where)),
                     read_pose(step[1], fmt::format("{}[1]", where)));
  }
  return out;
}

}  // namespace

std::vector<std::pair<Pose, Pose>> read_poses(const Json& line) {
  if (line.contains("poses")) return read_motion(line["poses"]);
  const Pose pose_a = read_pose(member(line, "pose_a", "the case"), "pose_a");
  return {{pose_a, read_pose(member(line, "pose_b", "the case"), "pose_b")}};
}

DistanceCase read_case(const Json& line) {
  DistanceCase found;
  found.id = member(line, "id", "the case");
  found.a = read_body(member(line, "a", "the case"), "a");
  found.b = read_body(member(line, "b", "the case"), "b");
  found.motion = line.contains("poses");
  found.poses = read_poses(line);
  return found;
}

}  // namespace clearance
