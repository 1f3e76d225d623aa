// A machine that is off its model by less than the model's stated errors say. Its bodies are placed
// by composing rigid motions one after the other, as the errors would arise; this shares nothing
// with the bounds.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

// The errors of one instant.
struct DrawnErrors {
  struct Place {
    Vec3 shift = Vec3::Zero();  // m
    Vec3 turn = Vec3::Zero();   // rad, axis times angle
  };
  std::vector<std::vector<Place>> frames;      // by robot and joint
  std::vector<std::vector<double>> positions;  // likewise, rad or m
  std::vector<Place> bases;                    // by robot
  std::vector<Place> objects;
};

// Random errors within those that the scene states. Most of them are as large as they may be.
[[nodiscard]] DrawnErrors drawn_errors(const Scene& scene, Random& random);

// The poses of all objects of the true machine. `positions`: by variable, as the machine's
// controller tells them. `sent`: by object, as a tracker sends them; not read of links and fixed
// objects.
[[nodiscard]] std::vector<Pose> true_poses(const Scene& scene, std::span<const double> positions,
                                           std::span<const Pose> sent, const DrawnErrors& errors);

}  // namespace clearance::test
