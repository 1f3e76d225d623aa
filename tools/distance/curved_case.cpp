#include "tools/distance/curved_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "core/shapes.hpp"

namespace clearance {
namespace {

using Json = nlohmann::json;

const std::array<std::string, 4> kCurved = {"ellipsoid", "truncated_cone", "cone", "cylinder"};

double number(const Json& value, const std::string& where) {
  if (!value.is_number()) throw BadLine(fmt::format("{} is not a number", where));
  return value.get<double>();
}

double length(const Json& object, const char* key, const std::string& where) {
  return number(member(object, key, where), fmt::format("{}.{}", where, key));
}

ShapeResult curved_shape(const Json& body, const std::string& where, double radius) {
  if (body.contains("ellipsoid")) {
    const Json& list = body["ellipsoid"];
    if (!list.is_array() || list.size() != 3) {
      throw BadLine(fmt::format("{}.ellipsoid: expected three semi-axes", where));
    }
    Vec3 axes;
    for (int i = 0; i < 3; ++i) {
      axes[i] = number(list[static_cast<std::size_t>(i)], fmt::format("{}.ellipsoid", where));
    }
    return ellipsoid(axes, radius);
  }
  if (body.contains("truncated_cone")) {
    const std::string at = where + ".truncated_cone";
    const Json& shape = body["truncated_cone"];
    refuse_unknown_keys(shape, {"lower_radius", "upper_radius", "half_length"}, at);
    return truncated_cone(length(shape, "lower_radius", at), length(shape, "upper_radius", at),
                          length(shape, "half_length", at), radius);
  }
  const bool is_cone = body.contains("cone");
  const std::string at = where + (is_cone ? ".cone" : ".cylinder");
  const Json& shape = body[is_cone ? "cone" : "cylinder"];
  refuse_unknown_keys(shape, {"radius", "half_length"}, at);
  const double across = length(shape, "radius", at), half = length(shape, "half_length", at);
  return is_cone ? cone(across, half, radius) : cylinder(across, half, radius);
}

CurvedPart read_convex(const Json& body, const std::string& where) {
  CurvedPart part;
  if (!body.is_object()) throw BadLine(fmt::format("{} is not a JSON object", where));
  const auto shape_key =
      std::ranges::find_if(kCurved, [&](const std::string& key) { return body.contains(key); });
  if (shape_key == kCurved.end()) {
    part.shape = read_body(body, where);
    return part;
  }
  refuse_unknown_keys(body, {*shape_key, "radius"}, where);
  const bool rounded = body.contains("radius") && !body["radius"].is_null();
  ShapeResult shape = curved_shape(body, where, rounded ? length(body, "radius", where) : 0.0);
  if (const auto* error = std::get_if<ShapeError>(&shape)) {
    throw BadLine(fmt::format("{}: {}", where, error->reason));
  }
  part.shape = std::get<ConvexBody>(std::move(shape));
  return part;
}

CurvedCaseBody read_parts(const Json& body, const std::string& where) {
  CurvedCaseBody parts;
  if (!body.is_object() || !body.contains("parts")) {
    parts.push_back(read_convex(body, where));
    return parts;
  }
  refuse_unknown_keys(body, {"parts"}, where);
  if (!body["parts"].is_array() || body["parts"].empty()) {
    throw BadLine(fmt::format("{}.parts is not a list of bodies", where));
  }
  for (Json entry : body["parts"]) {
    const std::string at = fmt::format("{}.parts[{}]", where, parts.size());
    const Pose body_from_part = read_pose(member(entry, "pose", at), at + ".pose");
    entry.erase("pose");
    CurvedPart part = read_convex(entry, at);
    part.body_from_part = body_from_part;
    parts.push_back(std::move(part));
  }
  return parts;
}

bool is_curved(const Json& body) {
  return body.is_object() &&
         (body.contains("parts") ||
          std::ranges::any_of(kCurved, [&](const std::string& key) { return body.contains(key); }));
}

}  // namespace

bool is_curved_case(const Json& line) {
  return line.is_object() && ((line.contains("a") && is_curved(line["a"])) ||
                              (line.contains("b") && is_curved(line["b"])));
}

CurvedCase read_curved_case(const Json& line) {
  CurvedCase found;
  found.id = member(line, "id", "the case");
  found.a = read_parts(member(line, "a", "the case"), "a");
  found.b = read_parts(member(line, "b", "the case"), "b");
  found.motion = line.contains("poses");
  found.poses = read_poses(line);
  return found;
}

}  // namespace clearance
