#include "monitor/participant/body_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "monitor/wire/dds_sample.hpp"

namespace clearance {
namespace {

enum class BodyKind : std::uint8_t { kNone, kHull, kEllipsoid, kTruncatedCone };

Vec3 vector_in(const clearance_msg_Vector3& v) { return {v.x, v.y, v.z}; }

ShapeResult hull_of(const clearance_msg_StatedBody& message) {
  if (message.points._length > kMostBodyPoints) {
    return ShapeError{fmt::format("found {} points; expected at most {}", message.points._length,
                                  kMostBodyPoints)};
  }
  std::vector<Vec3> points;
  for (std::uint32_t i = 0; i < message.points._length; ++i)
    points.push_back(vector_in(message.points._buffer[i]));
  if (points.size() == 1) return point(points[0], message.radius);
  if (points.size() == 2) return segment(points[0], points[1], message.radius);
  return polyhedron_from_vertices(points);
}

bool is_same(const ConvexBody& a, const ConvexBody& b) {
  const auto position = [](const Vertex& vertex) -> const Vec3& { return vertex.position; };
  const auto is_same_facet = [](const Facet& one, const Facet& other) {
    return one.normal == other.normal && one.offset == other.offset;
  };
  return a.position_error == b.position_error &&
         std::ranges::equal(a.vertices, b.vertices, {}, position, position) &&
         std::ranges::equal(a.facets, b.facets, is_same_facet);
}

}  // namespace

std::variant<std::optional<ConvexBody>, ShapeError> from_wire(
    const clearance_msg_StatedBody& message) {
  const auto kind = static_cast<BodyKind>(message.kind);
  const Vec3 sizes = vector_in(message.sizes);
  ShapeResult made = ShapeError{fmt::format(
      "found the kind {}; expected 1 for a hull, 2 for an ellipsoid, or 3 for a cylinder or a cone",
      message.kind)};
  switch (kind) {
    case BodyKind::kNone:
      return std::nullopt;
    case BodyKind::kHull:
      made = hull_of(message);
      break;
    case BodyKind::kEllipsoid:
      made = ellipsoid(sizes);
      break;
    case BodyKind::kTruncatedCone:
      made = truncated_cone(sizes.x(), sizes.y(), sizes.z());
      break;
  }
  if (auto* body = std::get_if<ConvexBody>(&made))
    made = rounded_by(message.radius, std::move(*body));
  if (auto* error = std::get_if<ShapeError>(&made)) return std::move(*error);
  return std::get<ConvexBody>(std::move(made));
}

std::string unsent_part(const ConvexBody& body) {
  if (!body.bounded()) return "an unbounded body cannot be sent; expected a bounded one";
  if (body.is_curved()) return "";
  if (body.vertices.size() > kMostBodyPoints) {
    return fmt::format("a body of {} vertices cannot be sent; expected at most {}",
                       body.vertices.size(), kMostBodyPoints);
  }
  Sample<clearance_msg_Question> message;  // frees the points
  reserve_sequence(message->payloads, 1);
  message->payloads._length = 1;
  clearance_msg_StatedBody& stated = message->payloads._buffer[0].body;
  put_value(body, stated);
  const auto read = from_wire(stated);
  const auto* const got = std::get_if<std::optional<ConvexBody>>(&read);
  if (got == nullptr || !*got || !is_same(body, **got))
    return "a body with rounded vertices cannot be sent; expected the hull of these vertices";
  return "";
}

void put_value(const ConvexBody& body, clearance_msg_StatedBody& to) {
  to.radius = body.radius;
  if (body.curved.kind == CurvedShape::Kind::kEllipsoid) {
    to.kind = static_cast<std::uint8_t>(BodyKind::kEllipsoid);
    const Vec3& axes = body.curved.semi_axes;
    to.sizes = {axes.x(), axes.y(), axes.z()};
    return;
  }
  if (body.is_curved()) {
    to.kind = static_cast<std::uint8_t>(BodyKind::kTruncatedCone);
    const auto& [lower, upper] = body.curved.discs;
    to.sizes = {lower.radius, upper.radius, upper.height};
    return;
  }
  to.kind = static_cast<std::uint8_t>(BodyKind::kHull);
  reserve_sequence(to.points, body.vertices.size());
  for (const Vertex& vertex : body.vertices) {
    const Vec3& p = vertex.position;
    to.points._buffer[to.points._length++] = {p.x(), p.y(), p.z()};
  }
}

}  // namespace clearance
