// Seeded random numbers that are equal on every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/pose.hpp"

namespace clearance {

// SplitMix64 (Steele, Lea, Flood 2014). Streams of seeds that follow each other have nothing in
// common: the step between two numbers is no multiple of the one between two seeds.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) { (void)next(); }

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  // A number in [0, 1).
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  // A number with a uniformly distributed logarithm, for quantities whose order of magnitude
  // matters.
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  // A number in [low, high].
  int integer(int low, int high) {
    return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double probability) { return unit() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

  Vec3 in_box(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }
  Vec3 direction() {
    const double z = uniform(-1.0, 1.0), angle = uniform(0.0, 2.0 * std::numbers::pi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  // A uniformly distributed rotation (Shoemake 1992).
  Eigen::Quaterniond rotation() {
    const double u = unit(), a = uniform(0.0, 2.0 * std::numbers::pi),
                 b = uniform(0.0, 2.0 * std::numbers::pi);
    const double s = std::sqrt(1.0 - u), t = std::sqrt(u);
    return {t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b)};
  }
  // A position within a box around the origin, and any rotation.
  Pose pose(double half) {
    const Vec3 position = in_box(half);
    return {position, rotation()};
  }

 private:
  std::uint64_t state_;
};

}  // namespace clearance
