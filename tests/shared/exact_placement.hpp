// Vectors and poses in exact rational arithmetic.
#pragma once

#include "core/pose.hpp"
#include "tests/shared/exact_body.hpp"

namespace clearance::oracle {

using RationalMat = std::array<RationalVec, 3>;

[[nodiscard]] RationalVec operator+(const RationalVec& a, const RationalVec& b);
[[nodiscard]] RationalVec operator-(const RationalVec& a, const RationalVec& b);
[[nodiscard]] RationalVec operator*(const Rational& s, const RationalVec& a);
[[nodiscard]] RationalVec operator*(const RationalMat& m, const RationalVec& v);
[[nodiscard]] RationalVec cross(const RationalVec& a, const RationalVec& b);
[[nodiscard]] RationalMat transposed(const RationalMat& m);
[[nodiscard]] bool is_zero(const RationalVec& v);
[[nodiscard]] Vec3 to_vec(const RationalVec& v);  // rounded

// B placed in frame A, exactly.
struct Placement {
  RationalMat world_a, a_from_b_rotation;
  RationalVec a_from_b_translation;

  // Throws std::invalid_argument for a quaternion of length zero.
  Placement(const Pose& a, const Pose& b);

  [[nodiscard]] RationalVec b_direction(const RationalVec& in_a) const;
};

}  // namespace clearance::oracle
