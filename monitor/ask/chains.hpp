// The joints between two objects, and how far one of them can move relative to the other.
//
// A chain leads from object `base` to object `tip`. Only these joints change the pose of the tip
// relative to the base. README.md has the proofs of the bounds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/ask/trajectory.hpp"
#include "monitor/geometry/posed_part.hpp"
#include "monitor/kinematics/forward_kinematics.hpp"

namespace clearance {

// A joint between base and tip.
struct ChainJoint {
  std::uint32_t link = 0;  // the link that it carries, counted through all robots
  std::uint32_t variable = 0;
  double factor = 1.0;  // |multiplier| of a joint that mimics another
  bool rotates = true;
  // No point of the tip is ever farther from a point of the joint's axis than this, m.
  double largest_reach = kInfinity;
};

struct Chain {
  std::uint32_t begin = 0, end = 0;  // into Chains::joints, from the base to the tip
  bool base_rests = false;           // no joint moves the base
};

// An axis in the world at the present instant.
struct PlacedAxis {
  Vec3 origin = Vec3::Zero(), direction = Vec3::UnitZ();
};

class Chains {
 public:
  // The largest radii of the objects about their origins are `radii`, m.
  Chains(const Scene& scene, std::span<const double> radii);

  // Adds the chain between two objects and returns it.
  [[nodiscard]] Chain between(std::uint32_t base, std::uint32_t tip);
  // True for objects that are links of robots, or attached to one.
  [[nodiscard]] bool is_link(std::uint32_t object) const noexcept {
    return node_of_object_[object] != kNoNode;
  }
  // True if a joint can move the link relative to the world.
  [[nodiscard]] bool can_move(std::uint32_t object) const noexcept;

  // To be called once, after the last between().
  void finish();

  // Reads the axes of all joints after the links were placed.
  void place(const ForwardKinematics& kinematics) noexcept;

  // No point of a sphere at the tip leaves its place relative to the base by more than this while
  // the variables deviate by `bounds`, m. `sphere` is in the world. Remembers the reaches.
  [[nodiscard]] double displacement(const Chain& chain, const Sphere& sphere,
                                    std::span<const VariableBounds> bounds) noexcept;
  // If every variable of a chain changes by at most e, no point of the tip moves farther relative
  // to the base than e times this.
  [[nodiscard]] double sum_of_reaches(const Chain& chain) const noexcept;
  // No point of that sphere has a larger acceleration in the base's frame, m/s2. Requires the last
  // displacement() to be of the same chain and sphere.
  [[nodiscard]] double acceleration(const Chain& chain,
                                    std::span<const VariableBounds> bounds) const noexcept;

 private:
  static constexpr std::uint32_t kNoNode = ~0u;
  struct Node {
    std::uint32_t parent = kNoNode, robot = 0, link = 0;
    const RobotJoint* joint = nullptr;  // null at the root of a robot
    Vec3 place_in_parent = Vec3::Zero();
    double largest_slide = 0.0;  // m
  };

  const Scene& scene_;
  std::vector<double> radii_;                  // by object
  std::vector<Node> nodes_;                    // all links of all robots
  std::vector<std::uint32_t> node_of_object_;  // kNoNode: not a link
  std::vector<ChainJoint> joints_;
  std::vector<PlacedAxis> axes_;  // by node
  std::vector<std::uint32_t> moving_;
  std::vector<double> reaches_;  // by joint, of the last displacement()
};

}  // namespace clearance
