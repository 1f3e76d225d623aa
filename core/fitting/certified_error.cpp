// How far a model reaches beyond the body. The signed distance from a convex body is a convex
// function, so over a hull it is greatest at a corner, and a ball of radius r around each point
// adds at most r. Circles and ellipsoids are covered by hulls that are a little larger.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <vector>

#include "core/fitting/fitted.hpp"

namespace clearance {
namespace {

// Corners of the polygon around a circle: 1 / cos(pi / 1024) is 1 + 5e-6.
constexpr int kCorners = 1024;
// Of an ellipsoid: how much of the bound may be due to the cover, and how many triangles that may
// take.
constexpr double kCoverShare = 0.01;
constexpr std::size_t kTriangles = 20000;

double beyond_truncated_cone(const EnclosingModel& model, BeyondBody& beyond) {
  double most = -kInfinity;
  const double stretch = 1.0 / std::cos(std::numbers::pi / kCorners);
  for (const Disc& disc : model.shape.curved.discs) {
    for (int k = 0; k < kCorners; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kCorners, r = stretch * disc.radius;
      const Vec3 corner(r * std::cos(angle), r * std::sin(angle), disc.height);
      most = std::max(most, beyond(transform(model.frame_from_shape, corner)));
    }
  }
  return most;
}

// A patch of the unit sphere over a triangle: its points are in the hull of the corners and of the
// corners moved out until the triangle touches the sphere.
class EllipsoidCover {
 public:
  EllipsoidCover(const EnclosingModel& model, BeyondBody& beyond)
      : model_(model), beyond_(beyond) {}

  double bound() {
    for (int octant = 0; octant < 8; ++octant) {
      add({corner(octant & 1 ? Vec3(-Vec3::UnitX()) : Vec3(Vec3::UnitX())),
           corner(octant & 2 ? Vec3(-Vec3::UnitY()) : Vec3(Vec3::UnitY())),
           corner(octant & 4 ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::UnitZ()))});
    }
    while (patches_.size() < kTriangles) {
      const Patch widest = patches_.top();
      if (widest.bound <= most_ + kCoverShare * std::abs(most_)) break;
      patches_.pop();
      halve(widest);
    }
    return patches_.top().bound;
  }

 private:
  struct Patch {
    std::array<Vec3, 3> corners;
    double bound;
    bool operator<(const Patch& other) const { return bound < other.bound; }
  };

  [[nodiscard]] double beyond_at(const Vec3& on_sphere) {
    const Vec3 p = model_.shape.curved.semi_axes.cwiseProduct(on_sphere);
    return beyond_(transform(model_.frame_from_shape, p));
  }
  Vec3 corner(const Vec3& n) {
    most_ = std::max(most_, beyond_at(n));
    return n;
  }
  void add(const std::array<Vec3, 3>& corners) {
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    const double out = (1.0 + 1e-12) / std::abs(normal.dot(corners[0]));
    Patch patch{corners, -kInfinity};
    for (const Vec3& c : corners) {
      patch.bound = std::max({patch.bound, beyond_at(c), beyond_at(out * c)});
    }
    patches_.push(patch);
  }
  void halve(const Patch& patch) {
    std::size_t from = 0;
    double longest = -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double side = (patch.corners[(i + 1) % 3] - patch.corners[i]).squaredNorm();
      if (side > longest) {
        longest = side;
        from = i;
      }
    }
    const Vec3 &a = patch.corners[from], &b = patch.corners[(from + 1) % 3],
               &c = patch.corners[(from + 2) % 3];
    const Vec3 middle = corner((a + b).normalized());
    add({a, middle, c});
    add({middle, b, c});
  }

  const EnclosingModel& model_;
  BeyondBody& beyond_;
  double most_ = -kInfinity;
  std::priority_queue<Patch> patches_;
};

double beyond_core(const EnclosingModel& model, BeyondBody& beyond) {
  switch (model.shape.curved.kind) {
    case CurvedShape::Kind::kEllipsoid:
      return EllipsoidCover(model, beyond).bound();
    case CurvedShape::Kind::kTruncatedCone:
      return beyond_truncated_cone(model, beyond);
    case CurvedShape::Kind::kNone:
      break;
  }
  double most = -kInfinity;
  for (const Vec3& p : model.shape.anchors) {
    most = std::max(most, beyond(transform(model.frame_from_shape, p)));
  }
  return most;
}

}  // namespace

double certified_error(const EnclosingModel& model, const ConvexBody& body) {
  BeyondBody beyond(body);
  const double slack = kFittingSlack * (size_of(body) + model.shape.bounding_radius);
  return std::max(0.0, beyond_core(model, beyond) + model.shape.radius) + slack;
}

}  // namespace clearance
