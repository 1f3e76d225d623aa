#include <cmath>

#include "core/depth_search.hpp"

namespace clearance {
namespace {

// Of a product of two unit vectors, both rounded.
constexpr double kArcError = 0x1p-50;

// An edge's direction and a ray's, both rounded.
constexpr double kSameRay = 0x1p-50;

// Rays nearer to parallel are known better by the way in which they lean apart.
constexpr double kLeaning = 0x1p-30;

}  // namespace

bool DepthSearch::rises_exactly(const Ray& ray, bool of_y,
                                const ExactDirection& normal) const noexcept {
  if (!lean_) return false;
  const LongVec<3> g = long_vec(ray.exactly), n = long_vec(normal);
  const bool of_a = of_y == body_.x_is_b();
  return (of_a ? lean_->sign(g, n) : lean_->sign(n, g)) < 0;
}

// A ray that all but runs along the arc's edge is level at directions of the arc that its last
// digits decide. An edge without end is one of X's rays, and two rays are known precisely enough:
// off by less than what is allowed for directions beside their arc.
DepthSearch::Rise DepthSearch::rise(const Arc& arc, const Ray& ray) const noexcept {
  const WideVec g = wide_ * (wide(ray.direction) + wide(ray.rest));
  for (const Ray& own : body_.x().rays) {
    if (arc.edge.end < kInfinity) break;
    if (!((own.direction.normalized() - arc.edge.direction).norm() < kSameRay)) continue;
    const WideVec e = wide(own.direction) + wide(own.rest);
    const Vec3 across = narrow(g - (dot(g, e) / dot(e, e)) * e);
    const bool leans = across.norm() < kLeaning * own.direction.norm();
    return {-arc.project(lean_ && leans ? part_across(own, ray) : across), 0.0};
  }
  const Vec3 unit = narrow(g).normalized();
  return {-arc.project(unit), kArcError + wide_.error};
}

Vec3 DepthSearch::part_across(const Ray& of_x, const Ray& of_y) const noexcept {
  const LongVec<3> e = long_vec(of_x.exactly), f = long_vec(of_y.exactly);
  if (!body_.x_is_b()) return narrow(apart(lean_->kept(e), lean_->turned(f)).way);
  return narrow(wide_ * apart(lean_->turned(e), lean_->kept(f)).way);
}

DepthSearch::Vec2 DepthSearch::Rise::level(const Vec2& side) const noexcept {
  const Vec2 up = rate.stableNormalized(), across(-up.y(), up.x());
  const double off = error > 0.0 ? error / rate.norm() : 0.0;
  return ((across.dot(side) < 0.0 ? -across : across) + off * up).normalized();
}

}  // namespace clearance
