// The exact minimum distance between two convex bodies: the truth that the core is compared with.
//
// Every double of the input is taken as an exact number. A quaternion q stands for the exact
// rotation of q/|q|, which is rational: N(q)/|q|^2. Wolfe's method (P. Wolfe, "Finding the nearest
// point in a polytope", 1976) finds the point of {b - a} that is nearest to the origin. It is
// extended by rays for unbounded bodies. It works in rationals, so each step makes the distance
// strictly smaller and the method terminates. An answer is accepted only after its optimality has
// been proved on the bodies as given.
#pragma once

#include "core/pose.hpp"
#include "tests/shared/exact_body.hpp"

namespace clearance::oracle {

struct ExactDistance {
  Rational squared;  // square of the distance between the bodies without their radii
  // The square of the depth if the bodies overlap (see exact_depth.hpp). It is 0 unless it has been
  // set.
  Rational squared_depth;
  Rational radii;                      // the sum of both radii
  RationalVec point_on_a, point_on_b;  // a closest pair of the bodies without radii, in the world
  // The distance is sqrt(squared) - sqrt(squared_depth) - radii. These are the adjacent doubles:
  // lower <= distance <= upper.
  double lower = 0.0, upper = 0.0;
  int steps = 0;

  [[nodiscard]] bool cores_meet() const { return squared == 0; }
  // The sign of (distance - value), decided exactly.
  [[nodiscard]] int compare(const Rational& value) const;
  [[nodiscard]] int compare(double value) const;  // infinities allowed
  // Adds balls of these radii to the same pair.
  void add_radii(double radius_a, double radius_b);
  void set_squared_depth(const Rational& value);
};

// The distance without radii. Throws std::logic_error if the proof of optimality fails, which is an
// error of the oracle and not of the caller.
[[nodiscard]] ExactDistance exact_distance(ExactBody& a, const Pose& world_from_a, ExactBody& b,
                                           const Pose& world_from_b);

// The distance with radii.
[[nodiscard]] ExactDistance exact_distance(const Body& a, const Pose& world_from_a, const Body& b,
                                           const Pose& world_from_b);

}  // namespace clearance::oracle
