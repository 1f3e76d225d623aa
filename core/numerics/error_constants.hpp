// The counts of roundings from which the bounds are made, for the scalar and the vector code of a
// query.
#pragma once

namespace clearance {

// Half an ulp of 1: the largest relative error of one rounding.
inline constexpr double kUlp = 0x1p-53;

// Times this, a result of up to six roundings is no longer below the exact one.
inline constexpr double kRoundedUp = 1.0 + 0x1p-50;

// For |q|^2 = 1 + e as near to 1 as this, 2/|q|^2 is 2 (2 - |q|^2) but for e^2 < 2^-55.
inline constexpr double kNearlyUnit = 0x1p-28;

// The counts below are to first order. The second order is 2^-50 of it, and every count is rounded
// up by more. The test tests/core/model/rounding_count_test.cpp searches for the poses where all
// roundings at once are worst.

// Error of a rotation matrix R(q) in the 2-norm, for an exact unit quaternion (x, w).
// - The common factor 2/|q|^2, but for the squares in it: pair sums 1 ulp, their sum 1, the
//   quotient 1. That scales R - I, which is 2|x| long: 6|x|. The factor of a nearly unit quaternion
//   has no quotient and no larger error. If the sum is 1 or more, it is off by 1 ulp, and 2 - |q|^2
//   is exact. If it is below 1, it is off by 1/2 and the difference by 1. The square e^2, below
//   2^-55, adds 1/4.
// - The squares, there and on the diagonal 1 - 2p, p = x_j^2 + x_k^2: 4 p (1 - p); beside it
//   |R_ij|.
// - The other products beside the diagonal: 2 (|x_i x_j| + |w x_k|).
// - The sum in an entry and the product with the factor: 4 p and 2|R_ij|. 1 - 2p: 1/2.
// The last three make a matrix of bounds; its 2-norm and 6|x| are together at most 15.52.
inline constexpr double kMatrixError = 15.6 * kUlp;

// Error of a Hamilton product a b of unit length. The components of b multiply four vectors of unit
// length, at right angles to each other. The products are off by |b_i| ulps each, together at most
// 2. The two pair sums are off by sqrt(b_x^2 + b_y^2) and sqrt(b_z^2 + b_w^2), together sqrt 2, and
// their sum by 1. The rotation turns by twice the angle: 8.83.
inline constexpr double kProductError = 9 * kUlp;

// R(q/|q|)^T v by two cross products, q = (x, w) of unit length and exact inputs. A cross product
// of u and v is off by 2/sqrt 3 ulps of |u||v| in its products and 1 of itself. So c = x cross v is
// off by 2.16 |x|, which x cross c - w c rotates without making it longer. The difference x cross c
// - w c has errors of 2.16 |x|, |w| and 1 of its own, times |c| <= |x|. The sum is below 5.37, and
// counts twice. The factor 2/|q|^2 is off by 3.75, of 2|x|: 7.5. The product with it: 2, the sum:
// 1.
inline constexpr double kTurnError = 21.25 * kUlp;

// The errors of RelativePose: the rotation's in the 2-norm, and the translation's per metre between
// the origins, where v is a rounded difference. The last one is for a rotation that only permutes
// axes.
inline constexpr double kRotationError = kMatrixError + kProductError;
inline constexpr double kTranslationError = kTurnError + kUlp;
inline constexpr double kPermutedTranslationError = 4 * kUlp;

// The part of the rotation's error that may be a stretch and no rotation: an error of the
// quaternion only rotates.
inline constexpr double kStretched = kMatrixError / kRotationError;

// The errors of n.(R b + t - a) / |n| and |R b + t - a| in ulps of |a|, |b| and |t|. The points a
// and b are on their features, in frame A, and B is as the doubles of R make it. Every direction is
// brought to unit length. The counts:
// - rotating a vector: 4 (the products 3^(1/2), two of them summed 2^(1/2), together 3; the sum of
//   all three 1);
// - placing it, and the difference of a and b: 1 each of the vector that is placed, which is no
//   longer than all three together;
// - a cross product with an edge: 2.16; a norm: 2.5; a product with a normal: 3; a quotient by a
//   norm: 2.5 + 1;
// - an edge is orthogonal to n except for 3.2, over twice a body's size.
// For an edge and a vertex the sums are 12, 11 and 7, for a facet and a vertex 9, 9 and 9. For two
// edges they are 10, 22 and 9, most of it from the direction of B's edge. Not all of these can
// occur together with the rotation's own error. In the worst pose 15 % of the whole is left (the
// test's kind "edge, edge").
inline constexpr double kUlpsOnA = 12, kUlpsOnB = 18, kUlpsBetween = 10;

// Squares of lengths below 1e-154 underflow, and a norm may be wrong by as much (m).
inline constexpr double kUnderflow = 1e-150;

// If bounds differ by no more than this, before the error bound, no other method is tried. The
// index is the number of unbounded bodies: errors of direction grow along their rays.
inline constexpr double kGapToleranceUlps[] = {6.5, 16.0, 16.0};

// The promise of a converged answer: upper - lower is at most 1e-14 of Precision::size. For bodies
// that overlap or touch, and for two unbounded ones, it is 1.25e-14.
inline constexpr double kConvergedGap = 90 * kUlp, kContactGap = 112 * kUlp;

// Relative error of a sum of radii, and of a bound from which it has been subtracted.
inline constexpr double kRadiusRounding = 0x1.1p-53;

// Below this angle between a vector and an edge, rounding (2.5 ulps of the vector) may tilt their
// cross product towards the edge. A second cross product then comes out too short.
inline constexpr double kSlender = 0x1p-20;

// A directional derivative larger than this in magnitude, per unit length, has the sign that exact
// arithmetic would give with the doubles of R. The body's unit vector takes 1 of these 8 ulps, the
// rotated direction 4, and their product 2. The last sum of the product is exact for so small a
// derivative, or its rounding is as small as the derivative.
inline constexpr double kDerivativeError = 0x1p-50;

// The error of a slope: the rounding of its direction, its product and its sum.
inline constexpr double kSlopeError = 0x1p-50;

// Facets that are parallel along two edges may be tilted by a little more than either.
inline constexpr double kParallelTilt = 2.0 * kDerivativeError;

// The error of the tilt of an edge or facet against a direction: 4 of the rotated direction, and 1
// of each direction's own rounding. Their product adds 2 over the smaller body's size. The counts
// above cover these, as a point on a parallel feature takes 12 and 9.
inline constexpr double kTiltError = 6 * kUlp;

// Edges nearer to parallel than this (the sine's square) have no direction across both that is
// worth trusting.
inline constexpr double kCrossingSine2 = 1e-6;

// Features nearer to each other than this, as a part of the pair's size, may touch. It is some ten
// error bounds.
inline constexpr double kMayTouch = 0x1p-44;

}  // namespace clearance
