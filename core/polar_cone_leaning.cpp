#include <algorithm>
#include <cmath>

#include "core/polar_cone.hpp"

namespace clearance {
namespace {

// Rays nearer to parallel than this may be known better by the way in which they lean apart.
constexpr double kLeaning = 0x1p-30;

}  // namespace

Lean::Apart PolarCone::apart(const Ray& of_a, const Ray& of_b) const noexcept {
  if (!rotation_.of_quaternions || !of_a.exact || !of_b.exact) return {};
  const Vec3 turned = narrow(rotation_ * wide(of_b.direction));
  if (!(of_a.direction.cross(turned).norm() < kLeaning)) return {};
  return Lean(*b_.pose()).apart(of_a.direction, of_b.direction);
}

void PolarCone::find_leaning(const Vec3& n, Level& level) const noexcept {
  for (std::size_t a = 0; a < level.size; ++a) {
    for (std::size_t b = 0; b < level.size; ++b) {
      Constraint &c = level.items[a], &d = level.items[b];
      if (c.of_b || !d.of_b || level.leaning_size == kMostLeaning) continue;
      const Lean::Apart lean = apart({c.own, c.exact}, {d.own, d.exact});
      if (!lean.known) continue;
      level.leaning[level.leaning_size++] = {
          .a = a,
          .b = b,
          .of_a = -lean.sign,
          .of_b = -1.0,
          .parallel = narrow(lean.way).isZero(0.0),
          .at_n = dot(lean.way, wide(n)),
          .along_t = dot(lean.way, wide(level.t)),
          .along_u = dot(lean.way, wide(level.u)),
      };
      if (lean.sign > 0.0) c.two_way = d.two_way = true;
    }
  }
}

const PolarCone::Leaning* PolarCone::leaning(const Level& level, std::size_t i,
                                             std::size_t k) noexcept {
  const auto* const end = level.leaning.data() + level.leaning_size;
  const auto* const found = std::find_if(level.leaning.data(), end, [&](const Leaning& pair) {
    return (pair.a == i && pair.b == k) || (pair.a == k && pair.b == i);
  });
  return found == end ? nullptr : found;
}

// Does k fall, or is it level, where i is exactly level?
bool PolarCone::falls_from(const Level& level, std::size_t i, std::size_t k, const DoubleDouble& x,
                           const DoubleDouble& y, double error) const noexcept {
  const Leaning* const pair = level.items[i].two_way ? leaning(level, i, k) : nullptr;
  if (pair == nullptr) return false;
  const double rise = static_cast<double>(pair->at_n + x * pair->along_t + y * pair->along_u);
  return pair->parallel ||
         (pair->a == k ? pair->of_a : pair->of_b) * rise < -4.0 * (error + error_);
}

// Does a ray of the other body than the facet's fall along its normal, or is it level, exactly?
bool PolarCone::stands_across(const Separator& s, const Constraint& c) const noexcept {
  if (!rotation_.of_quaternions || !c.exact) return false;
  const bool of_a = s.facet_of_a != kNone;
  const Vec3& normal =
      of_a ? a_.body().exact_normals[s.facet_of_a] : b_.body().exact_normals[s.facet_of_b];
  if (normal.isZero(0.0)) return false;
  const auto sign = Lean(*b_.pose()).sign(of_a ? normal : c.own, of_a ? c.own : normal);
  return sign.has_value() && *sign >= 0;
}

}  // namespace clearance
