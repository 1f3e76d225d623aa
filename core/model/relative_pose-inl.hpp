// RelativePose as the queries use it, compiled once per vector width: see
// core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_RELATIVE_POSE4) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_RELATIVE_POSE4
#undef CLEARANCE_CORE_RELATIVE_POSE4
#else
#define CLEARANCE_CORE_RELATIVE_POSE4
#endif

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/model/bad_pose.hpp"
#include "core/model/error_bounds.hpp"
#include "core/model/query.hpp"
#include "core/model/special_members.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/numerics/vec4-inl.hpp"
#include "core/pose.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// A 3 x 3 matrix by its cyclic diagonals: the elements (i, i), (i, i + 1) and (i, i + 2), modulo 3.
// Its product with a vector takes that vector rotated by no, one and two lanes. So no element is
// spread over a register, and no rows or columns have to be assembled.
struct Diagonals {
  Vec4 main, next, last;
};
HWY_INLINE Vec4 operator*(const Diagonals& m, Vec4 v) {
  return (m.main * v + m.next * yzx(v)) + m.last * zxy(v);
}

// The pose of B in A's frame, and the inverse rotation.
struct RelativePose4 {
  Diagonals rotation, transposed;
  Vec4 translation;
  double rotation_error, translation_error;  // as in RelativePose
  double translation_length;                 // m
};

// A copy for a function that gets its address, made number by number: so the original may stay in
// registers.
HWY_INLINE RelativePose4 in_memory(const RelativePose4& r) {
  return {{r.rotation.main, r.rotation.next, r.rotation.last},
          {r.transposed.main, r.transposed.next, r.transposed.last},
          r.translation,
          r.rotation_error,
          r.translation_error,
          r.translation_length};
}

using Query4 = QueryAt<RelativePose4>;

HWY_INLINE Vec4 direction_to_a(const RelativePose4& r, Vec4 v) { return r.rotation * v; }
HWY_INLINE Vec4 direction_to_b(const RelativePose4& r, Vec4 v) { return r.transposed * v; }
HWY_INLINE Vec4 point_to_a(const RelativePose4& r, Vec4 p) {
  return direction_to_a(r, p) + r.translation;
}
HWY_INLINE Vec4 point_to_b(const RelativePose4& r, Vec4 p) {
  return direction_to_b(r, p - r.translation);
}

// conj(a) * b: the orientation of B in A's frame. b is spread while it is loaded, because queries
// wait for permutations of registers.
HWY_INLINE Vec4 relative(Vec4 a, const double* b) {
  const Vec4 by_x = with_signs(pick<3, 2, 1, 0>(a), vec4(0.0, -0.0, 0.0, 0.0));
  const Vec4 by_y = with_signs(pick<2, 3, 0, 1>(a), vec4(0.0, 0.0, -0.0, 0.0));
  const Vec4 by_z = with_signs(pick<1, 0, 3, 2>(a), vec4(-0.0, 0.0, 0.0, 0.0));
  const Vec4 by_w = with_signs(a, vec4(-0.0, -0.0, -0.0, 0.0));
  return (spread(b[0]) * by_x + spread(b[1]) * by_y) + (spread(b[2]) * by_z + spread(b[3]) * by_w);
}

// |a|^2 and |b|^2.
HWY_INLINE Vec2 squares_of(Vec4 a, Vec4 b) { return sums4(a * a, b * b); }

// 2 / |q|^2, the factor that makes a rotation of q without a square root. If q is of unit length to
// a dozen digits, it takes no division: kMatrixError says why.
HWY_INLINE Vec2 two_over_unit(Vec2 square) { return vec2(2.0) * (vec2(2.0) - square); }
HWY_INLINE bool nearly_unit(double square) { return std::abs(square - 1.0) <= kNearlyUnit; }
HWY_INLINE Vec2 two_over(Vec2 square) {
  const Vec2 unit = two_over_unit(square), any = vec2(2.0) / square;
  return Vec2{nearly_unit(square[0]) ? unit[0] : any[0], nearly_unit(square[1]) ? unit[1] : any[1]};
}
HWY_INLINE bool both_nearly_unit(Vec2 square) {
  return HWY_LIKELY(both_at_most(magnitudes(square - vec2(1.0)), vec2(kNearlyUnit)));
}

// R(q/|q|) = N(q) / |q|^2, by its diagonal and the two triples beside it; s: 2 / |q|^2.
HWY_INLINE void set_rotation(Vec4 q, double two_over_square, RelativePose4& r) {
  const Vec4 s = spread(two_over_square), y = yzx(q), z = zxy(q);
  const Vec4 products = q * y, by_w = spread(lane(q, 3)) * z;
  const Vec4 d = spread(1.0) - s * (y * y + z * z);  // 00, 11, 22
  const Vec4 p = s * (products + by_w);              // 10, 21, 02
  const Vec4 m = s * (products - by_w);              // 01, 12, 20
  r.rotation = {d, m, zxy(p)};
  r.transposed = {d, p, zxy(m)};
}

// R(q/|q|)^T v by two cross products; s: 2 / |q|^2.
HWY_INLINE Vec4 rotate_back(Vec4 q, double two_over_square, Vec4 v) {
  const Vec4 c = cross_zxy(q, v), by_w = spread(lane(q, 3)) * yzx(c);
  return v + two_over_square * (cross_with_zxy(q, c) - by_w);
}

// `between`: from A's origin to B's, in the world.
HWY_INLINE void set_translation(Vec4 a, double two_over_square, Vec4 between, RelativePose4& r) {
  r.translation = rotate_back(a, two_over_square, between);
  r.translation_length = norm(r.translation);
  r.translation_error = kTranslationError * r.translation_length;
}

// A unit quaternion whose components are multiples of 1/2 permutes the axes, and products of two
// such are exact. The sum with 1.5 * 2^52 rounds to an integer.
HWY_INLINE bool permutes_axes(Vec4 q) {
  const Vec4 twice = q + q, large = spread(0x1.8p52);
  return equal((twice + large) - large, twice);
}
HWY_INLINE void set_exactness(Vec4 a, Vec4 b, RelativePose4& r) {
  const bool a_permutes = permutes_axes(a);
  if (equal(a, b) || equal(a, -b) || (a_permutes && permutes_axes(b))) r.rotation_error = 0.0;
  if (a_permutes) r.translation_error = kPermutedTranslationError * r.translation_length;
}
// A quick test that moving orientations do not pass. If anything is exact, w of a or z of conj(a) b
// is 0, 1/2 or 1 in magnitude, whose mantissas are zero.
HWY_INLINE bool has_digits(double x) { return std::bit_cast<std::uint64_t>(x) << 12 != 0; }
HWY_INLINE bool may_be_exact(double w_of_a, double z_of_both) {
  return !has_digits(w_of_a) || !has_digits(z_of_both);
}

// The test for quaternions that are not of unit length within rounding, and for frames that are far
// away from each other.
inline HWY_NOINLINE bool is_good(const Pose& world_from_a, const Pose& world_from_b,
                                 double translation_length) {
  return is_unit(world_from_a.orientation) && is_unit(world_from_b.orientation) &&
         translation_length <= kLargestCoordinate;
}

HWY_INLINE RelativePose4 relative_pose4(const Pose& world_from_a, const Pose& world_from_b) {
  const Vec4 a = load4(world_from_a.orientation.coeffs().data());
  const Vec4 q = relative(a, world_from_b.orientation.coeffs().data());
  const Vec4 between = load3_masked(world_from_b.position) - load3_masked(world_from_a.position);
  const Vec2 squares = squares_of(a, q);
  const bool unit = both_nearly_unit(squares);
  const Vec2 factors = HWY_LIKELY(unit) ? two_over_unit(squares) : two_over(squares);
  RelativePose4 r;
  set_rotation(q, factors[1], r);
  set_translation(a, factors[0], between, r);
  r.rotation_error = kRotationError;
  const double longest = HWY_LIKELY(unit) ? kLargestCoordinate : -1.0;
  if (HWY_UNLIKELY(!(r.translation_length <= longest)) &&
      !is_good(world_from_a, world_from_b, r.translation_length)) {
    r.translation_length = std::numeric_limits<double>::quiet_NaN();
    r.translation = spread(r.translation_length);
  }
  if (HWY_UNLIKELY(may_be_exact(world_from_a.orientation.w(), lane(q, 2)))) {
    set_exactness(a, load4(world_from_b.orientation.coeffs().data()), r);
  }
  return r;
}

// The translation and its error alone, for a point of B at the origin of its frame: a rotation does
// not move it. False: the poses are not certainly good, or a product with the rotation could change
// the sign of a zero.
HWY_INLINE bool set_place(const Pose& world_from_a, const Pose& world_from_b, RelativePose4& r) {
  const Vec4 a = load4(world_from_a.orientation.coeffs().data()), zero = spread(0.0);
  const Vec4 between = load3_masked(world_from_b.position) - load3_masked(world_from_a.position);
  const Vec2 squares = squares_of(a, load4(world_from_b.orientation.coeffs().data()));
  set_translation(a, two_over_unit(squares)[0], between, r);
  r.rotation = r.transposed = {zero, zero, zero};
  r.rotation_error = 0.0;
  if (HWY_UNLIKELY(!has_digits(world_from_a.orientation.w())) && permutes_axes(a)) {
    r.translation_error = kPermutedTranslationError * r.translation_length;
  }
  return both_nearly_unit(squares) && r.translation_length <= kLargestCoordinate &&
         (less(zero, r.translation * r.translation) & 7u) == 7u;
}

// The nine numbers of the matrix are followed by the translation in the same object.
static_assert(offsetof(RelativePose, translation) == sizeof(Mat3));

HWY_INLINE RelativePose4 pose4_of(const RelativePose& pose) {
  const double* const m = pose.rotation.data();  // 00 10 20 01, 11 21 02 12, 22 and the translation
  const Vec4 first = load4(m), second = load4(m + 4), third = load4(m + 8);
  const Vec4 d = pick<0, 1, 4, 5>(pick<0, 4, 1, 5>(first, second), third);  // 00, 11, 22
  const Vec4 p = pick<1, 5, 6, 7>(first, second);                           // 10, 21, 02
  const Vec4 n = pick<3, 7, 2, 1>(first, second);                           // 01, 12, 20
  RelativePose4 r;
  r.rotation = {d, n, zxy(p)};
  r.transposed = {d, p, zxy(n)};
  r.translation = load3_padded(pose.translation);
  r.rotation_error = pose.rotation_error;
  r.translation_error = pose.translation_error;
  r.translation_length = norm(r.translation);
  return r;
}

// The same for a pose that a caller has made. If it is not good, the translation is NaN, as that of
// relative_pose4(). The rows of a rotation have squares of 1, so the exact test is seldom made.
HWY_INLINE RelativePose4 good_pose4_of(const RelativePose& pose) {
  RelativePose4 r = pose4_of(pose);
  const auto& [main, next, last] = r.rotation;
  const Vec4 squares = (main * main + next * next) + last * last;
  const bool quick = (less(squares, spread(2.0)) & 7u) == 7u;
  if (HWY_UNLIKELY(!quick || !(r.translation_length <= kLargestCoordinate)) && !is_good(pose)) {
    r.translation_length = std::numeric_limits<double>::quiet_NaN();
    r.translation = spread(r.translation_length);
  }
  return r;
}

HWY_INLINE PlacePrecision place_of(const RelativePose4& r) {
  return {r.rotation_error, r.translation_error, r.translation_length};
}

HWY_INLINE RelativePose pose_of(const RelativePose4& r) {
  RelativePose pose{};
  for (int i = 0; i < 3; ++i) {
    pose.rotation(i, i) = lane(r.rotation.main, i);
    pose.rotation(i, (i + 1) % 3) = lane(r.rotation.next, i);
    pose.rotation(i, (i + 2) % 3) = lane(r.rotation.last, i);
  }
  pose.translation = vec3(r.translation);
  pose.rotation_error = r.rotation_error;
  pose.translation_error = r.translation_error;
  return pose;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
