#include "core/enclosing_polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "core/model/curved_extent.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

// A round takes half of the facets that are left (next_cuts): twelve are enough for thousands.
constexpr int kMostRounds = 12;

// When planes are chosen, this many points of each circle stand for a curved body.
constexpr int kRound = 16;

// The bodies' hull. A polyhedron is the hull of spheres of these radii around its vertices
// (`anchors`).
class Outline {
 public:
  explicit Outline(std::span<const PlacedShape> bodies) {
    for (const PlacedShape& body : bodies) add(body);
  }

  // Returns an offset d such that n.x <= d for every point x of the bodies. It holds for exactly
  // these doubles of n, which has about unit length.
  [[nodiscard]] double support_value(const Vec3& n) const {
    const double length = n.norm() * kRoundedUp;
    double farthest = -kInfinity;
    for (const Sphere& sphere : spheres_) {
      farthest = std::max(farthest, n.dot(sphere.centre) + length * sphere.radius);
    }
    for (const Curved& body : curved_) {
      const double value = clearance::support_value(*body.shape, body.rotation.transpose() * n);
      farthest = std::max(farthest, n.dot(body.origin) + value + length * body.radius);
    }
    return farthest + 0x1p-49 * size_;  // three roundings of a product, two of the sum
  }

  // No point of the bodies is farther from the frame's origin, m.
  [[nodiscard]] double size() const { return size_; }

  // Returns sample points of the bodies, up to rounding, including round ends. Their hull has about
  // the same facets as the bodies' hull.
  [[nodiscard]] std::vector<Vec3> samples() const {
    std::vector<Vec3> points;
    for (const Sphere& sphere : spheres_) {
      add_sample(sphere, points);
    }
    for (const Curved& body : curved_) {
      for (const Vec3& p : surface_points(*body.shape, kRound)) {
        add_sample({body.origin + body.rotation * p, body.round, body.radius}, points);
      }
    }
    return points;
  }

 private:
  struct Sphere {
    Vec3 centre;
    double round;   // the body's radius, m
    double radius;  // and what placing may have moved it, m
  };

  // A curved body, rotated and then moved.
  struct Curved {
    const CurvedShape* shape;
    Mat3 rotation;
    Vec3 origin;
    double round, radius;  // as of a sphere
  };

  void add(const PlacedShape& body) {
    const ConvexBody& shape = *body.shape;
    const double arm = body.frame_from_shape.position.norm() + shape.bounding_radius;
    const double error = kPlacingError * arm + shape.position_error;
    if (shape.is_curved()) {
      const double radius = (shape.radius + 2.0 * error) * kRoundedUp;
      curved_.push_back({&shape.curved, rotation_matrix(body.frame_from_shape.orientation),
                         body.frame_from_shape.position, shape.radius, radius});
      size_ = std::max(size_, (arm + radius) * kRoundedUp);
    }
    for (const Vec3& anchor : shape.anchors) {
      const Vec3 centre = transform(body.frame_from_shape, anchor);
      const double radius = (shape.radius + error) * kRoundedUp;
      spheres_.push_back({centre, shape.radius, radius});
      size_ = std::max(size_, (centre.norm() + radius) * kRoundedUp);
    }
  }

  static void add_sample(const Sphere& sphere, std::vector<Vec3>& points) {
    if (sphere.round > 0.0) {
      around(sphere, points);
    } else {
      points.push_back(sphere.centre);
    }
  }

  static void around(const Sphere& sphere, std::vector<Vec3>& points) {
    // The 26 directions to a cube's faces, edges and vertices.
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const Vec3 direction(x, y, z);
          if (direction.isZero(0.0)) continue;
          points.push_back(sphere.centre + sphere.round * direction.normalized());
        }
      }
    }
  }

  std::vector<Sphere> spheres_;
  std::vector<Curved> curved_;
  double size_ = 0.0;
};

// The planes to choose from.
std::vector<HalfSpace> candidates(std::span<const PlacedShape> bodies, const Outline& outline) {
  std::vector<HalfSpace> planes;
  const auto add = [&](const Vec3& normal) {
    planes.push_back({normal, outline.support_value(normal)});
  };
  if (bodies.size() == 1 && !bodies[0].shape->facets.empty()) {
    for (const Facet& facet : bodies[0].shape->facets) {
      add(transform({.orientation = bodies[0].frame_from_shape.orientation}, facet.normal));
    }
    return planes;
  }
  const ShapeResult hull = polyhedron_from_vertices(outline.samples());
  if (const auto* body = std::get_if<ConvexBody>(&hull)) {
    for (const Facet& facet : body->facets) add(facet.normal);
  }
  return planes;
}

double height_above(const HalfSpace& plane, const Vec3& point) {
  return plane.normal.dot(point) - plane.offset;
}

struct CutVertex {
  double sticks_out = 0.0;  // by the plane that cuts it off deepest, m
  const HalfSpace* plane = nullptr;
};

CutVertex judged(const Vec3& vertex, const std::vector<HalfSpace>& planes) {
  CutVertex result;
  for (const HalfSpace& plane : planes) {
    const double depth = height_above(plane, vertex);
    if (depth > result.sticks_out) result = {depth, &plane};
  }
  return result;
}

// Returns the planes to cut with next, at most `most_cuts`. A vertex gets no plane of its own if an
// earlier cut already removes at least half of what sticks out there.
std::vector<HalfSpace> next_cuts(const ConvexBody& body, const std::vector<HalfSpace>& planes,
                                 double tolerance, std::size_t most_cuts) {
  std::vector<std::pair<CutVertex, Vec3>> vertices;
  for (const Vertex& vertex : body.vertices) {
    const CutVertex cut_off = judged(vertex.position, planes);
    if (cut_off.sticks_out > tolerance) vertices.emplace_back(cut_off, vertex.position);
  }
  std::stable_sort(vertices.begin(), vertices.end(), [](const auto& left, const auto& right) {
    return left.first.sticks_out > right.first.sticks_out;
  });
  // A round takes half of the cuts that are left, so that later cuts are chosen by the result of
  // these.
  const std::size_t most = std::min(most_cuts, std::max<std::size_t>(2, most_cuts / 2));
  std::vector<HalfSpace> cuts;
  for (const auto& [cut_off, position] : vertices) {
    if (cuts.size() == most) break;
    const Vec3& point = position;
    const double enough = 0.5 * cut_off.sticks_out;
    const bool done = std::any_of(cuts.begin(), cuts.end(), [&](const HalfSpace& cut) {
      return height_above(cut, point) >= enough;
    });
    if (!done) cuts.push_back(*cut_off.plane);
  }
  return cuts;
}

}  // namespace

std::optional<ConvexBody> enclosing_polyhedron(std::span<const PlacedShape> bodies,
                                               const EnclosingOptions& options) {
  const bool bounded = std::all_of(bodies.begin(), bodies.end(),
                                   [](const PlacedShape& body) { return body.shape->bounded(); });
  if (bodies.empty() || !bounded) return std::nullopt;
  const Outline outline(bodies);
  std::vector<HalfSpace> rows;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Vec3 normal = sign * Vec3::Unit(axis);
      const double value = outline.support_value(normal);
      const bool thin =
          value + outline.support_value(-normal) < 2.0 * kLeastExtent;  // a bare point's
      rows.push_back({normal, thin ? value + kLeastExtent : value});
    }
  }
  const std::vector<HalfSpace> planes = candidates(bodies, outline);
  const double tolerance = options.tolerance * outline.size();
  std::optional<ConvexBody> best;
  for (int round = 0; round < kMostRounds; ++round) {
    ShapeResult made = polyhedron_from_halfspaces(rows);
    auto* body = std::get_if<ConvexBody>(&made);
    if (body == nullptr) return best;  // thinner than a rounding, or out of range
    best = std::move(*body);
    if (best->facets.size() >= options.facets) break;
    const auto cuts = next_cuts(*best, planes, tolerance, options.facets - best->facets.size());
    if (cuts.empty()) break;
    rows.insert(rows.end(), cuts.begin(), cuts.end());
  }
  return best;
}

}  // namespace clearance
