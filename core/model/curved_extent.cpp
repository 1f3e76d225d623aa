#include "core/model/curved_extent.hpp"

#include "core/model/curved_body.hpp"

namespace clearance {

double support_value(const CurvedShape& shape, const Vec3& m) noexcept {
  return visit(shape, [&](const auto& body) { return body.support_value(m); });
}

double farthest_from(const CurvedShape& shape, const Vec3& position) noexcept {
  return visit(shape, [&](const auto& body) { return body.farthest_from(position); });
}

Vec3 middle(const CurvedShape& shape) noexcept {
  return visit(shape, [](const auto& body) { return body.middle(); });
}

std::vector<Vec3> surface_points(const CurvedShape& shape, int round) {
  return visit(shape, [&](const auto& body) { return body.surface_points(round); });
}

}  // namespace clearance
