#include "core/gjk/closest_on_simplex.hpp"

namespace clearance {
namespace {

using Points = std::array<WideVec, 4>;
using Weights = std::array<DoubleDouble, 4>;

// Barycentric coordinates of the origin's projection on the affine hull of one to four points, the
// others' staying 0. False: the points are affinely dependent, and a smaller subset has the point.
bool vertex_weights(const Points&, const std::array<int, 4>& at, Weights& w) noexcept {
  w[at[0]] = 1.0;
  return true;
}

bool edge_weights(const Points& p, const std::array<int, 4>& at, Weights& w) noexcept {
  const WideVec u = p[at[1]] - p[at[0]];
  const DoubleDouble uu = dot(u, u);
  if (!(uu.high > 0.0)) return false;
  const DoubleDouble t = -dot(p[at[0]], u) / uu;
  w[at[0]] = DoubleDouble(1.0) - t;
  w[at[1]] = t;
  return true;
}

// Areas of the three triangles that the origin's projection makes, over the whole.
bool triangle_weights(const Points& p, const std::array<int, 4>& at, Weights& w) noexcept {
  const WideVec &a = p[at[0]], &b = p[at[1]], &c = p[at[2]];
  const WideVec n = cross(b - a, c - a);
  const DoubleDouble nn = dot(n, n);
  if (!(nn.high > 0.0)) return false;
  w[at[0]] = dot(n, cross(b, c)) / nn;
  w[at[1]] = dot(n, cross(c, a)) / nn;
  w[at[2]] = DoubleDouble(1.0) - w[at[0]] - w[at[1]];
  return true;
}

bool tetrahedron_weights(const Points& p, const std::array<int, 4>& at, Weights& w) noexcept {
  const WideVec &a = p[at[0]], &b = p[at[1]], &c = p[at[2]], &d = p[at[3]];
  // Signed volumes that the origin makes with each face, over the whole (each six times too large).
  const DoubleDouble volume = dot(b - a, cross(c - a, d - a));
  if (volume.high == 0.0) return false;
  w[at[0]] = dot(b, cross(c, d)) / volume;
  w[at[1]] = -dot(a, cross(c, d)) / volume;
  w[at[2]] = dot(a, cross(b, d)) / volume;
  w[at[3]] = 1.0 - w[at[0]] - w[at[1]] - w[at[2]];  // whatever is left of a thin one's volume
  return true;
}

using Solve = bool (*)(const Points&, const std::array<int, 4>&, Weights&) noexcept;
constexpr std::array<Solve, 4> kSolve = {vertex_weights, edge_weights, triangle_weights,
                                         tetrahedron_weights};

bool non_negative(const Weights& w) noexcept {
  for (const DoubleDouble& x : w) {
    if (x.high < 0.0) return false;
  }
  return true;
}

}  // namespace

ClosestPoint closest_to_origin(const Points& points, std::size_t size) noexcept {
  // All 15 subsets, and the closest of those whose projection lies within. Johnson's recursion
  // decides by signs of determinants which subset it is; where rounding turns one of them, it ends
  // at none or the wrong one, while the least of lengths is off by rounding at most.
  ClosestPoint best;
  best.length2 = std::numeric_limits<double>::infinity();
  for (unsigned subset = 1; subset < (1u << size); ++subset) {
    std::array<int, 4> at{};
    std::size_t count = 0;
    for (int i = 0; i < static_cast<int>(size); ++i) {
      if (subset & (1u << i)) at[count++] = i;
    }
    Weights w{};
    if (!kSolve[count - 1](points, at, w) || !non_negative(w)) continue;
    WideVec v;
    for (std::size_t i = 0; i < size; ++i) v = v + w[i] * points[i];
    const DoubleDouble length2 = dot(v, v);
    if (length2 < best.length2) best = {v, w, length2};
  }
  return best;
}

}  // namespace clearance
