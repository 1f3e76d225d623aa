// The signed distance from one convex body is a convex function. Over the hull of some points it is
// therefore greatest at one of these points. The distance from the nearest of several bodies is not
// convex. It is, however, at most the distance from any one of the bodies. So the largest signed
// distance of the points from that body is a bound for the whole hull. The model is covered by such
// hulls ("cells"). The cell with the largest bound is split until that bound is close to the
// distance of a point of the model. A ball of radius r around each point of the model adds at most
// r.
#include "tools/scene/fitting/certified_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <vector>

#include "core/distance.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/shapes.hpp"
#include "tools/scene/fitting/fitted.hpp"

namespace clearance {
namespace {

// Vertices of the polygon around a circle: 1 / cos(pi / 1024) is 1 + 5e-6.
constexpr int kPolygonVertices = 1024;

// Upper bounds of the signed distance of a point from each body, m.
class Distances {
 public:
  explicit Distances(std::span<const PlacedShape> bodies)
      : bodies_(bodies),
        states_(bodies.size()),
        point_(std::get<ConvexBody>(point(Vec3::Zero(), 0.0))) {}

  [[nodiscard]] std::vector<double> operator()(const Vec3& position) {
    Pose at;
    at.position = position;
    std::vector<double> result;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const RelativePose pose = relative_pose(bodies_[i].frame_from_shape, at);
      result.push_back(distance(*bodies_[i].shape, point_, pose, states_[i]).upper);
    }
    return result;
  }

 private:
  std::span<const PlacedShape> bodies_;
  std::vector<TrackingState> states_;
  ConvexBody point_;
};

// For each body, the largest distance of some points from it.
class FarthestPoint {
 public:
  void add(const std::vector<double>& distances) {
    if (farthest_.empty()) farthest_.assign(distances.size(), -kInfinity);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      farthest_[i] = std::max(farthest_[i], distances[i]);
    }
  }
  // No point of the hull of these points is farther from the nearest body, m.
  [[nodiscard]] double bound() const {
    return *std::min_element(farthest_.begin(), farthest_.end());
  }

 private:
  std::vector<double> farthest_;
};

// Splits the cell with the largest bound, because no other split can lower the result. A cover has
// `open`, a queue of cells that holds the model; `reached`, the distance of a point of the model;
// split(cell); and two limits.
template <class Cover>
double greatest_bound(Cover cover) {
  for (int splits = 0; splits < Cover::kMostSplits; ++splits) {
    const auto widest = cover.open.top();
    if (widest.bound <= cover.reached + Cover::kTolerance * std::abs(cover.reached)) break;
    cover.open.pop();
    cover.split(widest);
  }
  return cover.open.top().bound;
}

// A solid polyhedron as tetrahedra between the triangles of its facets and an interior point. A
// split costs a distance query per body.
class Tetrahedra {
 public:
  struct Cell {
    std::array<std::size_t, 4> vertices;
    double bound;  // m
    bool operator<(const Cell& other) const { return bound < other.bound; }
  };
  static constexpr double kTolerance = 0.02;
  static constexpr int kMostSplits = 400;

  Tetrahedra(const ConvexBody& model, const Pose& frame_from_model, Distances& distances)
      : distances_(distances) {
    for (const Vertex& vertex : model.vertices) add(transform(frame_from_model, vertex.position));
    const std::size_t centre = add(transform(frame_from_model, model.interior));
    for (const Facet& facet : model.facets) fan(model, facet, centre);
  }

  // Splits a cell into two at the midpoint of its longest edge.
  void split(const Cell& whole) {
    std::array<std::size_t, 2> longest{0, 1};
    double length = -1.0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        const double l = (at(whole.vertices[i]) - at(whole.vertices[j])).squaredNorm();
        if (l > length) longest = {i, j}, length = l;
      }
    }
    const std::size_t middle =
        add(0.5 * (at(whole.vertices[longest[0]]) + at(whole.vertices[longest[1]])));
    for (const std::size_t end : longest) {
      std::array<std::size_t, 4> half = whole.vertices;
      half[end] = middle;
      push(half);
    }
  }

  std::priority_queue<Cell> open;
  double reached = -kInfinity;

 private:
  struct MeasuredPoint {
    Vec3 position;
    std::vector<double> distances;  // from each body, m
  };

  [[nodiscard]] const Vec3& at(std::size_t vertex) const { return points_[vertex].position; }

  std::size_t add(const Vec3& position) {
    points_.push_back({position, distances_(position)});
    const std::vector<double>& from = points_.back().distances;
    reached = std::max(reached, *std::min_element(from.begin(), from.end()));
    return points_.size() - 1;
  }

  // Triangles of the facet's polygon from its first vertex, with the centre.
  void fan(const ConvexBody& model, const Facet& facet, std::size_t centre) {
    std::vector<std::size_t> ring;
    for (std::int32_t i = facet.first_side; i < facet.first_side + facet.sides; ++i) {
      const EdgeUse& use = model.facet_edges[static_cast<std::size_t>(i)];
      const Edge& edge = model.edges[static_cast<std::size_t>(use.edge)];
      ring.push_back(static_cast<std::size_t>(edge.vertex[use.side]));
    }
    for (std::size_t i = 2; i < ring.size(); ++i) push({ring[0], ring[i - 1], ring[i], centre});
  }

  void push(const std::array<std::size_t, 4>& vertices) {
    FarthestPoint farthest;
    for (const std::size_t v : vertices) farthest.add(points_[v].distances);
    open.push({vertices, farthest.bound()});
  }

  Distances& distances_;
  std::vector<MeasuredPoint> points_;
};

// An ellipsoid as patches of the unit sphere over triangles. The points of a patch are in the hull
// of the triangle's vertices and of these moved out until the triangle touches the sphere.
class EllipsoidPatches {
 public:
  struct Cell {
    std::array<Vec3, 3> vertices;  // on the unit sphere
    double bound;                  // m
    bool operator<(const Cell& other) const { return bound < other.bound; }
  };
  static constexpr double kTolerance = 0.01;
  static constexpr int kMostSplits = 20000;

  EllipsoidPatches(const ConvexBody& model, const Pose& frame_from_model, Distances& distances)
      : semi_axes_(model.curved.semi_axes),
        frame_from_model_(frame_from_model),
        distances_(distances) {
    for (int octant = 0; octant < 8; ++octant) {
      std::array<Vec3, 3> vertices{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
      for (int i = 0; i < 3; ++i) {
        if (octant & (1 << i)) vertices[static_cast<std::size_t>(i)] *= -1.0;
      }
      push(vertices);
    }
  }

  // Splits a patch into two at the midpoint of its longest side.
  void split(const Cell& patch) {
    std::size_t from = 0;
    double longest = -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double side = (patch.vertices[(i + 1) % 3] - patch.vertices[i]).squaredNorm();
      if (side > longest) from = i, longest = side;
    }
    const Vec3 &a = patch.vertices[from], &b = patch.vertices[(from + 1) % 3],
               &c = patch.vertices[(from + 2) % 3];
    const Vec3 middle = (a + b).normalized();
    push({a, middle, c});
    push({middle, b, c});
  }

  std::priority_queue<Cell> open;
  double reached = -kInfinity;

 private:
  [[nodiscard]] std::vector<double> distances_of(const Vec3& on_sphere) {
    return distances_(transform(frame_from_model_, semi_axes_.cwiseProduct(on_sphere)));
  }

  void push(const std::array<Vec3, 3>& vertices) {
    const Vec3 normal = (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]).normalized();
    const double outwards = (1.0 + 1e-12) / std::abs(normal.dot(vertices[0]));
    FarthestPoint farthest;
    for (const Vec3& v : vertices) {
      const std::vector<double> on_surface = distances_of(v);
      reached = std::max(reached, *std::min_element(on_surface.begin(), on_surface.end()));
      farthest.add(on_surface);
      farthest.add(distances_of(outwards * v));
    }
    open.push({vertices, farthest.bound()});
  }

  Vec3 semi_axes_;
  Pose frame_from_model_;
  Distances& distances_;
};

// Points whose hull holds the model without its radius.
std::vector<Vec3> points_around(const ConvexBody& model) {
  if (model.curved.kind != CurvedShape::Kind::kTruncatedCone) {
    return {model.anchors.begin(), model.anchors.end()};
  }
  std::vector<Vec3> points;
  const double stretch = 1.0 / std::cos(std::numbers::pi / kPolygonVertices);
  for (const Disc& disc : model.curved.discs) {
    for (int k = 0; k < kPolygonVertices; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kPolygonVertices;
      const double r = stretch * disc.radius;
      points.emplace_back(r * std::cos(angle), r * std::sin(angle), disc.height);
    }
  }
  return points;
}

double bound_without_radius(const ConvexBody& model, const Pose& frame_from_model,
                            std::span<const PlacedShape> bodies) {
  Distances distances(bodies);
  if (model.curved.kind == CurvedShape::Kind::kEllipsoid) {
    return greatest_bound(EllipsoidPatches(model, frame_from_model, distances));
  }
  if (bodies.size() > 1 && !model.facets.empty()) {
    return greatest_bound(Tetrahedra(model, frame_from_model, distances));
  }
  FarthestPoint farthest;
  for (const Vec3& p : points_around(model))
    farthest.add(distances(transform(frame_from_model, p)));
  return farthest.bound();
}

// Rounding of the placed points, and of points on curves, m.
double rounding(const ConvexBody& model, const Pose& frame_from_model,
                std::span<const PlacedShape> bodies) {
  double size = frame_from_model.position.norm() + model.bounding_radius;
  for (const PlacedShape& body : bodies) {
    size = std::max(size, body.frame_from_shape.position.norm() + body.shape->bounding_radius);
  }
  return (model.is_curved() ? kFittingMargin : kPlacingError) * size + model.position_error;
}

}  // namespace

double certified_error(const ConvexBody& model, const Pose& frame_from_model,
                       std::span<const PlacedShape> bodies) {
  const double found = bound_without_radius(model, frame_from_model, bodies) + model.radius;
  return (std::max(0.0, found) + rounding(model, frame_from_model, bodies)) * kRoundedUp;
}

}  // namespace clearance
