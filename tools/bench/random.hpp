// Seeded directions and rotations.
#pragma once

#include <cmath>
#include <numbers>

#include "config/write/seeded_draw.hpp"
#include "core/vec.hpp"

namespace clearance::bench {

class Random : public SeededDraw {
 public:
  using SeededDraw::SeededDraw;
  Vec3 direction() {
    const double z = uniform(-1.0, 1.0), angle = uniform(0.0, 2.0 * std::numbers::pi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  Eigen::Quaterniond turn() {
    const double angle = uniform(0.0, 2.0 * std::numbers::pi);
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, direction()));
  }
};

}  // namespace clearance::bench
