// Samples which links of a robot touch each other in random positions of its joints, how far they
// reach along x, and their boxes while all joints are at 0.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

struct SamplingOptions {
  std::uint64_t samples = 100'000;
  std::uint64_t seed = 1;
  std::function<void(double share)> progress = {};  // 0 to 1, about a hundred times
};

// Two links with shapes, not both fixed. Ids are indices into Scene::objects.
struct SampledPair {
  std::uint32_t first = 0, second = 0;
  bool adjacent = false;       // no link with shapes lies between them
  bool touch_at_zero = false;  // with every joint at 0, or at the limit next to it
  std::uint64_t touching = 0;  // samples in which no gap is certified
  double least = kInfinity;    // m: the least distance of all samples; 0 where they touch
};

// Samples the scene's only robot. Joints are uniform within their limits, or over a whole turn. The
// place of the robot's base does not matter. The same seed gives the same counts.
[[nodiscard]] std::vector<SampledPair> sample_contacts(const Scene& scene,
                                                       const SamplingOptions& options);

// Where a link with shapes is while every joint is at 0, or at the limit next to it.
struct LinkExtent {
  std::uint32_t object = 0;                      // index into Scene::objects
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // m: a box around it, in the world
  // Does it only turn, about the vertical? Its height is then the same in all positions.
  bool turns_level = false;
};

// Of the scene's only robot.
[[nodiscard]] std::vector<LinkExtent> extents_at_zero(const Scene& scene);
// How far its links come along x, m: the most in seeded random positions and at zero.
[[nodiscard]] double reach_to_the_front(const Scene& scene);

}  // namespace clearance
