// How far a model reaches beyond the bodies that it holds.
//
// The distance from one convex body is a convex function, so over a tetrahedron it is largest at a
// vertex. From the nearest of several it is not; but no point of the tetrahedron is farther from
// the nearest than the farthest vertex is from any one of them. Splitting makes that bound close.
#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <vector>

#include "core/distance.hpp"
#include "core/enclosing_polyhedron.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

// The bound is within 2 % of a distance that some point of the model has, or 400 splits are made:
// each costs one distance query a body.
constexpr double kCloseEnough = 0.98;
constexpr int kMostSplits = 400;

// Upper bounds of the signed distance of a point from each body, m.
std::vector<double> distances(const Vec3& position, std::span<const PlacedShape> bodies) {
  const ConvexBody probe = std::get<ConvexBody>(point(position, 0.0));
  std::vector<double> result;
  for (const PlacedShape& body : bodies) {
    TrackingState state;
    result.push_back(
        distance(probe, *body.shape, relative_pose({}, body.frame_from_shape), state).upper);
  }
  return result;
}

double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

struct MeasuredVertex {
  Vec3 position;
  std::vector<double> from;  // each body, m
};

struct Tetrahedron {
  std::array<int, 4> vertex;
  double open;  // no point of it is farther from the nearest body, m
};

bool operator<(const Tetrahedron& left, const Tetrahedron& right) { return left.open < right.open; }

class Search {
 public:
  Search(const ConvexBody& model, std::span<const PlacedShape> bodies) : bodies_(bodies) {
    for (const Vertex& vertex : model.vertices) add(vertex.position);
    const int centre = add(model.interior);
    for (const Facet& facet : model.facets) fan(model, facet, centre);
  }

  // Best first: the tetrahedron whose bound is the largest is split, as no other one can lower it.
  double run() {
    int splits = 0;
    while (splits++ < kMostSplits && reached_ < kCloseEnough * open_.top().open) {
      const Tetrahedron worst = open_.top();
      open_.pop();
      split(worst);
    }
    return std::max(0.0, open_.top().open);
  }

 private:
  int add(const Vec3& position) {
    vertices_.push_back({position, distances(position, bodies_)});
    reached_ = std::max(reached_, least(vertices_.back().from));
    return static_cast<int>(vertices_.size()) - 1;
  }

  [[nodiscard]] const MeasuredVertex& at(int vertex) const {
    return vertices_[static_cast<std::size_t>(vertex)];
  }

  // Triangles of the facet's polygon from its first vertex, with the centre.
  void fan(const ConvexBody& model, const Facet& facet, int centre) {
    std::vector<int> ring;
    for (std::int32_t i = facet.first_side; i < facet.first_side + facet.sides; ++i) {
      const EdgeUse& use = model.facet_edges[static_cast<std::size_t>(i)];
      ring.push_back(model.edges[static_cast<std::size_t>(use.edge)].vertex[use.side]);
    }
    for (std::size_t i = 2; i < ring.size(); ++i) {
      push({ring[0], ring[i - 1], ring[i], centre});
    }
  }

  void push(const std::array<int, 4>& vertex) {
    double open = kInfinity;
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
      double farthest = -kInfinity;
      for (const int c : vertex) farthest = std::max(farthest, at(c).from[body]);
      open = std::min(open, farthest);
    }
    open_.push({vertex, open});
  }

  // In the middle of its longest edge.
  void split(const Tetrahedron& whole) {
    std::array<std::size_t, 2> longest{0, 1};
    double length = -1.0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        const double l = (at(whole.vertex[i]).position - at(whole.vertex[j]).position).norm();
        if (l > length) longest = {i, j}, length = l;
      }
    }
    const int middle =
        add(0.5 * (at(whole.vertex[longest[0]]).position + at(whole.vertex[longest[1]]).position));
    for (const std::size_t end : longest) {
      std::array<int, 4> half = whole.vertex;
      half[end] = middle;
      push(half);
    }
  }

  std::span<const PlacedShape> bodies_;
  std::vector<MeasuredVertex> vertices_;
  std::priority_queue<Tetrahedron> open_;
  double reached_ = -kInfinity;  // some point of the model is about this far from the nearest, m
};

// What doubles may have moved: a midpoint of the model, or a body.
double rounding(const ConvexBody& model, std::span<const PlacedShape> bodies) {
  double size = model.bounding_radius;
  for (const PlacedShape& body : bodies) {
    size = std::max(size, body.frame_from_shape.position.norm() + body.shape->bounding_radius);
  }
  return kPlacingError * size + model.position_error;
}

}  // namespace

double excess(const ConvexBody& model, std::span<const PlacedShape> bodies) {
  return (Search(model, bodies).run() + rounding(model, bodies)) * kRoundedUp;
}

// The signed distance from a body grows by no more than the length of a displacement.
double excess_of_sphere(const Vec3& centre, double radius, std::span<const PlacedShape> bodies) {
  return std::max(0.0, least(distances(centre, bodies)) + radius) * kRoundedUp;
}

}  // namespace clearance
