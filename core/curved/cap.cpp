#include "core/curved/cap.hpp"

#include <algorithm>
#include <cmath>

#include "core/curved/direction_programme.hpp"
#include "core/curved/piece-inl.hpp"

namespace clearance {
namespace {

// An axis that is off the other's by no more than this is parallel to it.
constexpr double kParallel = 0x1p-50;

// The cap's disc, and the bodies as it sees them.
struct CapView {
  CurvedPair& pair;
  bool of_a;
  Disc disc;
  Vec3 normal;  // frame A, from A to B

  [[nodiscard]] const PieceSource& other() const noexcept { return of_a ? pair.b : pair.a; }
  [[nodiscard]] PieceSource& other() noexcept { return of_a ? pair.b : pair.a; }
  // Outwards of the other body, in its frame.
  [[nodiscard]] Vec3 to_cap(const Vec3& n) const noexcept {
    return of_a ? Vec3(-pair.direction_to_b(n)) : n;
  }
  // Of a point of the other body's frame.
  [[nodiscard]] Vec2 in_plane(const Vec3& own) const noexcept {
    const Vec3 p = of_a ? pair.point_to_a(own) : pair.point_to_b(own);
    return {p.x(), p.y()};
  }
  void add(const Vec2& on_cap, const Vec3& own) const noexcept {
    const Vec3 at(on_cap.x(), on_cap.y(), disc.height);
    of_a ? pair.add_points(at, own) : pair.add_points(own, at);
  }
};

// The point of the other body's support set that is nearest to the axis, in the plane; by Gilbert's
// iteration: of up to three points, and then the set's point farthest towards the axis.
struct Nearest {
  Vec3 own;
  Vec2 in_plane;
  std::array<std::int32_t, 3> pieces{};
  std::size_t count = 0;
};

// A support point and the piece it is of.
struct PieceOfSet {
  Vec3 own = Vec3::Zero();
  std::int32_t piece = 0;
};

// All vertices, rays' ends among them, of the support set of a polyhedron along m, as a linear
// function v decides: the least of it.
PieceOfSet least_vertex(const CapView& view, const Vec3& m, double tolerance, const Vec2& v) {
  const ConvexBody& body = *view.other().body;
  const double top = m.dot(support_point(view.other(), farthest_piece(view.other(), m), m));
  double least = kInfinity;
  PieceOfSet found;
  for (std::int32_t i = 0; i < pieces_of(body); ++i) {
    const Vec3 vertex = support_point(view.other(), i, m);
    if (m.dot(vertex) < top - tolerance) continue;
    const double value = v.dot(view.in_plane(vertex));
    if (value < least) {
      least = value;
      found = {vertex, i};
    }
  }
  return found;
}

// The same of a truncated cone.
PieceOfSet least_on_cone(const CapView& view, const Vec3& m, double tolerance, const Vec2& v) {
  const PieceSource& other = view.other();
  const Azimuth azimuth = azimuth_of(other, m);
  if (azimuth.across <= kParallel) {
    const std::int32_t piece = m.z() > 0.0 ? 1 : 0;
    const Disc& disc = other.body->curved.discs[static_cast<std::size_t>(piece)];
    const Vec3 centre(0.0, 0.0, disc.height);
    const Vec2 zero = view.in_plane(centre);
    const Vec2 x = view.in_plane(centre + Vec3::UnitX()) - zero;
    const Vec2 y = view.in_plane(centre + Vec3::UnitY()) - zero;
    const Vec2 to = Vec2(-v.dot(x), -v.dot(y)).normalized();
    return {Vec3(disc.radius * to.x(), disc.radius * to.y(), disc.height), piece};
  }
  const Vec3 low = support_point(other, 0, m), high = support_point(other, 1, m);
  const double at_low = m.dot(low), at_high = m.dot(high);
  const bool level = std::abs(at_high - at_low) <= tolerance;
  const bool is_high =
      level ? v.dot(view.in_plane(high)) < v.dot(view.in_plane(low)) : at_high > at_low;
  return is_high ? PieceOfSet{high, 1} : PieceOfSet{low, 0};
}

PieceOfSet least_of_support_set(const CapView& view, const Vec3& m, double tolerance,
                                const Vec2& v) {
  switch (view.other().body->curved.kind) {
    case CurvedShape::Kind::kNone:
      return least_vertex(view, m, tolerance, v);
    case CurvedShape::Kind::kEllipsoid:
      return {support_point(view.other(), 0, m), 0};
    case CurvedShape::Kind::kTruncatedCone:
      break;
  }
  return least_on_cone(view, m, tolerance, v);
}

Nearest nearest_of_support_set(const CapView& view) {
  const Vec3 m = view.to_cap(view.normal);
  const double tolerance = view.pair.gap_tolerance();
  std::array<PlaneFunction, 5> points{};
  std::array<PieceOfSet, 5> own;
  std::size_t count = 0;
  Nearest nearest{Vec3::Zero(), Vec2(1.0, 0.0), {}, 0};
  for (int round = 0; round < 32; ++round) {
    own[count] = least_of_support_set(view, m, tolerance, nearest.in_plane);
    points[count] = {0.0, view.in_plane(own[count].own)};
    const double gain =
        round == 0 ? kInfinity : nearest.in_plane.dot(nearest.in_plane - points[count].slope);
    ++count;
    if (!(gain > 0x1p-52 * view.pair.size * nearest.in_plane.norm())) break;
    const PlaneStep step = highest_least(points, count, {1.0, 0.0, 1.0});
    nearest = {Vec3::Zero(), Vec2::Zero(), {}, 0};
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!(step.weights[i] > 0.0)) continue;
      nearest.own += step.weights[i] * own[i].own;
      nearest.pieces[kept] = own[i].piece;
      nearest.in_plane += step.weights[i] * points[i].slope;
      own[kept] = own[i];
      points[kept++] = points[i];
    }
    count = nearest.count = kept;
    if (nearest.in_plane.norm() <= view.disc.radius) break;
  }
  return nearest;
}

}  // namespace

CapTest test_cap(CurvedPair& pair, bool of_a, const Vec3& n) noexcept {
  PieceSource& source = of_a ? pair.a : pair.b;
  const double along = of_a ? n.z() : -pair.direction_to_b(n).z();
  const std::size_t piece = along > 0.0 ? 1 : 0;
  const Vec3 axis(0.0, 0.0, along > 0.0 ? 1.0 : -1.0);
  CapView view{pair, of_a, source.body->curved.discs[piece], {}};
  view.normal = of_a ? axis : Vec3(-pair.direction_to_a(axis));
  const Nearest nearest = nearest_of_support_set(view);
  const double across = nearest.in_plane.norm();
  CapTest test;
  test.normal = view.normal;
  test.closest = across <= view.disc.radius;
  if (across > 0.0) source.rim_azimuth = nearest.in_plane / across;
  // Where the other body's cap is parallel, too, its rim's nearest point.
  if (view.other().body->curved.kind == CurvedShape::Kind::kTruncatedCone) {
    const double other_across = std::hypot(nearest.own.x(), nearest.own.y());
    if (other_across > 0.0) {
      view.other().rim_azimuth =
          Vec2(nearest.own.x() / other_across, nearest.own.y() / other_across);
    }
  }
  view.add(test.closest ? nearest.in_plane : Vec2(nearest.in_plane * (view.disc.radius / across)),
           nearest.own);
  test.support = pair.support(view.normal);
  const auto own_piece = static_cast<std::int32_t>(piece);
  test.count = nearest.count;
  for (std::size_t i = 0; i < nearest.count; ++i) {
    test.pieces[i] =
        of_a ? PiecePair{own_piece, nearest.pieces[i]} : PiecePair{nearest.pieces[i], own_piece};
  }
  return test;
}

}  // namespace clearance
