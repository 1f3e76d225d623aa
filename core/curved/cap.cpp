#include <algorithm>
#include <cmath>

#include "core/curved/max_min_programme.hpp"
#include "core/curved/thorough.hpp"

namespace clearance {
namespace {

// The cap's disc, and the other body in the cap's frame.
struct CapView {
  CurvedPair& pair;
  bool cap_is_of_a;
  Disc disc;
  Vec3 normal;  // frame A, from A to B

  [[nodiscard]] BodyView& other() const noexcept { return cap_is_of_a ? pair.b : pair.a; }
  // Rotates a direction from the cap's frame into that of the other body.
  [[nodiscard]] Vec3 direction_to_other(const Vec3& v) const noexcept {
    return cap_is_of_a ? pair.direction_to_b(v) : pair.direction_to_a(v);
  }
  // Projects a point of the other body's frame onto the cap's plane.
  [[nodiscard]] Vec2 in_plane(const Vec3& point) const noexcept {
    const Vec3 p = cap_is_of_a ? pair.point_to_a(point) : pair.point_to_b(point);
    return {p.x(), p.y()};
  }
  void add(const Vec2& on_cap, const Vec3& on_other) const noexcept {
    const Vec3 at(on_cap.x(), on_cap.y(), disc.height);
    cap_is_of_a ? pair.add_points(at, on_other) : pair.add_points(on_other, at);
  }
  // The point x with the least v.x among the other body's support points along the axis.
  [[nodiscard]] PointOfPart support_set_point(const Vec2& v) const noexcept {
    const Vec3 m = cap_is_of_a ? Vec3(-pair.direction_to_b(normal)) : normal;
    const Vec3 towards = direction_to_other(Vec3(-v.x(), -v.y(), 0.0));
    return visit(other(), [&](const auto& body) {
      return body.support_set_point(m, towards, pair.gap_tolerance());
    });
  }
};

// The point of the other body's support set that is nearest to the axis, in the cap's plane.
struct Nearest {
  Vec3 point = Vec3::Zero();  // in the other body's frame
  Vec2 in_plane = Vec2::Zero();
  std::array<std::int32_t, 3> parts{};
  std::size_t count = 0;
};

// Gilbert's iteration (E. G. Gilbert, SIAM J. Control 4, 1966) alternates two steps. One finds the
// point nearest to the axis in the hull of up to three points of the set. The other adds the
// support point of the set from there towards the axis.
Nearest nearest_of_support_set(const CapView& view) {
  std::array<PlaneFunction, 5> points{};
  std::array<PointOfPart, 5> found;
  std::size_t count = 0;
  Nearest nearest;
  nearest.in_plane = {1.0, 0.0};
  for (int round = 0; round < 32; ++round) {
    found[count] = view.support_set_point(nearest.in_plane);
    points[count] = {0.0, view.in_plane(found[count].point)};
    const double gain =
        round == 0 ? kInfinity : nearest.in_plane.dot(nearest.in_plane - points[count].slope);
    ++count;
    if (!(gain > 0x1p-52 * view.pair.size * nearest.in_plane.norm())) break;
    const PlaneStep step = max_min(points, count, {1.0, 0.0, 1.0});
    nearest = {};
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!(step.weights[i] > 0.0)) continue;
      nearest.point += step.weights[i] * found[i].point;
      nearest.parts[kept] = found[i].part;
      nearest.in_plane += step.weights[i] * points[i].slope;
      found[kept] = found[i];
      points[kept++] = points[i];
    }
    count = nearest.count = kept;
    if (nearest.in_plane.norm() <= view.disc.radius) break;
  }
  return nearest;
}

}  // namespace

CapTest test_cap(CurvedPair& pair, bool cap_is_of_a, const Vec3& n) noexcept {
  BodyView& body = cap_is_of_a ? pair.a : pair.b;
  const double along = cap_is_of_a ? n.z() : -pair.direction_to_b(n).z();
  const std::int32_t cap = along > 0.0 ? 1 : 0;
  const Vec3 axis(0.0, 0.0, along > 0.0 ? 1.0 : -1.0);
  const Vec3 normal = cap_is_of_a ? axis : Vec3(-pair.direction_to_a(axis));
  const Disc& disc = body.body->curved.discs[static_cast<std::size_t>(cap)];
  const CapView view{pair, cap_is_of_a, disc, normal};
  const Nearest nearest = nearest_of_support_set(view);
  const double across = nearest.in_plane.norm();
  CapTest test;
  test.normal = normal;
  test.closest = across <= disc.radius;
  if (across > 0.0) body.rim_azimuth = nearest.in_plane / across;
  // If a cap of the other body is parallel, too, this is the nearest point of that cap's rim.
  const double other_across = std::hypot(nearest.point.x(), nearest.point.y());
  if (has_caps(*view.other().body) && other_across > 0.0) {
    view.other().rim_azimuth = Vec2(nearest.point.x(), nearest.point.y()) / other_across;
  }
  view.add(test.closest ? nearest.in_plane : Vec2(nearest.in_plane * (disc.radius / across)),
           nearest.point);
  test.support = pair.support(normal);
  test.count = nearest.count;
  for (std::size_t i = 0; i < nearest.count; ++i) {
    test.parts[i] = cap_is_of_a ? PartPair{cap, nearest.parts[i]} : PartPair{nearest.parts[i], cap};
  }
  return test;
}

}  // namespace clearance
