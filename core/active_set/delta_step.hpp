// The 'delta' step: the closest points of two features' affine hulls, the ten cases of Table 3.1
// (§3.4.2).
//
// Where many pairs are closest (parallel features) the smallest move is chosen: halfway each
// (§3.4.2.1).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/active_set/active_feature.hpp"

namespace clearance {

struct Delta {
  Vec3 a, b;  // where x of A and of B should go, common frame
};

namespace delta_case {

// Directions whose cross product is shorter than this are parallel as far as doubles can tell: the
// unit vectors, once turned, carry an error of 2^-52 each.
constexpr double kParallel = 0x1p-50;

inline Vec3 normal(const ActiveFeature& s) noexcept {
  return s.direction_to_common(s.facet().normal);
}
inline Vec3 along(const ActiveFeature& s) noexcept {
  return s.direction_to_common(s.edge().direction);
}

inline Vec3 onto_plane(const Vec3& p, const Vec3& on, const Vec3& n) noexcept {
  return p - (p - on).dot(n) * n;
}
inline Vec3 onto_line(const Vec3& p, const Vec3& on, const Vec3& e) noexcept {
  return on + (p - on).dot(e) * e;
}

// In each case p has at most as many dimensions as q.

inline void vertex_vertex(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                          Vec3& to_q) noexcept {
  to_p = p.common();
  to_q = q.common();
}

inline void vertex_edge(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                        Vec3& to_q) noexcept {
  to_p = p.common();
  to_q = onto_line(p.common(), q.common(), along(q));
}

inline void vertex_facet(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                         Vec3& to_q) noexcept {
  to_p = p.common();
  to_q = onto_plane(p.common(), q.common(), normal(q));
}

inline void vertex_inside(const ActiveFeature& p, const ActiveFeature&, Vec3& to_p,
                          Vec3& to_q) noexcept {
  to_p = to_q = p.common();
}

inline void edge_edge(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                      Vec3& to_q) noexcept {
  const Vec3 e = along(p), f = along(q);
  const Vec3 between = q.common() - p.common();
  // The part of f across e: its length is the sine of the angle between them, without cancellation
  // in s.
  const Vec3 across = f - f.dot(e) * e;
  const double sine2 = across.squaredNorm();
  if (sine2 < kParallel * kParallel) {
    to_p = p.common() + 0.5 * between.dot(e) * e;
    to_q = onto_line(to_p, q.common(), f);
    return;
  }
  // Across e as well: of a long `between`, what rounding leaves of e in `across` would count.
  const double s = -(between - between.dot(e) * e).dot(across) / sine2;
  to_q = q.common() + s * f;
  to_p = onto_line(to_q, p.common(), e);
}

inline void edge_facet(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                       Vec3& to_q) noexcept {
  const Vec3 e = along(p), n = normal(q);
  const double sine = e.dot(n);
  if (std::abs(sine) < kParallel) {
    to_p = 0.5 * (p.common() + onto_line(q.common(), p.common(), e));
    to_q = onto_plane(to_p, q.common(), n);
    return;
  }
  to_p = to_q = p.common() + ((q.common() - p.common()).dot(n) / sine) * e;
}

inline void edge_inside(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                        Vec3& to_q) noexcept {
  to_p = to_q = onto_line(q.common(), p.common(), along(p));
}

inline void facet_facet(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                        Vec3& to_q) noexcept {
  const Vec3 n = normal(p), m = normal(q);
  const Vec3 n_across = n - n.dot(m) * m;  // in q's plane
  const Vec3 m_across = m - m.dot(n) * n;  // in p's plane
  const double sine2 = n_across.squaredNorm();
  if (sine2 < kParallel * kParallel) {
    to_p = 0.5 * (p.common() + onto_plane(q.common(), p.common(), n));
    to_q = onto_plane(to_p, q.common(), m);
    return;
  }
  const Vec3 between = q.common() - p.common();
  const Vec3 on_line_p = p.common() + (between.dot(m) / sine2) * m_across;
  const Vec3 on_line_q = q.common() - (between.dot(n) / sine2) * n_across;
  to_p = to_q = 0.5 * (on_line_p + on_line_q);
}

inline void facet_inside(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                         Vec3& to_q) noexcept {
  to_p = to_q = onto_plane(q.common(), p.common(), normal(p));
}

inline void inside_inside(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                          Vec3& to_q) noexcept {
  to_p = to_q = 0.5 * (p.common() + q.common());
}

}  // namespace delta_case

using DeltaCase = void(const ActiveFeature& p, const ActiveFeature& q, Vec3& to_p,
                       Vec3& to_q) noexcept;

// [p][q], in the order of FeatureKind: the half of Table 3.1 that is not its mirror image.
inline constexpr std::array<std::array<DeltaCase*, 4>, 4> kDeltaTable = {
    {{delta_case::vertex_vertex, delta_case::vertex_edge, delta_case::vertex_facet,
      delta_case::vertex_inside},
     {nullptr, delta_case::edge_edge, delta_case::edge_facet, delta_case::edge_inside},
     {nullptr, nullptr, delta_case::facet_facet, delta_case::facet_inside},
     {nullptr, nullptr, nullptr, delta_case::inside_inside}}};

[[nodiscard]] inline Delta delta(const ActiveFeature& a, const ActiveFeature& b) noexcept {
  Delta result;
  const auto of_a = static_cast<std::size_t>(a.feature());
  const auto of_b = static_cast<std::size_t>(b.feature());
  if (of_a <= of_b) {
    kDeltaTable[of_a][of_b](a, b, result.a, result.b);
  } else {
    kDeltaTable[of_b][of_a](b, a, result.b, result.a);
  }
  return result;
}

}  // namespace clearance
