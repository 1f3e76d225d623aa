// relative_pose() of core/pose.cpp, operation for operation, for as many pairs as a vector has
// lanes. Compiled once an instruction set.
#if defined(CLEARANCE_BATCH_POSE_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_BATCH_POSE_INL_HPP_
#undef CLEARANCE_BATCH_POSE_INL_HPP_
#else
#define CLEARANCE_BATCH_POSE_INL_HPP_
#endif

#include "core/batch_vectors-inl.hpp"
#include "core/rounding.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance {
namespace HWY_NAMESPACE {

struct Quaternions {
  Lanes x, y, z, w;
};

struct PlacedBodies {
  Quaternions orientation;
  Points position;
  Lanes translation_error;
};

struct Rotations {
  Points row[3];
};

struct RelativePoses {
  Rotations rotation;
  Points translation;
  Lanes rotation_error, translation_error;
};

// As Eigen multiplies a fixed 3 x 3 matrix: two rows as a packet, the third as a sum of its own.
HWY_INLINE Points rotate(const Rotations& r, const Points& p) {
  const Points& last = r.row[2];
  const Lanes z =
      hn::Add(hn::Mul(last.x, p.x), hn::Add(hn::Mul(last.y, p.y), hn::Mul(last.z, p.z)));
  return {dot(r.row[0], p), dot(r.row[1], p), z};
}

HWY_INLINE Points rotate_back(const Rotations& r, const Points& p) {
  const auto column = [&](Lanes x, Lanes y, Lanes z) HWY_ATTR { return dot({x, y, z}, p); };
  return {column(r.row[0].x, r.row[1].x, r.row[2].x), column(r.row[0].y, r.row[1].y, r.row[2].y),
          column(r.row[0].z, r.row[1].z, r.row[2].z)};
}

HWY_INLINE PlacedBodies load_bodies(const PlacedBody* bodies, const std::uint32_t* which) {
  const double* rows[kWidth];
  for (std::size_t i = 0; i < kWidth; ++i) rows[i] = &bodies[which[i]].x;
  PlacedBodies out;
  load_columns(rows, 0, out.orientation.x, out.orientation.y);
  load_columns(rows, 2, out.orientation.z, out.orientation.w);
  load_columns(rows, 4, out.position.x, out.position.y);
  load_columns(rows, 6, out.position.z, out.translation_error);
  return out;
}

// conj(a) * b
HWY_INLINE Quaternions relative(const Quaternions& a, const Quaternions& b) {
  const auto plus = [](Lanes p, Lanes q, Lanes r, Lanes s)
                        HWY_ATTR { return hn::Add(hn::Mul(p, q), hn::Mul(r, s)); };
  const auto minus = [](Lanes p, Lanes q, Lanes r, Lanes s)
                         HWY_ATTR { return hn::Sub(hn::Mul(p, q), hn::Mul(r, s)); };
  return {hn::Add(minus(a.w, b.x, a.x, b.w), minus(a.z, b.y, a.y, b.z)),
          hn::Add(minus(a.w, b.y, a.y, b.w), minus(a.x, b.z, a.z, b.x)),
          hn::Add(minus(a.w, b.z, a.z, b.w), minus(a.y, b.x, a.x, b.y)),
          hn::Add(plus(a.w, b.w, a.x, b.x), plus(a.y, b.y, a.z, b.z))};
}

// 2 / |q|^2
HWY_INLINE Lanes twice_over_square(const Quaternions& q) {
  return hn::Div(all(2.0), hn::Add(hn::Add(hn::Mul(q.w, q.w), hn::Mul(q.x, q.x)),
                                   hn::Add(hn::Mul(q.y, q.y), hn::Mul(q.z, q.z))));
}

HWY_INLINE Rotations rotation_matrices(const Quaternions& q) {
  const Lanes s = twice_over_square(q), one = all(1.0);
  const Lanes xx = hn::Mul(q.x, q.x), yy = hn::Mul(q.y, q.y), zz = hn::Mul(q.z, q.z);
  const Lanes xy = hn::Mul(q.x, q.y), xz = hn::Mul(q.x, q.z), yz = hn::Mul(q.y, q.z);
  const Lanes wx = hn::Mul(q.w, q.x), wy = hn::Mul(q.w, q.y), wz = hn::Mul(q.w, q.z);
  const auto diagonal = [&](Lanes p, Lanes r)
                            HWY_ATTR { return hn::Sub(one, hn::Mul(s, hn::Add(p, r))); };
  const auto sum = [&](Lanes p, Lanes r) HWY_ATTR { return hn::Mul(s, hn::Add(p, r)); };
  const auto difference = [&](Lanes p, Lanes r) HWY_ATTR { return hn::Mul(s, hn::Sub(p, r)); };
  return {{{diagonal(yy, zz), difference(xy, wz), sum(xz, wy)},
           {sum(xy, wz), diagonal(xx, zz), difference(yz, wx)},
           {difference(xz, wy), sum(yz, wx), diagonal(xx, yy)}}};
}

HWY_INLINE Points turn_back(const Quaternions& q, const Points& v) {
  const Points u{q.x, q.y, q.z};
  const Points c = cross(u, v);
  return v + times(twice_over_square(q), cross(u, c) - times(q.w, c));
}

HWY_INLINE LaneMask equal_up_to_sign(const Quaternions& a, const Quaternions& b) {
  const auto same = [&](const Quaternions& c) HWY_ATTR {
    return hn::And(hn::And(hn::Eq(a.x, c.x), hn::Eq(a.y, c.y)),
                   hn::And(hn::Eq(a.z, c.z), hn::Eq(a.w, c.w)));
  };
  return hn::Or(same(b), same({hn::Neg(b.x), hn::Neg(b.y), hn::Neg(b.z), hn::Neg(b.w)}));
}

// Equal orientations give the identity, to the sign of its zeros.
HWY_INLINE void settle_equal(LaneMask equal, RelativePoses& pose) {
  const Lanes zero = all(0.0), one = all(1.0);
  for (int i = 0; i < 3; ++i) {
    Points& row = pose.rotation.row[i];
    row = {hn::IfThenElse(equal, i == 0 ? one : zero, row.x),
           hn::IfThenElse(equal, i == 1 ? one : zero, row.y),
           hn::IfThenElse(equal, i == 2 ? one : zero, row.z)};
  }
  pose.rotation_error = hn::IfThenElse(equal, zero, pose.rotation_error);
}

HWY_INLINE RelativePoses relative_poses(const PlacedBodies& a, const PlacedBodies& b) {
  const Quaternions q = relative(a.orientation, b.orientation);
  const Points between = b.position - a.position;
  const Lanes zero = all(0.0), exact = all(kPermutedTranslationError);
  const LaneMask permutes =
      hn::And(hn::Eq(a.translation_error, exact), hn::Eq(b.translation_error, exact));
  RelativePoses out{rotation_matrices(q), turn_back(a.orientation, between),
                    hn::IfThenElse(permutes, zero, all(kRotationError)),
                    hn::Mul(a.translation_error, norm(between))};
  const LaneMask no_turn =
      hn::And(hn::And(hn::Eq(q.x, zero), hn::Eq(q.y, zero)), hn::Eq(q.z, zero));
  if (HWY_UNLIKELY(!hn::AllFalse(Tag(), no_turn))) {
    settle_equal(equal_up_to_sign(a.orientation, b.orientation), out);
  }
  return out;
}

}  // namespace HWY_NAMESPACE
}  // namespace clearance
HWY_AFTER_NAMESPACE();

#endif
