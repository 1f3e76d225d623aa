// relative_pose() for as many pairs as a vector has lanes, with its roundings in its order.
// Compiled once an instruction set.
#if defined(CLEARANCE_BATCH_POSE_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_BATCH_POSE_INL_HPP_
#undef CLEARANCE_BATCH_POSE_INL_HPP_
#else
#define CLEARANCE_BATCH_POSE_INL_HPP_
#endif

#include "core/batch/lanes-inl.hpp"
#include "core/numerics/error_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance {
namespace HWY_NAMESPACE {

struct Quaternions {
  Lanes x, y, z, w;
};

// World from body, m; orientations as given, of unit length or not.
struct Poses {
  Points position;
  Quaternions orientation;
};

struct Rotations {
  Points x, y, z;  // rows
};

// The pose of B in A's frame, with bounds of its rounding error: RelativePose4 of
// core/model/relative_pose-inl.hpp for lanes.
struct RelativePoses {
  Rotations rotation;
  Points translation;
  Lanes rotation_error, translation_error;
};

// Sums in the order of Diagonals: the sum of each row begins at the diagonal.
HWY_INLINE Points direction_to_a(const RelativePoses& a_from_b, const Points& p) {
  const Rotations& r = a_from_b.rotation;
  return {dot({r.x.x, r.x.y, r.x.z}, {p.x, p.y, p.z}), dot({r.y.y, r.y.z, r.y.x}, {p.y, p.z, p.x}),
          dot({r.z.z, r.z.x, r.z.y}, {p.z, p.x, p.y})};
}
HWY_INLINE Points direction_to_b(const RelativePoses& a_from_b, const Points& p) {
  const Rotations& r = a_from_b.rotation;
  return {dot({r.x.x, r.y.x, r.z.x}, {p.x, p.y, p.z}), dot({r.y.y, r.z.y, r.x.y}, {p.y, p.z, p.x}),
          dot({r.z.z, r.x.z, r.y.z}, {p.z, p.x, p.y})};
}
HWY_INLINE Points point_to_a(const RelativePoses& a_from_b, const Points& p) {
  return direction_to_a(a_from_b, p) + a_from_b.translation;
}
HWY_INLINE Points point_to_b(const RelativePoses& a_from_b, const Points& p) {
  return direction_to_b(a_from_b, p - a_from_b.translation);
}

// A pose is eight numbers: position, one that means nothing, x, y, z, w.
static_assert(sizeof(Pose) == 8 * sizeof(double) && alignof(Pose) == sizeof(Pose));
static_assert(offsetof(Pose, position) == 0 && offsetof(Pose, orientation) == 4 * sizeof(double));

// Loads the poses of the bodies which[0], ..., which[kWidth - 1]: rows in memory, columns in
// vectors.
HWY_INLINE Poses load_poses(const Pose* poses, const std::uint32_t* which) {
  const double* rows[kWidth];
  for (std::size_t i = 0; i < kWidth; ++i) rows[i] = poses[which[i]].position.data();
  const Columns position = load_columns(rows, 0), orientation = load_columns(rows, 4);
  return {
      {position.column[0], position.column[1], position.column[2]},
      {orientation.column[0], orientation.column[1], orientation.column[2], orientation.column[3]}};
}

// conj(a) * b
HWY_INLINE Quaternions relative(const Quaternions& a, const Quaternions& b) {
  const auto plus = [](Lanes p, Lanes q, Lanes r, Lanes s)
                        HWY_ATTR { return hn::Add(hn::Mul(p, q), hn::Mul(r, s)); };
  const auto minus = [](Lanes p, Lanes q, Lanes r, Lanes s)
                         HWY_ATTR { return hn::Sub(hn::Mul(p, q), hn::Mul(r, s)); };
  return {hn::Sub(plus(a.w, b.x, a.z, b.y), plus(a.y, b.z, a.x, b.w)),
          hn::Add(minus(a.w, b.y, a.z, b.x), minus(a.x, b.z, a.y, b.w)),
          hn::Add(minus(a.y, b.x, a.x, b.y), minus(a.w, b.z, a.z, b.w)),
          hn::Add(plus(a.x, b.x, a.y, b.y), plus(a.z, b.z, a.w, b.w))};
}

HWY_INLINE Lanes square_of(const Quaternions& q) {
  return hn::Add(hn::Add(hn::Mul(q.w, q.w), hn::Mul(q.x, q.x)),
                 hn::Add(hn::Mul(q.y, q.y), hn::Mul(q.z, q.z)));
}

HWY_INLINE LaneMask nearly_unit(Lanes square) {
  return hn::Le(hn::Abs(hn::Sub(square, all(1.0))), all(kNearlyUnit));
}

// But for a little at the limit, which is left to distance().
HWY_INLINE LaneMask are_unit(const Quaternions& q) {
  return hn::Le(hn::Abs(hn::Sub(square_of(q), all(1.0))), all(1.99 * kUnitTolerance));
}

// 2 / |q|^2 if nearly_unit(q); two_over_any_square() is for any length.
HWY_INLINE Lanes two_over_square(Lanes square) {
  return hn::Mul(all(2.0), hn::Sub(all(2.0), square));
}
HWY_INLINE Lanes two_over_any_square(Lanes square) {
  return hn::IfThenElse(nearly_unit(square), two_over_square(square), hn::Div(all(2.0), square));
}

// R(q/|q|); s: 2 / |q|^2.
HWY_INLINE Rotations rotation_matrices(const Quaternions& q, Lanes s) {
  const Lanes one = all(1.0);
  const Lanes xx = hn::Mul(q.x, q.x), yy = hn::Mul(q.y, q.y), zz = hn::Mul(q.z, q.z);
  const Lanes xy = hn::Mul(q.x, q.y), xz = hn::Mul(q.x, q.z), yz = hn::Mul(q.y, q.z);
  const Lanes wx = hn::Mul(q.w, q.x), wy = hn::Mul(q.w, q.y), wz = hn::Mul(q.w, q.z);
  const auto diagonal = [&](Lanes p, Lanes r)
                            HWY_ATTR { return hn::Sub(one, hn::Mul(s, hn::Add(p, r))); };
  const auto sum = [&](Lanes p, Lanes r) HWY_ATTR { return hn::Mul(s, hn::Add(p, r)); };
  const auto difference = [&](Lanes p, Lanes r) HWY_ATTR { return hn::Mul(s, hn::Sub(p, r)); };
  return {{diagonal(yy, zz), difference(xy, wz), sum(xz, wy)},
          {sum(xy, wz), diagonal(xx, zz), difference(yz, wx)},
          {difference(xz, wy), sum(yz, wx), diagonal(xx, yy)}};
}

// R(q/|q|)^T v by two cross products; s: 2 / |q|^2.
HWY_INLINE Points turn_back(const Quaternions& q, Lanes s, const Points& v) {
  const Points u{q.x, q.y, q.z};
  const Points c = cross(u, v);
  return v + s * (cross(u, c) - q.w * c);
}

HWY_INLINE LaneMask equal_up_to_sign(const Quaternions& a, const Quaternions& b) {
  const auto same = [&](const Quaternions& c) HWY_ATTR {
    return hn::And(hn::And(hn::Eq(a.x, c.x), hn::Eq(a.y, c.y)),
                   hn::And(hn::Eq(a.z, c.z), hn::Eq(a.w, c.w)));
  };
  return hn::Or(same(b), same({hn::Neg(b.x), hn::Neg(b.y), hn::Neg(b.z), hn::Neg(b.w)}));
}

HWY_INLINE LaneMask multiple_of_half(Lanes v) {
  const Lanes twice = hn::Add(v, v);
  return hn::Eq(twice, hn::Round(twice));
}
// The same test of unit quaternions as permutes_axes() of core/model/relative_pose-inl.hpp.
HWY_INLINE LaneMask permute_axes(const Quaternions& q) {
  return hn::And(hn::And(multiple_of_half(q.x), multiple_of_half(q.y)),
                 hn::And(multiple_of_half(q.z), multiple_of_half(q.w)));
}

// set_exactness() of core/model/relative_pose-inl.hpp.
HWY_INLINE void set_exactness(const Quaternions& a, const Quaternions& b, Lanes translation_length,
                              RelativePoses& pose) {
  const LaneMask a_permutes = permute_axes(a);
  const LaneMask exact = hn::Or(equal_up_to_sign(a, b), hn::And(a_permutes, permute_axes(b)));
  pose.rotation_error = hn::IfThenElse(exact, all(0.0), pose.rotation_error);
  pose.translation_error =
      hn::IfThenElse(a_permutes, hn::Mul(all(kPermutedTranslationError), translation_length),
                     pose.translation_error);
}

// Leaves no number of a pose that is not good, so that its lane fails.
HWY_INLINE void spoil(LaneMask good, RelativePoses& pose) {
  const Lanes none = hn::NaN(Tag());
  for (Points* row : {&pose.rotation.x, &pose.rotation.y, &pose.rotation.z, &pose.translation}) {
    *row = {hn::IfThenElse(good, row->x, none), hn::IfThenElse(good, row->y, none),
            hn::IfThenElse(good, row->z, none)};
  }
}

HWY_INLINE RelativePoses relative_poses(const Poses& world_from_a, const Poses& world_from_b) {
  const Quaternions& a = world_from_a.orientation;
  const Quaternions& b = world_from_b.orientation;
  const Quaternions q = relative(a, b);
  const Points between = world_from_b.position - world_from_a.position;
  const Lanes square_a = square_of(a), square_q = square_of(q);
  Lanes over_a = two_over_square(square_a), over_q = two_over_square(square_q);
  // |q| = |a||b|: where a and q are nearly of unit length, so is b.
  const LaneMask unit = hn::And(nearly_unit(square_a), nearly_unit(square_q));
  if (HWY_UNLIKELY(!hn::AllTrue(Tag(), unit))) {
    over_a = two_over_any_square(square_a);
    over_q = two_over_any_square(square_q);
  }
  RelativePoses out{rotation_matrices(q, over_q), turn_back(a, over_a, between),
                    all(kRotationError), all(0.0)};
  const Lanes translation_length = norm(out.translation);
  const LaneMask near = hn::Le(translation_length, all(0.5 * kLargestCoordinate));
  if (HWY_UNLIKELY(!hn::AllTrue(Tag(), hn::And(unit, near)))) {
    spoil(hn::And(near, hn::And(are_unit(a), are_unit(b))), out);
  }
  out.translation_error = hn::Mul(all(kTranslationError), translation_length);
  // The same test as may_be_exact() there: moving orientations nearly never pass it.
  const LaneMask may_be_exact = hn::Or(multiple_of_half(a.w), multiple_of_half(q.z));
  if (HWY_UNLIKELY(!hn::AllFalse(Tag(), may_be_exact)))
    set_exactness(a, b, translation_length, out);
  return out;
}

}  // namespace HWY_NAMESPACE
}  // namespace clearance
HWY_AFTER_NAMESPACE();

#endif
