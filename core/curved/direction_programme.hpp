// The step of a direction: the greatest of the least of a few quadratic functions of one plane
// displacement, all with the same second derivative.
#pragma once

#include <array>
#include <cstddef>

#include "core/curved/piece.hpp"

namespace clearance {

// value + slope.s - s.Q s / 2, Q the programme's.
struct PlaneFunction {
  double value;
  Vec2 slope;
};

struct PlaneStep {
  Vec2 step = Vec2::Zero();
  double value = 0.0;               // the least of the functions there
  std::array<double, 5> weights{};  // >= 0, sum 1: of the functions that are active, three at most
};

// Q: positive definite. functions: one to five.
[[nodiscard]] PlaneStep highest_least(const std::array<PlaneFunction, 5>& functions,
                                      std::size_t count, const PlaneMatrix& q) noexcept;

}  // namespace clearance
