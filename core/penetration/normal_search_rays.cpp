#include <cmath>

#include "core/penetration/normal_search.hpp"

namespace clearance {
namespace {

// Of a product of two unit vectors, both rounded.
constexpr double kArcError = 0x1p-50;

// Rays nearer to parallel are known better by the way in which they lean apart.
constexpr double kLeaning = 0x1p-30;

}  // namespace

LongSum<10> DepthSearch::fall(const Ray& ray, bool of_y,
                              const ExactDirection& normal) const noexcept {
  const LongVec<3> g = long_vec(ray.exactly), n = long_vec(normal);
  const bool of_a = of_y == body_.x_is_b();
  return of_a ? dot(g, lean_->turned(n)) : dot(n, lean_->turned(g));
}

bool DepthSearch::rises_exactly(const Ray& ray, bool of_y,
                                const ExactDirection& normal) const noexcept {
  return lean_ && fall(ray, of_y, normal).sign() < 0;
}

// Between the normals l and r the level ray falls along one and rises along the other, so that it
// is level along l |its fall along r| + r |its fall along l|.
bool DepthSearch::rises_exactly(const Ray& ray, const Arc& arc, std::size_t end,
                                const Ray* level) const noexcept {
  if (!lean_) return false;
  const auto along = [&](const Ray& of, std::size_t k) {
    return fall(of, true, body_.x().exact_normals[arc.edge.facet[k]]);
  };
  if (level == nullptr) return along(ray, end).sign() < 0;
  const LongSum<10> level_l = along(*level, 0), level_r = along(*level, 1);
  LongSum<20> falls;
  falls.add_product(along(ray, 0), level_r);
  falls.add_product(along(ray, 1), level_l, -1);
  const int falls_to_r = level_r.sign() != 0 ? level_r.sign() : -level_l.sign();
  return falls_to_r * falls.sign() < 0;
}

// A ray that all but runs along the arc's edge is level at directions of the arc that its last
// digits decide. An edge without end runs along one of X's rays, and two rays are known precisely
// enough: off by less than what is allowed for directions beside their arc.
DepthSearch::Rise DepthSearch::rise(const Arc& arc, const Ray& ray) const noexcept {
  const WideVec g = wide_ * (wide(ray.direction) + wide(ray.rest));
  if (const Ray* const own = body_.x().ray_along(arc.edge)) {
    const WideVec e = wide(own->direction) + wide(own->rest);
    const Vec3 across = narrow(g - (dot(g, e) / dot(e, e)) * e);
    const bool leans = across.norm() < kLeaning * own->direction.norm();
    return {-arc.project(lean_ && leans ? part_across(*own, ray) : across), 0.0};
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
