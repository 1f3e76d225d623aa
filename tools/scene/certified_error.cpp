// The signed distance from one convex body is a convex function. Over the hull of some points it is
// therefore greatest at one of these points. The distance from the nearest of several bodies is not
// convex. It is, however, at most the distance from any one of the bodies. So the largest signed
// distance of the points from that body is a bound for the whole hull. The model is covered by such
// hulls ("cells"). The cell with the largest bound is split until that bound is close to the
// distance of a point of the model. A ball of radius r around each point of the model adds at most
// r.
#include "tools/scene/certified_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <vector>

#include "core/distance.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

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

// A solid polyhedron as tetrahedra between the triangles of its facets and an interior point. A
// split costs a distance query per body.
class Tetrahedra {
 public:
  struct Cell {
    std::array<std::size_t, 4> vertices;
    double bound;  // m
    bool operator<(const Cell& other) const { return bound < other.bound; }
  };
  Tetrahedra(const ConvexBody& model, const Pose& frame_from_model, Distances& distances)
      : distances_(distances) {
    for (const Vertex& vertex : model.vertices) add(transform(frame_from_model, vertex.position));
    const std::size_t centre = add(transform(frame_from_model, model.interior));
    for (const Facet& facet : model.facets) fan(model, facet, centre);
  }

  // Splits the cell with the largest bound, because no other split can lower the result.
  [[nodiscard]] double greatest_bound() {
    constexpr double kTolerance = 0.02;
    constexpr int kMostSplits = 400;
    for (int splits = 0; splits < kMostSplits; ++splits) {
      const Cell widest = open_.top();
      if (widest.bound <= reached_ + kTolerance * std::abs(reached_)) break;
      open_.pop();
      split(widest);
    }
    return open_.top().bound;
  }

 private:
  struct MeasuredPoint {
    Vec3 position;
    std::vector<double> distances;  // from each body, m
  };

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

  [[nodiscard]] const Vec3& at(std::size_t vertex) const { return points_[vertex].position; }

  std::size_t add(const Vec3& position) {
    points_.push_back({position, distances_(position)});
    const std::vector<double>& from = points_.back().distances;
    reached_ = std::max(reached_, *std::min_element(from.begin(), from.end()));
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
    open_.push({vertices, farthest.bound()});
  }

  Distances& distances_;
  std::vector<MeasuredPoint> points_;
  std::priority_queue<Cell> open_;
  double reached_ = -kInfinity;  // distance of a point of the model, m
};

double bound_without_radius(const ConvexBody& model, const Pose& frame_from_model,
                            std::span<const PlacedShape> bodies) {
  Distances distances(bodies);
  if (bodies.size() > 1 && !model.facets.empty()) {
    return Tetrahedra(model, frame_from_model, distances).greatest_bound();
  }
  FarthestPoint farthest;
  for (const Vec3& p : model.anchors) farthest.add(distances(transform(frame_from_model, p)));
  return farthest.bound();
}

// Rounding of the placed points, m.
double rounding(const ConvexBody& model, const Pose& frame_from_model,
                std::span<const PlacedShape> bodies) {
  double size = frame_from_model.position.norm() + model.bounding_radius;
  for (const PlacedShape& body : bodies) {
    size = std::max(size, body.frame_from_shape.position.norm() + body.shape->bounding_radius);
  }
  return kPlacingError * size + model.position_error;
}

}  // namespace

double certified_error(const ConvexBody& model, const Pose& frame_from_model,
                       std::span<const PlacedShape> bodies) {
  const double found = bound_without_radius(model, frame_from_model, bodies) + model.radius;
  return (std::max(0.0, found) + rounding(model, frame_from_model, bodies)) * kRoundedUp;
}

}  // namespace clearance
