// The max-min programme of a step. A few concave quadratic functions of one plane displacement have
// the same second derivative. The programme finds the displacement at which the least of them is
// greatest.
#pragma once

#include <array>
#include <cstddef>

#include "core/model/smooth_part.hpp"

namespace clearance {

// value + slope.s - s.Q s / 2, with the programme's Q.
struct PlaneFunction {
  double value;
  Vec2 slope;
};

struct PlaneStep {
  Vec2 step = Vec2::Zero();
  double value = 0.0;               // the least of the functions at the step
  std::array<double, 5> weights{};  // >= 0, sum 1; at most three functions are active
};

// Q: positive definite. functions: one to five.
[[nodiscard]] PlaneStep max_min(const std::array<PlaneFunction, 5>& functions, std::size_t count,
                                const PlaneMatrix& q) noexcept;

}  // namespace clearance
