#include <cmath>

#include "core/depth_search.hpp"

namespace clearance {
namespace {

// Of a product of two unit vectors, both rounded.
constexpr double kArcError = 0x1p-50;

// An edge's direction and a ray's, both rounded.
constexpr double kSameRay = 0x1p-50;

}  // namespace

bool DepthSearch::rises_exactly(const Ray& ray, bool of_y,
                                const Vec3& exact_normal) const noexcept {
  if (!lean_ || !ray.exact || exact_normal.isZero(0.0)) return false;
  const bool of_a = of_y == body_.x_is_b();
  const int slope =
      of_a ? lean_->sign(ray.direction, exact_normal) : lean_->sign(exact_normal, ray.direction);
  return slope < 0;
}

// A ray that all but runs along the arc's edge is level at directions of the arc that its last
// digits decide. An edge without end is one of X's rays, and two rays are known precisely enough:
// off by less than what is allowed for directions beside their arc.
DepthSearch::Rise DepthSearch::rise(const Arc& arc, const Ray& ray) const noexcept {
  const WideVec g = wide_ * (wide(ray.direction) + wide(ray.rest));
  for (const Ray& own : body_.x().rays) {
    if (arc.edge.end < kInfinity) break;
    if (!((own.direction.normalized() - arc.edge.direction).norm() < kSameRay)) continue;
    if (const auto leaning = rise_of_leaning(arc, own, ray)) return *leaning;
    const WideVec e = wide(own.direction) + wide(own.rest);
    return {-arc.project(narrow(g - (dot(g, e) / dot(e, e)) * e)), 0.0};
  }
  const Vec3 unit = narrow(g).normalized();
  return {-arc.project(unit), kArcError + wide_.error};
}

std::optional<DepthSearch::Rise> DepthSearch::rise_of_leaning(const Arc& arc, const Ray& of_x,
                                                              const Ray& of_y) const noexcept {
  if (!lean_ || !of_x.exact || !of_y.exact) return {};
  const Vec3 &e = of_x.direction, &f = of_y.direction;
  if (!body_.x_is_b()) {
    return Rise{-arc.project(narrow(apart(lean_->kept(e), lean_->turned(f)).way)), 0.0};
  }
  const WideVec way = apart(lean_->turned(e), lean_->kept(f)).way;
  return Rise{-arc.project(narrow(wide_ * way)), 0.0};
}

DepthSearch::Vec2 DepthSearch::Rise::level(const Vec2& side) const noexcept {
  const Vec2 up = rate.stableNormalized(), across(-up.y(), up.x());
  const double off = error > 0.0 ? error / rate.norm() : 0.0;
  return ((across.dot(side) < 0.0 ? -across : across) + off * up).normalized();
}

}  // namespace clearance
