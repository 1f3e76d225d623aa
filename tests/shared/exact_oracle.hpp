// The exact minimum distance between two convex bodies: the truth that the core is held against.
//
// Every double of the input is taken as an exact number, and a quaternion q as the exact rotation
// of q/|q|, which is rational: N(q)/|q|^2. The nearest point to the origin of the set {b - a} is
// found by Wolfe's method (P. Wolfe, "Finding the nearest point in a polytope", 1976), extended by
// rays for unbounded bodies, in rationals: each step makes the distance strictly smaller, so it
// ends. An answer is accepted only after its optimality has been proved on the bodies as given.
#pragma once

#include "core/pose.hpp"
#include "tests/shared/exact_body.hpp"

namespace clearance::oracle {

struct ExactDistance {
  Rational squared;  // of the distance between the bodies without their radii
  // Where they overlap, of their depth (see exact_depth.hpp), if it has been set; else 0 is
  // assumed.
  Rational squared_depth;
  Rational radii;                      // the sum of both
  RationalVec point_on_a, point_on_b;  // a closest pair of the bodies without radii, in the world
  // The distance is sqrt(squared) - sqrt(squared_depth) - radii; these are the doubles next to it:
  // lower <= distance <= upper.
  double lower = 0.0, upper = 0.0;
  int steps = 0;

  [[nodiscard]] bool cores_meet() const { return squared == 0; }
  // Sign of (distance - value), decided exactly.
  [[nodiscard]] int compare(const Rational& value) const;
  [[nodiscard]] int compare(double value) const;  // infinities allowed
  // The same pair with balls added to both.
  void add_radii(double of_a, double of_b);
  void set_squared_depth(const Rational& value);
};

// Without radii. Throws std::logic_error when the proof of optimality fails: the oracle is wrong,
// not the caller.
[[nodiscard]] ExactDistance exact_distance(ExactBody& a, const Pose& world_from_a, ExactBody& b,
                                           const Pose& world_from_b);

// With radii.
[[nodiscard]] ExactDistance exact_distance(const Body& a, const Pose& world_from_a, const Body& b,
                                           const Pose& world_from_b);

}  // namespace clearance::oracle
