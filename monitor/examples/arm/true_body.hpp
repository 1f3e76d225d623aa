// The surface of a person whose joints are known, for true distances. It has nothing of the
// capsules that stand for the person in a cell.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "monitor/examples/arm/bvh.hpp"

namespace clearance::people {

// A limb as balls along a line, whose radii go from one value to another, m.
struct Limb {
  std::string_view link;  // of the skeleton of ROS4HRI, without the ending
  Vec3 from, to;
  double from_radius, to_radius;
};

// The limbs of a person of usual build. Trunk and pelvis are several lines side by side.
[[nodiscard]] std::vector<Limb> true_limbs(const Keypoints& person);

// A capsule, for a body of a machine.
struct TrueCapsule {
  Vec3 from, to;
  double radius;
};

// The distance of a limb's balls, which lie densely, from a capsule: never less than that of the
// limb.
[[nodiscard]] double true_distance(const Limb& limb, const TrueCapsule& capsule);

}  // namespace clearance::people
