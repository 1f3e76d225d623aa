// One search for the direction of the shortest translation that separates two bodies (see
// core/penetration/depth.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/numerics/error_constants.hpp"
#include "core/penetration/deepest_points.hpp"
#include "core/penetration/deepest_vertices.hpp"
#include "core/penetration/minkowski_difference.hpp"

namespace clearance {

class NormalSearch {
 public:
  enum class Source : std::uint8_t { kNothing, kGuess, kFacetOfX, kFacetOfY, kArc };
  struct Best {
    double height = kInfinity;  // m: h(n)
    Vec3 n = Vec3::Zero();      // X's frame
    Source source = Source::kNothing;
    std::int32_t facet = kNone;
  };

  // gap_tolerance: m; a bound from below must come within this of the best h. direction_error: the
  // error of a direction rotated into the other body's frame.
  NormalSearch(const MinkowskiDifference& body, double gap_tolerance,
               double direction_error) noexcept
      : body_(body),
        gap_tolerance_(gap_tolerance),
        within_rounding_(0x1p-46 + direction_error),
        beyond_rounding_(kDerivativeError + direction_error) {}

  // Starts the search from a guess, any unit n, on the arc of `edge_of_x` unless that is kNone. A
  // wrong guess does no harm: it sets a value to beat, and run() still visits all facets and arcs.
  void guess(const Vec3& n, std::int32_t edge_of_x) noexcept;
  // Each of these stays the best unless another is better by more than rounding.
  void guess_facet_of_x(std::int32_t facet) noexcept {
    look_at_facet_of_x(facet);
    prefer(best_.n);
  }
  void guess_facet_of_y(std::int32_t facet) noexcept {
    look_at_facet_of_y(facet);
    prefer(best_.n);
  }
  // Searches all facets and arcs; stops early if the bodies turn out to be disjoint.
  void run() noexcept;

  [[nodiscard]] const Best& best() const noexcept { return best_; }
  // No h is lower (before rounding): valid after run() unless ended_early().
  [[nodiscard]] double lower() const noexcept { return lower_; }
  [[nodiscard]] bool ended_early() const noexcept { return best_.height <= gap_tolerance_; }

 private:
  using Vec2 = Eigen::Vector2d;

  // Directions x u + y w of the plane across an edge of X, and a point of that edge.
  struct Arc {
    Vec3 u, w, on_edge;
    const Edge& edge;
    [[nodiscard]] Vec3 direction(const Vec2& at) const noexcept { return at.x() * u + at.y() * w; }
    [[nodiscard]] Vec2 project(const Vec3& v) const noexcept { return {v.dot(u), v.dot(w)}; }
  };
  // The bounds that are known in one direction of an arc.
  struct Sample {
    Vec2 at;      // the direction
    Vec2 vertex;  // the support point along it, projected
    [[nodiscard]] double height() const noexcept { return vertex.dot(at); }
  };

  void prefer(const Vec3& n) noexcept {
    preferred_ = n;
    preference_ = 0.5 * gap_tolerance_;
  }
  // Is n the guessed direction, as facets and arcs represent it?
  [[nodiscard]] bool is_preferred(const Vec3& n) const noexcept {
    return (n - preferred_).squaredNorm() < kSame * kSame;
  }
  static constexpr double kSame = 0x1p-26;

  // m: the error of a point's depth below a facet of the other body. In roundings of both bodies'
  // size: 6 for its place, 2 for the normal, 4 for the product and the difference. gap_tolerance_
  // is 8.
  [[nodiscard]] double rounding_of_place() const noexcept { return 2.0 * gap_tolerance_; }

  [[nodiscard]] double height_to_reach() const noexcept { return best_.height - gap_tolerance_; }
  void improve(double height, const Vec3& n, Source source, std::int32_t facet) noexcept;
  void lower_to(double bound) noexcept { lower_ = std::min(lower_, bound); }

  // No facet or arc whose h is certified to be at least this can be better.
  [[nodiscard]] double sufficient_height() const noexcept { return best_.height - preference_; }

  // Has h not been shown to be as high as the best known one?
  [[nodiscard]] bool may_be_lowest_along(const Vec3& n) const noexcept;
  void look_at_facet_of_x(std::int32_t facet) noexcept;
  void look_at_facet_of_y(std::int32_t facet) noexcept;
  void facets_of_x() noexcept;
  void facets_of_y() noexcept;
  void arcs() noexcept;
  void arc_of(const Edge& edge) noexcept;
  void run_bounded() noexcept;
  // The body whose facets are evaluated, and the other body.
  struct Facing {
    const ConvexBody& body;
    const ConvexBody& other;
    Placement body_from_other;
    Source source;
    // The direction in the other's frame in which it is the deepest below a facet.
    [[nodiscard]] Vec3 against(const Facet& facet) const noexcept {
      return -(body_from_other.rotation.transpose() * facet.normal);
    }
    // The depth of one of the other body's vertices below a facet, m.
    [[nodiscard]] double below(const Facet& facet, std::int32_t vertex) const noexcept {
      return facet.offset - facet.normal.dot(body_from_other(other.anchors[vertex]));
    }
  };
  [[nodiscard]] Facing x_facing_y() const noexcept {
    return {body_.x(), body_.y(), body_.x_from_y(), Source::kFacetOfX};
  }
  [[nodiscard]] Facing y_facing_x() const noexcept {
    return {body_.y(), body_.x(), body_.y_from_x(), Source::kFacetOfY};
  }
  void take_least(const Facing& facing, const DeepestVertices& vertices) noexcept;
  std::int32_t look_up(const Facing& facing, std::int32_t facet) noexcept;
  DeepestPoints::Shallow narrow_down(const Facing& facing, DeepestPoints& points) noexcept;
  void look_at_facets(const Facing& facing, DeepestPoints& points) noexcept;
  void look_at_few(const Facing& facing, std::span<const std::uint16_t> facets,
                   std::uint16_t* vertices) noexcept;
  [[nodiscard]] bool is_bounded(const Facing& facing, std::int32_t facet,
                                std::int32_t vertex) noexcept;
  void few_vertices() noexcept;
  void facets_of_y_bounded() noexcept;
  // Each takes 82 kB of stack, which bodies of few vertices do not need.
  [[gnu::noinline]] void many_vertices() noexcept;
  [[gnu::noinline]] void facets_of_y_by_points() noexcept;
  void arcs(DeepestVertices& of_y) noexcept;
  void arcs(DeepestPoints& of_y) noexcept;
  void arcs_of(std::int32_t facet, DeepestPoints& of_y) noexcept;
  [[nodiscard]] Vec3 deepest_vertex_below(std::int32_t facet, DeepestPoints& of_y) const noexcept;
  [[nodiscard]] bool bounds_arc(const Facet& l, const Vec3& at_l, const Facet& r, const Vec3& at_r,
                                const DeepestPoints::Point* sphere) noexcept;
  void arc_from(const EdgeUse& use, const Vec3& at_own, const Vec3& at_other) noexcept;
  void full_circle(const Edge& edge) noexcept;
  [[nodiscard]] Arc across(const Edge& edge) const noexcept;
  // Does a direction of the arc's plane lie between the normals of the edge's facets?
  [[nodiscard]] bool within(const Arc& arc, const Vec2& at) const noexcept;

  [[nodiscard]] Sample sample(const Arc& arc, const Vec2& at) noexcept;
  void bound_arc(const Arc& arc, const Vec2& l, const Vec2& r) noexcept;
  void split(const Arc& arc, const Sample& l, const Sample& r) noexcept;

  const MinkowskiDifference& body_;
  double gap_tolerance_;
  // Rays whose directional derivative is smaller, per unit length, may be orthogonal to the
  // direction. The smaller limit is for the normals of Y's facets. A rotated normal is off by 5
  // ulps, the ray by 1, their product by 3.
  double within_rounding_, beyond_rounding_;
  Vec3 preferred_ = Vec3::Zero();  // the direction guessed
  double preference_ = 0.0;  // m: how much lower h must be in another one, while it is the best
  Best best_;
  double lower_ = kInfinity;

  // Caches the last vertex found in each of 24 cells of directions. A cell is one of the six signed
  // axes, and the signs of the other two components.
  static std::size_t cell(const Vec3& n) noexcept;
  [[nodiscard]] const Vec3* cached(const Vec3& n) const noexcept {
    return is_cached_[cell(n)] ? &cached_[cell(n)] : nullptr;
  }
  const Vec3& cache(const Vec3& n, const Vec3& vertex) noexcept {
    is_cached_[cell(n)] = true;
    return cached_[cell(n)] = vertex;
  }
  std::array<Vec3, 24> cached_;
  std::array<bool, 24> is_cached_{};
};

}  // namespace clearance
