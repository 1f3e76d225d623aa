// The counts of roundings that the bounds are made of, for the scalar and the vector code of a
// query.
#pragma once

namespace clearance {

// Half an ulp of 1: the largest relative error of one rounding.
inline constexpr double kUlp = 0x1p-53;

// Times this, a result of up to six roundings is no longer below the exact one.
inline constexpr double kRoundedUp = 1.0 + 0x1p-50;

// For |q|^2 = 1 + e as near to 1 as this, 2/|q|^2 is 2 (2 - |q|^2) but for e^2 < 2^-55.
inline constexpr double kNearlyUnit = 0x1p-28;

// Of the square of a quaternion, or of a product of two: beyond these, powers of it or its
// reciprocal over- or underflow, and the quaternions are brought to about unit length first.
inline constexpr double kLeastSquare = 1e-240, kMostSquare = 1e240;
[[nodiscard]] constexpr bool is_in_range(double square) noexcept {
  return square >= kLeastSquare && square <= kMostSquare;
}

// Error of a rotation matrix in the 2-norm, for an exact quaternion. The common factor
// s = 2/|q|^2 is off by 4 roundings, which scales R - I (norm at most 2): 8. (Near 1, |q|^2 is off
// by one ulp for its products, one for their two sums and one for the sum of those, and 2 - |q|^2
// is exact; or below 1, half an ulp for the last sum and one for 2 - |q|^2; 2^-55 is a quarter.)
// What multiplies it is off by 3 in each entry, and the nine |entries| have a Frobenius norm of at
// most 3: 9. The subtraction from 1 on the diagonal: 2.
inline constexpr double kMatrixError = 20 * kUlp;

// Error of a Hamilton product: a component is four products in three roundings each, at most two
// ulps of the sum of their magnitudes (at most 1) and one of itself, so the vector is off by at
// most 5 ulps, and the rotation, which turns by twice the angle, by 10.
inline constexpr double kProductError = 10 * kUlp;

// R(q/|q|)^T v by two cross products. With |q| = 1 and exact inputs: each cross product is off by
// at most 2.5 ulps of |q||v|, their weighted sum by 6.5, twice that by 13; the factor 2/|q|^2 by 4,
// which moves the result by 8; the last two operations by 3.
inline constexpr double kTurnError = 24 * kUlp;

// Of RelativePose: in the 2-norm, and per metre between the origins, v being a difference itself;
// the last where the turn only permutes axes.
inline constexpr double kRotationError = kMatrixError + kProductError;
inline constexpr double kTranslationError = kTurnError + kUlp;
inline constexpr double kPermutedTranslationError = 4 * kUlp;

// Evaluating n.(R b + t - a) / |n| or |R b + t - a|, with a and b on the features that hold them:
// placing a point on its feature (3), rotating it (6), an edge that is not quite at right angles to
// n (6); the sums, the product and the quotient (8).
inline constexpr double kUlpsOnA = 12, kUlpsOnB = 18, kUlpsBetween = 10;

// Squares of lengths below 1e-154 underflow, and a norm may be wrong by as much (m).
inline constexpr double kUnderflow = 1e-150;

// What rounding leaves between the bounds, by how many of the bodies are unbounded: errors of
// direction grow along their rays. Measured on the hard cases of tests/: at most 5, 40 and 250.
inline constexpr double kTightUlps[] = {8.0, 16.0, 16.0};

// What a converged answer promises: upper - lower is at most 1e-14 of Precision::size.
inline constexpr double kConverged = 90 * kUlp;

// Of a sum of radii, and of what is left when it is taken off a bound.
inline constexpr double kRadiusRounding = 0x1.1p-53;

// Of a vector at an angle below this to an edge, rounding may turn its cross product with the edge
// (2.5 ulps of the vector) so far towards the edge that a second one comes out shorter.
inline constexpr double kSlender = 0x1p-20;

// Unit vectors are off by 2^-52 and their products by three roundings more: a rate of approach
// beyond this, per unit length, has the sign that exact arithmetic would give.
inline constexpr double kCertainRate = 0x1p-50;

// Facets that are level along two edges may be tilted by a little more than either.
inline constexpr double kLevelTilt = 2.0 * kCertainRate;

// How far off the tilt of an edge or facet against a direction may be, beyond what the counts above
// leave for it: rotating the direction (6), both directions' own rounding (2 each), the product (3)
// over both bodies' sizes is 26 ulps of the smaller reach, and a point on a level feature takes 16
// of the 30 that there are for both.
inline constexpr double kTiltError = 6 * kUlp;

// Edges nearer to parallel than this (the sine's square) have no direction across both that is
// worth trusting.
inline constexpr double kCrossingSine2 = 1e-6;

}  // namespace clearance
