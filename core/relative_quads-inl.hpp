// RelativePose as the queries use it, compiled once a vector width: see core/quad-inl.hpp.
#if defined(CLEARANCE_CORE_RELATIVE_QUADS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_RELATIVE_QUADS
#undef CLEARANCE_CORE_RELATIVE_QUADS
#else
#define CLEARANCE_CORE_RELATIVE_QUADS
#endif

#include "core/exact_orientation.hpp"
#include "core/pose.hpp"
#include "core/quad-inl.hpp"
#include "core/rounding.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// B as seen from A, and the rotation's rows as well: A's axes as seen from B.
struct RelativeQuads {
  Quad column[3], row[3];
  Quad translation;
  double rotation_error, translation_error, apart;  // as in RelativePose
};

HWY_INLINE Quad combined(const Quad (&axes)[3], Quad v) {
  return (lane(v, 0) * axes[0] + lane(v, 1) * axes[1]) + lane(v, 2) * axes[2];
}
HWY_INLINE Quad direction_to_a(const RelativeQuads& r, Quad v) { return combined(r.column, v); }
HWY_INLINE Quad direction_to_b(const RelativeQuads& r, Quad v) { return combined(r.row, v); }
HWY_INLINE Quad point_to_a(const RelativeQuads& r, Quad p) {
  return direction_to_a(r, p) + r.translation;
}
HWY_INLINE Quad point_to_b(const RelativeQuads& r, Quad p) {
  return direction_to_b(r, p - r.translation);
}

// conj(a) * b: the orientation of B as seen from A.
HWY_INLINE Quad relative(Quad a, Quad b) {
  const Quad signs = quad(-0.0, -0.0, -0.0, 0.0);
  return (spread(lane(a, 3)) * b + with_signs(pick<0, 1, 2, 0>(a) * pick<3, 3, 3, 0>(b), signs)) +
         (pick<2, 0, 1, 1>(a) * pick<1, 2, 0, 1>(b) +
          with_signs(pick<1, 2, 0, 2>(a) * pick<2, 0, 1, 2>(b), signs));
}

// 2 / |q|^2, of any non-zero quaternion: what makes rotations of it without a square root.
HWY_INLINE double two_over_square(Quad q) {
  const Quad s = q * q;
  return 2.0 / ((lane(s, 3) + lane(s, 0)) + (lane(s, 1) + lane(s, 2)));
}

// R(q/|q|) = N(q) / |q|^2, by its diagonal and the two triples beside it.
HWY_INLINE void set_rotation(Quad q, RelativeQuads& r) {
  const Quad s = spread(two_over_square(q)), squares = q * q;
  const Quad products = q * yzx(q), by_w = zxy(spread(lane(q, 3)) * q);
  const Quad d = spread(1.0) - s * (yzx(squares) + zxy(squares));  // 00, 11, 22
  const Quad p = s * (products + by_w);                            // 10, 21, 02
  const Quad m = s * (products - by_w);                            // 01, 12, 20
  const Quad p_next = zxy(p), m_next = zxy(m);
  r.column[0] = pick<0, 5, 2, 3>(pick<0, 1, 6, 3>(d, m), p_next);
  r.column[1] = pick<0, 1, 6, 3>(pick<4, 1, 2, 3>(d, m), p_next);
  r.column[2] = pick<4, 1, 2, 3>(pick<0, 5, 2, 3>(d, m), p_next);
  r.row[0] = pick<0, 5, 2, 3>(pick<0, 1, 6, 3>(d, p), m_next);
  r.row[1] = pick<0, 1, 6, 3>(pick<4, 1, 2, 3>(d, p), m_next);
  r.row[2] = pick<4, 1, 2, 3>(pick<0, 5, 2, 3>(d, p), m_next);
}

// R(q/|q|)^T v by two cross products.
HWY_INLINE Quad turn_back(Quad q, Quad v) {
  const Quad c = cross(q, v);
  return v + two_over_square(q) * (cross(q, c) - spread(lane(q, 3)) * c);
}

HWY_INLINE void set_exactness(const Pose& a, const Pose& b, RelativeQuads& r) {
  const ExactOrientations exact = exact_orientations(a.orientation, b.orientation);
  if (exact.equal) {
    r.column[0] = r.row[0] = quad(1.0, 0.0, 0.0, 0.0);
    r.column[1] = r.row[1] = quad(0.0, 1.0, 0.0, 0.0);
    r.column[2] = r.row[2] = quad(0.0, 0.0, 1.0, 0.0);
  }
  if (exact.rotation) r.rotation_error = 0.0;
  if (exact.translation) r.translation_error = kPermutedTranslationError * r.apart;
}

HWY_INLINE RelativeQuads relative_quads(const Pose& world_from_a, const Pose& world_from_b) {
  const Quad a = load4(world_from_a.orientation.coeffs().data());
  const Quad q = relative(a, load4(world_from_b.orientation.coeffs().data()));
  const Quad between = load3(world_from_b.position) - load3(world_from_a.position);
  RelativeQuads r;
  set_rotation(q, r);
  r.translation = turn_back(a, between);
  r.apart = norm(r.translation);
  r.rotation_error = kRotationError;
  r.translation_error = kTranslationError * r.apart;
  if (may_be_exact(world_from_a.orientation.w(), lane(q, 2))) {
    set_exactness(world_from_a, world_from_b, r);
  }
  return r;
}

HWY_INLINE RelativeQuads quads_of(const RelativePose& pose) {
  RelativeQuads r;
  for (int i = 0; i < 3; ++i) {
    r.column[i] = load3(pose.rotation.col(i).data());
    const auto row = pose.rotation.row(i);
    r.row[i] = quad(row[0], row[1], row[2], 0.0);
  }
  r.translation = load3(pose.translation);
  r.rotation_error = pose.rotation_error;
  r.translation_error = pose.translation_error;
  r.apart = norm(r.translation);
  return r;
}

HWY_INLINE RelativePose pose_of(const RelativeQuads& r) {
  RelativePose pose;
  for (int i = 0; i < 3; ++i) pose.rotation.col(i) = vec3(r.column[i]);
  pose.translation = vec3(r.translation);
  pose.rotation_error = r.rotation_error;
  pose.translation_error = r.translation_error;
  return pose;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
