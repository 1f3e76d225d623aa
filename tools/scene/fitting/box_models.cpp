// Boxes: one side lies in a facet of the body, and another along an edge of its shadow there (as
// J. O'Rourke, "Finding minimal enclosing boxes", 1985, with one facet flush in place of two
// edges).
#include <algorithm>
#include <cmath>

#include "tools/scene/fitting/enclosing_circle.hpp"
#include "tools/scene/fitting/fitted.hpp"

namespace clearance {
namespace {

// Bodies with more facets are tried along every k-th normal.
constexpr std::size_t kNormals = 256;
// Radii that are tried for a rounded box.
constexpr int kRoundings = 64;

struct Extent {
  Vec3 low = Vec3::Constant(kInfinity), high = Vec3::Constant(-kInfinity);
  [[nodiscard]] Vec3 middle() const { return 0.5 * (low + high); }
  [[nodiscard]] Vec3 half() const { return 0.5 * (high - low); }
};

Extent extent_of(const std::vector<Vec3>& points) {
  Extent e;
  for (const Vec3& p : points) {
    e.low = e.low.cwiseMin(p);
    e.high = e.high.cwiseMax(p);
  }
  return e;
}

struct Candidate {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  double volume = kInfinity;
};

// The best box with a side at right angles to `normal`.
Candidate best_across(const ConvexBody& body, const Vec3& normal) {
  const Eigen::Quaterniond upright = rotation_to(normal);
  const std::vector<Vec3> points = vertices_in(body, upright);
  const Extent all = extent_of(points);
  std::vector<Vec2> shadow;
  for (const Vec3& p : points) shadow.emplace_back(p.x(), p.y());
  const std::vector<Vec2> polygon = convex_polygon(std::move(shadow));
  Candidate best;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 along = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
    double low_x = kInfinity, high_x = -kInfinity, low_y = kInfinity, high_y = -kInfinity;
    for (const Vec2& p : polygon) {
      const double x = along.dot(p), y = along.x() * p.y() - along.y() * p.x();
      low_x = std::min(low_x, x);
      high_x = std::max(high_x, x);
      low_y = std::min(low_y, y);
      high_y = std::max(high_y, y);
    }
    const double volume = (high_x - low_x) * (high_y - low_y) * (all.high.z() - all.low.z());
    if (volume >= best.volume) continue;
    best.volume = volume;
    const double angle = std::atan2(along.y(), along.x());
    best.rotation = upright * Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
  }
  best.rotation.normalize();
  return best;
}

Eigen::Quaterniond best_rotation(const ConvexBody& body) {
  Candidate best;
  const auto try_normal = [&](const Vec3& normal) {
    const Candidate found = best_across(body, normal);
    if (found.volume < best.volume * (1.0 - 1e-9)) best = found;
  };
  for (int i = 0; i < 3; ++i) try_normal(Vec3::Unit(i));
  const Mat3 axes = principal_axes(body);
  for (int i = 0; i < 3; ++i) try_normal(Vec3(axes.col(i)));
  const std::size_t stride = (body.facets.size() + kNormals - 1) / kNormals;
  for (std::size_t i = 0; i < body.facets.size(); i += stride) try_normal(body.facets[i].normal);
  return best.rotation;
}

Pose placed_at(const Eigen::Quaterniond& rotation, const Vec3& middle) {
  Pose at;
  at.orientation = rotation;
  at.position = rotation_matrix(rotation) * middle;
  return at;
}

}  // namespace

EnclosingModel enclosing_box(const ConvexBody& body) {
  const Eigen::Quaterniond rotation = best_rotation(body);
  const Extent e = extent_of(vertices_in(body, rotation));
  const Vec3 margin = Vec3::Constant(4.0 * kFittingMargin * size_of(body));
  return fitted(ModelKind::kBox, box(e.half() + margin), placed_at(rotation, e.middle()), body);
}

EnclosingModel enclosing_rounded_box(const ConvexBody& body) {
  const Eigen::Quaterniond rotation = best_rotation(body);
  const std::vector<Vec3> points = vertices_in(body, rotation);
  const Extent e = extent_of(points);
  const Pose at = placed_at(rotation, e.middle());
  const double margin = 4.0 * kFittingMargin * size_of(body), thinnest = e.half().minCoeff();
  EnclosingModel best;
  for (int k = 0; k < kRoundings; ++k) {
    const Vec3 core = e.half() - Vec3::Constant(0.99 * thinnest * k / kRoundings);
    double radius = 0.0;
    for (const Vec3& p : points) {
      const Vec3 excess = ((p - e.middle()).cwiseAbs() - core).cwiseMax(0.0);
      radius = std::max(radius, excess.norm());
    }
    EnclosingModel model =
        fitted(ModelKind::kRoundedBox, rounded_by(radius + margin, std::get<ConvexBody>(box(core))),
               at, body);
    if (model.error < best.error) best = std::move(model);
  }
  return best;
}

}  // namespace clearance
