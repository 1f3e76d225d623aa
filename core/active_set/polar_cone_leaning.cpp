#include <algorithm>
#include <cmath>

#include "core/active_set/polar_cone.hpp"

namespace clearance {
namespace {

// Rays nearer to parallel than this may be known better by the way in which they lean apart.
constexpr double kLeaning = 0x1p-30;

}  // namespace

const Lean& PolarCone::lean() const noexcept {
  if (!lean_) lean_.emplace(*b_.pose(), rotation_.of_quaternions);
  return *lean_;
}

LongVec<7> PolarCone::exactly(const Constraint& c) const noexcept {
  LongVec<3> own = long_vec(c.ray->exactly);
  if (!c.of_b) return lean().kept(own);
  for (LongSum<3>& component : own) component.negate();
  return lean().turned(own);
}

void PolarCone::find_leaning(Level& level) const noexcept {
  if (!rotation_.says_all()) return;
  for (std::size_t i = 0; i < level.size; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      Constraint &c = level.items[i], &d = level.items[k];
      if (level.leaning_size == kMostLeaning) return;
      if (c.two_way && d.two_way && same_line(c, d)) continue;
      const Vec3 g = narrow(c.g), h = narrow(d.g);
      if (!(g.cross(h).norm() < kLeaning * g.norm() * h.norm())) continue;
      const Apart apart = clearance::apart(exactly(c), exactly(d));
      level.leaning[level.leaning_size++] = {
          .first = i,
          .second = k,
          .back = -apart.sign,
          .parallel = narrow(apart.way).isZero(0.0),
          .at_n = dot(apart.way, wide(level.n)),
          .along_t = dot(apart.way, wide(level.t)),
          .along_u = dot(apart.way, wide(level.u)),
      };
      if (apart.sign < 0.0) c.two_way = d.two_way = true;
    }
  }
}

const PolarCone::Leaning* PolarCone::leaning(const Level& level, std::size_t i,
                                             std::size_t k) noexcept {
  const auto* const end = level.leaning.data() + level.leaning_size;
  const auto* const found = std::find_if(level.leaning.data(), end, [&](const Leaning& pair) {
    return (pair.first == i && pair.second == k) || (pair.first == k && pair.second == i);
  });
  return found == end ? nullptr : found;
}

// Does k fall, or is it level, where i is exactly level?
bool PolarCone::falls_from(const Level& level, std::size_t i, std::size_t k, const DoubleDouble& x,
                           const DoubleDouble& y, double error) const noexcept {
  const Leaning* const pair = level.items[i].two_way ? leaning(level, i, k) : nullptr;
  if (pair == nullptr) return false;
  const double rise = static_cast<double>(pair->at_n + x * pair->along_t + y * pair->along_u);
  return pair->parallel || (pair->first == k ? pair->back : 1.0) * rise < -4.0 * (error + error_);
}

// Does k fall, or is it level, where i and j are both exactly level? For certain.
bool PolarCone::falls_across(const Level& level, std::size_t i, std::size_t j,
                             std::size_t k) const noexcept {
  const Constraint &c = level.items[i], &d = level.items[j], &e = level.items[k];
  if (i == j || !rotation_.says_all()) return false;
  const LongVec<14> normal = cross(exactly(c), exactly(d));
  const double side = narrow(rounded(normal)).dot(level.n);
  const int rise = dot(normal, exactly(e)).sign();
  return side > 0.5 ? rise <= 0 : side < -0.5 && rise >= 0;
}

}  // namespace clearance
