// The 'delta' step: the closest points of two features' affine hulls, the ten cases of Table 3.1
// (§3.4.2).
//
// If many pairs of points are closest, because the features are parallel, each point moves half of
// the distance, which is the smallest move (§3.4.2.1).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/active_set/active_feature.hpp"

namespace clearance {

struct Delta {
  Vec3 a, b;  // the new places of x of A and of B, frame A
};

namespace delta_case {

// Unit vectors with a shorter cross product are parallel as far as doubles can tell: once rotated,
// each is off by 2^-52.
constexpr double kParallelSine = 0x1p-50;

inline Vec3 normal(const ActiveFeature& s) noexcept { return s.direction_to_a(s.facet().normal); }
inline Vec3 along(const ActiveFeature& s) noexcept { return s.direction_to_a(s.edge().direction); }

inline Vec3 onto_plane(const Vec3& p, const Vec3& on, const Vec3& n) noexcept {
  return p - (p - on).dot(n) * n;
}
inline Vec3 onto_line(const Vec3& p, const Vec3& on, const Vec3& e) noexcept {
  return on + (p - on).dot(e) * e;
}

// In each case p has at most as many dimensions as q.

inline void vertex_vertex(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                          Vec3& to_q) noexcept {
  to_p = p.point_A();
  to_q = q.point_A();
}

inline void vertex_edge(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                        Vec3& to_q) noexcept {
  to_p = p.point_A();
  to_q = onto_line(p.point_A(), q.point_A(), along(q));
}

inline void vertex_facet(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                         Vec3& to_q) noexcept {
  to_p = p.point_A();
  to_q = onto_plane(p.point_A(), q.point_A(), normal(q));
}

inline void vertex_inside(const ActiveFeature& p, const ActiveFeature&, Vec3& to_p,
                          Vec3& to_q) noexcept {
  to_p = to_q = p.point_A();
}

inline void edge_edge(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                      Vec3& to_q) noexcept {
  const Vec3 e = along(p), f = along(q);
  const Vec3 between = q.point_A() - p.point_A();
  // The part of f across e: its length is the sine of the angle between them, without cancellation
  // in s.
  const Vec3 across = f - f.dot(e) * e;
  const double sine2 = across.squaredNorm();
  if (sine2 < kParallelSine * kParallelSine) {
    to_p = p.point_A() + 0.5 * between.dot(e) * e;
    to_q = onto_line(to_p, q.point_A(), f);
    return;
  }
  // `between` is projected across e as well: rounding leaves a part of e in `across`, which would
  // count for a long `between`.
  const double s = -(between - between.dot(e) * e).dot(across) / sine2;
  to_q = q.point_A() + s * f;
  to_p = onto_line(to_q, p.point_A(), e);
}

inline void edge_facet(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                       Vec3& to_q) noexcept {
  const Vec3 e = along(p), n = normal(q);
  const double sine = e.dot(n);
  if (std::abs(sine) < kParallelSine) {
    to_p = 0.5 * (p.point_A() + onto_line(q.point_A(), p.point_A(), e));
    to_q = onto_plane(to_p, q.point_A(), n);
    return;
  }
  to_p = to_q = p.point_A() + ((q.point_A() - p.point_A()).dot(n) / sine) * e;
}

inline void edge_inside(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                        Vec3& to_q) noexcept {
  to_p = to_q = onto_line(q.point_A(), p.point_A(), along(p));
}

inline void facet_facet(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                        Vec3& to_q) noexcept {
  const Vec3 n = normal(p), m = normal(q);
  const Vec3 n_across = n - n.dot(m) * m;  // in q's plane
  const Vec3 m_across = m - m.dot(n) * n;  // in p's plane
  const double sine2 = n_across.squaredNorm();
  if (sine2 < kParallelSine * kParallelSine) {
    to_p = 0.5 * (p.point_A() + onto_plane(q.point_A(), p.point_A(), n));
    to_q = onto_plane(to_p, q.point_A(), m);
    return;
  }
  const Vec3 between = q.point_A() - p.point_A();
  const Vec3 on_line_p = p.point_A() + (between.dot(m) / sine2) * m_across;
  const Vec3 on_line_q = q.point_A() - (between.dot(n) / sine2) * n_across;
  to_p = to_q = 0.5 * (on_line_p + on_line_q);
}

inline void facet_inside(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                         Vec3& to_q) noexcept {
  to_p = to_q = onto_plane(q.point_A(), p.point_A(), normal(p));
}

inline void inside_inside(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                          Vec3& to_q) noexcept {
  to_p = to_q = 0.5 * (p.point_A() + q.point_A());
}

}  // namespace delta_case

using DeltaCase = void(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                       Vec3& to_q) noexcept;

// Indexed [p][q], in the order of FeatureKind: one half of Table 3.1, which is symmetric.
inline constexpr std::array<std::array<DeltaCase*, 4>, 4> kDeltaTable = {
    {{delta_case::vertex_vertex, delta_case::vertex_edge, delta_case::vertex_facet,
      delta_case::vertex_inside},
     {nullptr, delta_case::edge_edge, delta_case::edge_facet, delta_case::edge_inside},
     {nullptr, nullptr, delta_case::facet_facet, delta_case::facet_inside},
     {nullptr, nullptr, nullptr, delta_case::inside_inside}}};

[[nodiscard]] inline Delta delta(const ActiveFeature& a, const ActiveFeature& b) noexcept {
  Delta result;
  const auto kind_a = static_cast<std::size_t>(a.feature());
  const auto kind_b = static_cast<std::size_t>(b.feature());
  if (kind_a <= kind_b) {
    kDeltaTable[kind_a][kind_b](a, b, result.a, result.b);
  } else {
    kDeltaTable[kind_b][kind_a](b, a, result.b, result.a);
  }
  return result;
}

}  // namespace clearance
