#include "config/decomposition/surface_error.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>
#include <vector>

namespace clearance {
namespace {

// After this many triangles, which take a few seconds, the search ends with its present bound.
constexpr std::size_t kMostPieces = 1'000'000;
// Relative: more than the rounding of plane tests and distances.
constexpr double kRounding = 1e-12;

// A triangle within a facet of a part.
struct Piece {
  double bound;  // of the distance from the mesh of its points on the union's surface, m
  std::size_t part;
  Triangle corners;
};
bool operator<(const Piece& a, const Piece& b) { return a.bound < b.bound; }

class Judge {
 public:
  Judge(std::span<const ConvexBody> parts, const TriangleTree& tree) : parts_(parts), tree_(tree) {
    for (const ConvexBody& part : parts) {
      boxes_.emplace_back();
      for (const Vertex& vertex : part.vertices) boxes_.back().extend(vertex.position);
      size_ = std::max(size_, part.bounding_radius);
    }
  }

  double error() {
    for (std::size_t i = 0; i < parts_.size(); ++i) add_facets(i);
    std::size_t pieces = open_.size();
    while (!open_.empty() && open_.top().bound > 1.02 * reached_ + 1e-6 * size_ &&
           pieces < kMostPieces) {
      const Piece piece = open_.top();
      open_.pop();
      halve(piece);
      pieces += 2;
    }
    const double left = open_.empty() ? 0.0 : open_.top().bound;
    return std::max(left, reached_) + kRounding * size_;
  }

 private:
  void add_facets(std::size_t i) {
    const ConvexBody& part = parts_[i];
    for (const Facet& facet : part.facets) {
      std::vector<Vec3> corners;
      for (std::int32_t s = 0; s < facet.sides; ++s) {
        const EdgeUse& use = part.facet_edges[static_cast<std::size_t>(facet.first_side + s)];
        const Edge& edge = part.edges[static_cast<std::size_t>(use.edge)];
        corners.push_back(part.vertices[static_cast<std::size_t>(edge.vertex[use.side])].position);
      }
      for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
        add(i, {corners[0], corners[k], corners[k + 1]});
      }
    }
  }

  void halve(const Piece& piece) {
    const Triangle& t = piece.corners;
    std::size_t edge = 0;
    double longest = -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double length = (t[(i + 1) % 3] - t[i]).squaredNorm();
      if (length > longest) {
        longest = length;
        edge = i;
      }
    }
    const Vec3 middle = 0.5 * (t[edge] + t[(edge + 1) % 3]);
    add(piece.part, {t[edge], middle, t[(edge + 2) % 3]});
    add(piece.part, {middle, t[(edge + 1) % 3], t[(edge + 2) % 3]});
  }

  void add(std::size_t part, const Triangle& corners) {
    if (is_covered(part, corners)) return;
    const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    const auto nearest = tree_.nearest(middle);
    double bound = worst(corners, nearest.triangle);
    double radius = 0.0;
    for (const Vec3& corner : corners) radius = std::max(radius, (corner - middle).norm());
    bound = std::min(bound, nearest.distance + radius);
    if (bound > reached_ && nearest.distance > reached_ &&
        !is_covered(part, {middle, middle, middle})) {
      reached_ = nearest.distance;
    }
    if (bound > reached_) open_.push({bound, part, corners});
  }

  [[nodiscard]] double worst(const Triangle& corners, std::size_t triangle) const {
    double most = 0.0;
    for (const Vec3& corner : corners) {
      most = std::max(most, distance_to(tree_.triangle(triangle), corner));
    }
    return most;
  }

  // Tells whether all of it lies strictly within one other part.
  [[nodiscard]] bool is_covered(std::size_t part, const Triangle& corners) const {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (i == part) continue;
      const bool near = std::ranges::all_of(
          corners, [&](const Vec3& corner) { return boxes_[i].contains(corner); });
      if (near && holds(parts_[i], corners)) return true;
    }
    return false;
  }

  [[nodiscard]] bool holds(const ConvexBody& part, const Triangle& corners) const {
    return std::ranges::all_of(part.facets, [&](const Facet& facet) {
      return std::ranges::all_of(corners, [&](const Vec3& corner) {
        return facet.normal.dot(corner) < facet.offset - kRounding * size_;
      });
    });
  }

  std::span<const ConvexBody> parts_;
  const TriangleTree& tree_;
  std::vector<Eigen::AlignedBox3d> boxes_;
  double size_ = 0.0, reached_ = 0.0;
  std::priority_queue<Piece> open_;
};

}  // namespace

double surface_error(std::span<const ConvexBody> parts, const TriangleTree& tree) {
  return Judge(parts, tree).error();
}

}  // namespace clearance
