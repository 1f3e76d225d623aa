#include "core/active_set/polar_cone.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {
namespace {

// Rays that fall by more than this go on falling after a move of at most kFarthest.
constexpr double kLevel = 0x1p-24, kFarthest = 0x1p-25;

// A product of a ray's digits (2^-104) with a direction, in wide numbers.
constexpr double kConstraintError = 0x1p-95;

// A facet's normal is rounded to 2^-53 in each component, and once more where it is turned.
constexpr double kFacetError = 0x1p-51;

// Of the cross product in wide numbers of a ray and one that has been turned, over their lengths.
constexpr double kTurnedError = 0x1p-99;

// Rays that cross at less have a direction across them that is better taken from long sums.
constexpr double kClearlyCrossing = 0x1p-30;

// Unit vectors made of doubles.
constexpr double kUnitError = 0x1p-51;

// Products of what is far from overflow are scaled up by the square of this: with none but two
// subnormals are digits lost below then.
constexpr double kUp = 0x1p500, kLeastProduct = 1e-250;

// Do the three products add up to 0 or less, for certain?
bool falls_or_is_level(const Vec3& n, const Vec3& g) noexcept {
  std::array<double, 6> parts{};
  for (int i = 0; i < 3; ++i) {
    if (n[i] == 0.0 || g[i] == 0.0) continue;
    const DoubleDouble p = exact::product(kUp * n[i], kUp * g[i]);
    if (!(std::abs(p.high) > kLeastProduct)) return false;
    parts[static_cast<std::size_t>(2 * i)] = p.low;
    parts[static_cast<std::size_t>(2 * i + 1)] = p.high;
  }
  return exact::sum_is_not_positive(parts);
}

// Null: none, or, of half-spaces and slabs, a whole plane of them.
const Ray* only_line(const ConvexPolyhedron& body) noexcept {
  const Ray* found = nullptr;
  int lines = 0;
  for (const Ray& ray : body.rays) {
    if (!ray.is_line) continue;
    found = &ray;
    ++lines;
  }
  return lines == 2 ? found : nullptr;
}

double value(const DoubleDouble& x) noexcept { return static_cast<double>(x); }

}  // namespace

PolarCone::PolarCone(const ActiveFeature& a, const ActiveFeature& b) noexcept
    : a_(a),
      b_(b),
      rotation_(wide_rotation(*b.pose())),
      error_(4.0 * rotation_.error + kConstraintError) {}

WideVec PolarCone::of_ray(const Ray& ray, bool of_b) const noexcept {
  const WideVec own = wide(ray.direction) + wide(ray.rest);
  return of_b ? rotation_ * own : own;
}

PolarCone::Direction PolarCone::across_lines(const Edge& of_a, const Edge& of_b) const noexcept {
  const Ray* along_a = a_.body().ray_along(of_a);
  const Ray* along_b = b_.body().ray_along(of_b);
  if (along_a == nullptr || along_b == nullptr) return {Vec3::Zero(), kInfinity};
  return across(*along_a, *along_b);
}

PolarCone::Direction PolarCone::across(const Ray& of_a, const Ray& of_b) const noexcept {
  const WideVec e = of_ray(of_a, false), f = of_ray(of_b, true);
  const double lengths = narrow(e).norm() * narrow(f).norm();
  WideVec n = cross(e, f);
  double sine = narrow(n).stableNorm() / lengths, error = rotation_.error + kTurnedError;
  if (rotation_.says_all() && !(sine > kClearlyCrossing)) {
    n = rounded(cross(lean().kept(long_vec(of_a.exactly)), lean().turned(long_vec(of_b.exactly))));
    sine = narrow(n).norm();
    error = kUnitError * sine;
  }
  if (!(sine > kParallel)) return {Vec3::Zero(), kInfinity};
  return {narrow(n).stableNormalized(), error / sine + kUnitError};
}

PolarCone::Direction PolarCone::of_facet(bool of_b, std::int32_t facet) const noexcept {
  if (!of_b) return {a_.body().facets[facet].normal, kFacetError};
  return {narrow(rotation_ * wide(b_.body().facets[facet].normal)), kFacetError + rotation_.error};
}

PolarCone::Slope PolarCone::slope_over_facet(bool of_b, std::int32_t facet,
                                             const Edge& edge) const noexcept {
  const ConvexPolyhedron &under = (of_b ? b_ : a_).body(), &over = (of_b ? a_ : b_).body();
  const Ray* const ray = over.ray_along(edge);
  if (ray == nullptr) return {0.0, kInfinity};
  const WideVec normal = rounded(long_vec(under.exact_normals[facet]));
  const WideVec n = of_b ? rotation_ * normal : normal, g = of_ray(*ray, !of_b);
  const double length = narrow(normal).norm() * ray->direction.norm();
  return {value(dot(n, g)) / length, error_};
}

PolarCone::Direction PolarCone::only_direction() const noexcept {
  const Ray* const along_a = only_line(a_.body());
  const Ray* const along_b = only_line(b_.body());
  if (along_a == nullptr || along_b == nullptr) return {Vec3::Zero(), kInfinity};
  return across(*along_a, *along_b);
}

PolarCone::Rise PolarCone::rise_of_others(const Direction& n) const noexcept {
  double steepest = -kInfinity;
  const auto look_at = [&](const ConvexPolyhedron& body, const Vec3& m) {
    for (const Ray& ray : body.rays) {
      if (ray.is_line) continue;
      steepest = std::max(steepest, m.dot(ray.direction) / ray.direction.norm());
    }
  };
  look_at(a_.body(), n.n);
  look_at(b_.body(), Vec3(-b_.direction_to_own(n.n)));
  const double unsure = n.off + kLevel;
  return steepest > unsure ? Rise::kRise : steepest < -unsure ? Rise::kFall : Rise::kUnknown;
}

// False: one rises, or there are too many.
bool PolarCone::collect(const ConvexPolyhedron& body, bool of_b, const Vec3& n,
                        Level& level) const noexcept {
  const Vec3 m = of_b ? Vec3(-b_.direction_to_own(n)) : n;
  for (const Ray& ray : body.rays) {
    const double slope = m.dot(ray.direction);
    if (slope < -kLevel) continue;
    if (slope > kLevel || level.size == level.items.size()) return false;
    Constraint& c = level.items[level.size++];
    c.g = of_ray(ray, of_b);
    if (of_b) c.g = WideVec{} - c.g;
    c.ray = &ray;
    c.of_b = of_b;
    c.known = ray.exact && (!of_b || rotation_.keeps_bits_of(ray.direction));
    c.two_way = false;
  }
  return true;
}

// For certain. A body without vertices has its lines as two rays each.
bool PolarCone::opposite(const Constraint& c, const Constraint& d) const noexcept {
  if (c.known && d.known) return narrow(c.g) == -narrow(d.g);
  const ConvexPolyhedron& body = c.of_b ? b_.body() : a_.body();
  return c.of_b == d.of_b && body.vertices.empty() && c.ray->exactly.is_opposite_to(d.ray->exactly);
}
bool PolarCone::same_line(const Constraint& c, const Constraint& d) const noexcept {
  return opposite(c, d) || (c.known && d.known && narrow(c.g) == narrow(d.g));
}

void PolarCone::prepare(const Vec3& n, Level& level) const noexcept {
  level.n = n;
  level.t = n.unitOrthogonal();
  level.u = n.cross(level.t);
  for (std::size_t i = 0; i < level.size; ++i) {
    Constraint& c = level.items[i];
    c.at_n = dot(c.g, wide(n));
    c.slope = value(c.at_n);
    c.along_t = dot(c.g, wide(level.t));
    c.along_u = dot(c.g, wide(level.u));
    for (std::size_t k = 0; k < i; ++k) {
      if (!opposite(c, level.items[k])) continue;
      c.two_way = level.items[k].two_way = true;
    }
  }
  find_leaning(level);
}

// Is n itself, or the facet's exact normal that it was rounded from, in the cone?
bool PolarCone::holds_as_it_is(const Separator& s, const Vec3& n,
                               const Level& level) const noexcept {
  const bool of_a = s.facet_of_a != kNone, of_b = s.facet_of_b != kNone;
  const double margin = 4.0 * error_ + (of_a || of_b ? 4.0 * kFacetError : 0.0);
  const auto certainly_falls = [&](const Constraint& c) {
    return (c.of_b ? of_b : of_a) || c.slope < -margin ||
           (c.known && !of_a && !of_b && falls_or_is_level(n, narrow(c.g)));
  };
  const auto *const first = level.items.data(), *const last = first + level.size;
  if (std::all_of(first, last, certainly_falls)) return true;
  if (!rotation_.says_all()) return false;
  const LongVec<7> exact_n =
      of_b ? lean().turned(long_vec(b_.body().exact_normals[s.facet_of_b]))
           : lean().kept(of_a ? long_vec(a_.body().exact_normals[s.facet_of_a]) : long_vec(n));
  return std::all_of(first, last, [&](const Constraint& c) {
    return certainly_falls(c) || (of_b ? -1 : 1) * dot(exact_n, exactly(c)).sign() <= 0;
  });
}

// A move after which the rays i and j are exactly as level as they should be, and which is off by
// at most `error`: do all others fall, or are they those two once more?
void PolarCone::try_move(const Level& level, std::size_t i, std::size_t j, const DoubleDouble& x,
                         const DoubleDouble& y, double error, Move& best) const noexcept {
  const double length2 = value(x * x + y * y);
  if (!(length2 < std::min(best.length2, kFarthest * kFarthest)) || !(error < kFarthest)) return;
  for (std::size_t k = 0; k < level.size; ++k) {
    const Constraint& c = level.items[k];
    if (k == i || k == j) continue;
    if (c.two_way && (same_line(c, level.items[i]) || same_line(c, level.items[j]))) continue;
    if (falls_from(level, i, k, x, y, error) || falls_from(level, j, k, x, y, error)) continue;
    const double rise = value(c.at_n + x * c.along_t + y * c.along_u);
    if (rise < -4.0 * (error + error_)) continue;
    if (rise > 4.0 * (error + error_) || !falls_across(level, i, j, k)) return;
  }
  best = {value(x), value(y), error, length2};
}

PolarCone::Move PolarCone::shortest_move(const Level& level) const noexcept {
  Move best;
  // Rays that need not be level shall fall by this, so that others of the same direction do.
  const auto rise_wanted = [&](const Constraint& c) {
    return c.at_n + DoubleDouble(c.two_way ? 0.0 : 16.0 * error_);
  };
  for (std::size_t i = 0; i < level.size; ++i) {
    const Constraint& c = level.items[i];
    const DoubleDouble square = c.along_t * c.along_t + c.along_u * c.along_u;
    if (!(square.high > 0.5)) continue;  // rays are of unit length or longer
    const DoubleDouble by = -rise_wanted(c) / square;
    try_move(level, i, i, by * c.along_t, by * c.along_u, 2.0 * error_, best);
    const auto try_both_level = [&](std::size_t j, const auto& d, const DoubleDouble& rise_d) {
      const DoubleDouble area = c.along_t * d.along_u - c.along_u * d.along_t;
      const double size = std::abs(value(area));
      if (!(size > 64.0 * error_)) return;
      const DoubleDouble rise_c = rise_wanted(c);
      const DoubleDouble x = (c.along_u * rise_d - d.along_u * rise_c) / area;
      const DoubleDouble y = (d.along_t * rise_c - c.along_t * rise_d) / area;
      // That far, where neither is two-way, the direction is beside the one across both.
      try_move(level, i, j, x, y, 64.0 * error_ / size, best);
    };
    for (std::size_t j = 0; j < i; ++j) {
      const Leaning* const pair = c.two_way ? leaning(level, i, j) : nullptr;
      if (pair != nullptr) {
        try_both_level(j, *pair, pair->at_n);
      } else {
        try_both_level(j, level.items[j], rise_wanted(level.items[j]));
      }
    }
  }
  return best;
}

PolarCone::Direction PolarCone::nearest(const Separator& s) const noexcept {
  const Vec3 n = s.facet_of_b != kNone ? Vec3(-of_facet(true, s.facet_of_b).n) : s.normal;
  const Direction none{n, kInfinity};
  Level level;
  if (!collect(a_.body(), false, n, level) || !collect(b_.body(), true, n, level)) return none;
  prepare(n, level);
  if (holds_as_it_is(s, n, level)) {
    if (s.facet_of_a != kNone) return {n, of_facet(false, s.facet_of_a).off};
    return {n, s.facet_of_b != kNone ? of_facet(true, s.facet_of_b).off : 0.0};
  }
  const Move move = shortest_move(level);
  if (!(move.length2 < kInfinity)) return none;
  return {(n + move.x * level.t + move.y * level.u).normalized(), move.error + kUnitError};
}

}  // namespace clearance
