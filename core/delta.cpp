#include "core/delta.hpp"

#include <cmath>

namespace clearance {
namespace {

// Directions whose cross product is shorter than this are parallel as far as doubles can tell: the
// unit vectors carry an error of 2^-52 each.
constexpr double kParallel = 0x1p-50;

Vec3 normal(const ActiveSide& s) noexcept { return s.direction_to_common(s.facet().normal); }
Vec3 direction(const ActiveSide& s) noexcept { return s.direction_to_common(s.edge().direction); }

Vec3 onto_plane(const Vec3& p, const Vec3& on, const Vec3& n) noexcept {
  return p - (p - on).dot(n) * n;
}
Vec3 onto_line(const Vec3& p, const Vec3& on, const Vec3& e) noexcept {
  return on + (p - on).dot(e) * e;
}

// In each case p has at most as many dimensions as q.
using Case = void (*)(const ActiveSide& p, const ActiveSide& q, Vec3& to_p, Vec3& to_q);

void vertex_vertex(const ActiveSide& p, const ActiveSide& q, Vec3& to_p, Vec3& to_q) {
  to_p = p.common();
  to_q = q.common();
}

void vertex_edge(const ActiveSide& p, const ActiveSide& q, Vec3& to_p, Vec3& to_q) {
  to_p = p.common();
  to_q = onto_line(p.common(), q.common(), direction(q));
}

void vertex_facet(const ActiveSide& p, const ActiveSide& q, Vec3& to_p, Vec3& to_q) {
  to_p = p.common();
  to_q = onto_plane(p.common(), q.common(), normal(q));
}

void vertex_inside(const ActiveSide& p, const ActiveSide&, Vec3& to_p, Vec3& to_q) {
  to_p = to_q = p.common();
}

void edge_edge(const ActiveSide& p, const ActiveSide& q, Vec3& to_p, Vec3& to_q) {
  const Vec3 e = direction(p), f = direction(q);
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
  const double s = -between.dot(across) / sine2;
  to_q = q.common() + s * f;
  to_p = onto_line(to_q, p.common(), e);
}

void edge_facet(const ActiveSide& p, const ActiveSide& q, Vec3& to_p, Vec3& to_q) {
  const Vec3 e = direction(p), n = normal(q);
  const double sine = e.dot(n);
  if (std::abs(sine) < kParallel) {
    to_p = 0.5 * (p.common() + onto_line(q.common(), p.common(), e));
    to_q = onto_plane(to_p, q.common(), n);
    return;
  }
  to_p = to_q = p.common() + ((q.common() - p.common()).dot(n) / sine) * e;
}

void edge_inside(const ActiveSide& p, const ActiveSide& q, Vec3& to_p, Vec3& to_q) {
  to_p = to_q = onto_line(q.common(), p.common(), direction(p));
}

void facet_facet(const ActiveSide& p, const ActiveSide& q, Vec3& to_p, Vec3& to_q) {
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

void facet_inside(const ActiveSide& p, const ActiveSide& q, Vec3& to_p, Vec3& to_q) {
  to_p = to_q = onto_plane(q.common(), p.common(), normal(p));
}

void inside_inside(const ActiveSide& p, const ActiveSide& q, Vec3& to_p, Vec3& to_q) {
  to_p = to_q = 0.5 * (p.common() + q.common());
}

// Table 3.1, the half where p has at most as many dimensions as q.
constexpr Case kCases[4][4] = {
    {vertex_vertex, vertex_edge, vertex_facet, vertex_inside},
    {nullptr, edge_edge, edge_facet, edge_inside},
    {nullptr, nullptr, facet_facet, facet_inside},
    {nullptr, nullptr, nullptr, inside_inside},
};

}  // namespace

Delta delta(const ActiveSide& a, const ActiveSide& b) noexcept {
  Delta result;
  const auto i = static_cast<int>(a.feature()), j = static_cast<int>(b.feature());
  if (i <= j) {
    kCases[i][j](a, b, result.a, result.b);
  } else {
    kCases[j][i](b, a, result.b, result.a);
  }
  return result;
}

}  // namespace clearance
