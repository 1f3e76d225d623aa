#include "config/decomposition/surface_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "config/decomposition/polygon.hpp"

namespace clearance {
namespace {

// After this many triangles, which take a few seconds, the search ends with its present bound.
constexpr std::size_t kMostPieces = 1'000'000;
// With fewer pieces than this, errors are resolved to kFine of the size; with more, to kCoarse.
constexpr std::size_t kFewPieces = 100'000;
constexpr double kFine = 5e-10, kCoarse = 1e-6;
// Relative: more than the rounding of plane tests and distances.
constexpr double kRounding = 1e-12;
// Relative: what is deeper in another part than this is inside it; more than the rounding of a
// polygon's vertices.
constexpr double kDeep = 1e-13;
// Relative: a triangle of the mesh whose vertices are this near to a facet's plane lies in it.
constexpr double kInPlane = 1e-6;
// Relative: triangles in a facet's plane are widened, so that no strip is left between two of them.
// A sharp vertex moves farther than an edge; it may move by kFarthestVertex.
constexpr double kWidened = 4e-13, kFarthestVertex = 1e-9;
// Relative: a triangle of this width counts as a line.
constexpr double kSliver = 2e-13;
// Opposite normals, up to rounding: 1 + their product.
constexpr double kOpposite = 1e-14;
// A facet that other parts and triangles split into more polygons is not split any further.
constexpr std::size_t kMostPolygons = 200;

// A triangle within a facet of a part.
struct FacetTriangle {
  double bound;  // of the distance from the mesh of its points on the union's surface, m
  std::size_t part;
  Triangle corners;
};
bool operator<(const FacetTriangle& a, const FacetTriangle& b) { return a.bound < b.bound; }

class Judge {
 public:
  Judge(std::span<const ConvexBody> parts, const TriangleTree& tree) : parts_(parts), tree_(tree) {
    for (const ConvexBody& part : parts) {
      boxes_.emplace_back();
      for (const Vertex& vertex : part.vertices) boxes_.back().extend(vertex.position);
      size_ = std::max(size_, part.bounding_radius);
    }
  }

  double error(double precise, double enough) {
    for (std::size_t i = 0; i < parts_.size(); ++i) add_facets(i);
    std::size_t pieces = open_.size();
    const auto precision = [&] {
      return pieces < kFewPieces ? kFine * size_ : std::max(precise, kCoarse * size_);
    };
    while (!open_.empty() && open_.top().bound > 1.02 * reached_ + precision() &&
           pieces < kMostPieces && reached_ <= enough) {
      const FacetTriangle piece = open_.top();
      open_.pop();
      halve(piece);
      pieces += 2;
    }
    const double left = open_.empty() ? 0.0 : open_.top().bound;
    return std::max({left, reached_, in_plane_}) + kRounding * size_;
  }

 private:
  void add_facets(std::size_t i) {
    const ConvexBody& part = parts_[i];
    for (const Facet& facet : part.facets) {
      Polygon corners;
      for (std::int32_t s = 0; s < facet.sides; ++s) {
        const EdgeUse& use = part.facet_edges[static_cast<std::size_t>(facet.first_side + s)];
        const Edge& edge = part.edges[static_cast<std::size_t>(use.edge)];
        corners.push_back(part.vertices[static_cast<std::size_t>(edge.vertex[use.side])].position);
      }
      for (const Polygon& polygon : surface_of(i, facet, std::move(corners))) {
        for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
          add(i, {polygon[0], polygon[k], polygon[k + 1]});
        }
      }
    }
  }

  // Returns what may be surface of the union and away from the mesh: the facet less the interior of
  // other parts, and less the triangles of the mesh in its plane.
  [[nodiscard]] std::vector<Polygon> surface_of(std::size_t i, const Facet& facet,
                                                Polygon corners) {
    Eigen::AlignedBox3d box;
    for (const Vec3& corner : corners) box.extend(corner);
    left_.assign(1, std::move(corners));
    for (std::size_t other = 0; other < parts_.size(); ++other) {
      if (other != i && boxes_[other].intersects(box)) take_away(inside_of(other, facet));
    }
    const HalfSpace plane{facet.normal, facet.offset};
    tree_.visit_near(plane, kInPlane * size_, box, [&](std::size_t t) {
      const Triangle& triangle = tree_.triangle(t);
      double height = 0.0;
      for (const Vec3& corner : triangle) {
        height = std::max(height, std::abs(plane.normal.dot(corner) - plane.offset));
      }
      if (height <= kInPlane * size_) take_triangle_away(triangle, plane.normal, height);
    });
    return left_;
  }

  // The half-spaces of a part, moved inwards by more than rounding. Where a facet of the part lies
  // against `facet`, they are moved outwards instead: both sides are inside the union. A crack
  // between such parts is narrower than twice the error and counts as solid. A rim that is left out
  // is as far from the mesh as the points beside it, up to rounding.
  [[nodiscard]] std::vector<HalfSpace> inside_of(std::size_t other, const Facet& facet) const {
    const auto lies_against = [&](const Facet& its) {
      return 1.0 + its.normal.dot(facet.normal) < kOpposite &&
             std::abs(its.offset + facet.offset) <= kDeep * size_;
    };
    const bool abuts = std::ranges::any_of(parts_[other].facets, lies_against);
    std::vector<HalfSpace> planes;
    for (const Facet& its : parts_[other].facets) {
      planes.push_back({its.normal, its.offset + (abuts ? kDeep : -kDeep) * size_});
    }
    return planes;
  }

  // Returns true when something was taken away.
  bool take_away(std::span<const HalfSpace> planes) {
    if (left_.empty() || left_.size() > kMostPolygons) return false;
    bool taken = false;
    next_.clear();
    for (const Polygon& polygon : left_) taken |= subtract(polygon, planes, next_);
    left_.swap(next_);
    return taken;
  }

  void take_triangle_away(const Triangle& triangle, const Vec3& up, double height) {
    const double widened = kWidened * size_;
    std::array<HalfSpace, 3> planes;
    double sine = 1.0;  // the least of half an angle
    const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    const double turn = normal.dot(up) < 0.0 ? -1.0 : 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 along = (triangle[(k + 1) % 3] - triangle[k]).normalized();
      const Vec3 back = (triangle[(k + 2) % 3] - triangle[k]).normalized();
      if (!along.allFinite() || !back.allFinite()) return;
      sine = std::min(sine, 0.5 * (along - back).norm());
      const Vec3 aside = (turn * along.cross(up)).normalized();
      planes[k] = {aside, aside.dot(triangle[k]) + widened};
    }
    const double farthest = widened / sine;
    if (!(farthest <= kFarthestVertex * size_)) return;
    if (take_away(planes)) in_plane_ = std::max(in_plane_, height + farthest);
  }

  void halve(const FacetTriangle& piece) {
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
    const Vec3& from = t[edge];
    const Vec3& to = t[(edge + 1) % 3];
    const double twice_area = (to - from).cross(t[(edge + 2) % 3] - from).norm();
    if (twice_area <= kSliver * size_ * (to - from).norm()) {
      // The edge stands for a sliver, whose halves would overlap.
      add(piece.part, {from, middle, middle});
      add(piece.part, {middle, to, to});
      return;
    }
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
  // m; reached_: the bound is at least this; in_plane_: of what lies in planes of the mesh
  double size_ = 0.0, reached_ = 0.0, in_plane_ = 0.0;
  std::priority_queue<FacetTriangle> open_;
  std::vector<Polygon> left_, next_;
};

}  // namespace

double surface_error(std::span<const ConvexBody> parts, const TriangleTree& tree, double precise,
                     double enough) {
  return Judge(parts, tree).error(precise, enough);
}

}  // namespace clearance
