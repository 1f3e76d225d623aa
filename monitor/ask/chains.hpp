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
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/bodies/posed_part.hpp"

namespace clearance {

// A joint between base and tip. An object that carries a robot and moves counts as two: one that
// slides, and one that rotates.
struct ChainJoint {
  std::uint32_t link = 0;      // the link that it carries, counted through all robots
  std::uint32_t variable = 0;  // as Chains::of_carrier() counts them
  double factor = 1.0;         // |multiplier| of a joint that mimics another
  bool rotates = true;
  bool about_any_axis = false;  // through the origin of the carrying object
  // No point of the tip is ever farther from a point of the joint's axis than this, m.
  double largest_reach = kInfinity;
};

// The share of a variable in how much nearer two bodies come: if each variable changes by at most
// its bound, their distance falls by at most the sum of the bounds times these factors.
struct Lever {
  std::uint32_t variable = 0;  // as Chains::of_carrier() counts them
  double factor = 0.0;         // m/rad, or 1; infinity: there is no bound
};

struct Chain {
  static constexpr std::uint32_t kNone = ~0u;
  std::uint32_t begin = 0, end = 0;  // into Chains::joints, from the base to the tip
  std::uint32_t common = kNone;      // the first link, of all robots, that both hang on
  bool shares_carrier = false;       // one object carries both; or carries the tip, and is the base
};

// By how far something may come nearer to what else there is, by its assumed speed, m: until the
// end of a stretch, its middle, and its begin.
struct Nearing {
  double until_end = 0.0, until_middle = 0.0, until_begin = 0.0;
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
  // True if a joint, or an object that carries its robot, can move the link relative to the world.
  [[nodiscard]] bool can_move(std::uint32_t object) const noexcept;
  // The object on which the robot of a link stands; kNone: the world.
  [[nodiscard]] std::uint32_t carrier_of(std::uint32_t object) const noexcept;
  // Calls use(variable) for all that moves a link of a robot relative to the world.
  template <class Use>
  void for_each_variable(std::uint32_t object, const Use& use) const {
    for (std::uint32_t n = node_of_object_[object]; n != kNoNode; n = nodes_[n].parent) {
      const Node& node = nodes_[n];
      if (node.joint == nullptr && is_carried(node)) use(of_carrier(node.robot));
      if (node.joint == nullptr) continue;
      for (std::uint32_t i = 0; i < variables_of(node.joint->type); ++i)
        use(node.joint->variable + i);
    }
  }

  // Bounds of the motion of carrying objects follow those of the scene's variables: two for each
  // robot. The first is its translation, m; the second its rotation, rad.
  [[nodiscard]] std::uint32_t variables() const noexcept {
    return static_cast<std::uint32_t>(scene_.variables.size() + 2 * scene_.robots.size());
  }
  [[nodiscard]] std::uint32_t of_carrier(std::uint32_t robot) const noexcept {
    return static_cast<std::uint32_t>(scene_.variables.size()) + 2 * robot;
  }

  // Lists them from the base to the tip. An axis with no bound has an infinite or immense reach.
  [[nodiscard]] std::span<const ChainJoint> joints(const Chain& chain) const noexcept {
    return std::span(joints_).subspan(chain.begin, chain.end - chain.begin);
  }

  // To be called once, after the last between().
  void finish();

  // Reads the axes of all joints after the links were placed. `bases`: by robot, what it stands on.
  void place(const ForwardKinematics& kinematics, std::span<const LinkState> bases) noexcept;

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

  // By how far a sphere at a link may have come nearer to the other body of the chain through
  // variables that deviate from what is stated by at most `free`. These are bounds until the end,
  // the middle and the begin of the stretch in which all variables deviate by `bounds`.
  [[nodiscard]] Nearing nearing(const Chain& chain, std::uint32_t object, const Sphere& sphere,
                                std::span<const VariableBounds> bounds,
                                std::span<const Nearing> free) const noexcept;

 private:
  static constexpr std::uint32_t kNoNode = Chain::kNone;
  struct Node {
    std::uint32_t parent = kNoNode, robot = 0, link = 0;
    const RobotJoint* joint = nullptr;  // null at the root of a robot
    Vec3 place_in_parent = Vec3::Zero();
    double largest_slide = 0.0;  // m
  };
  [[nodiscard]] bool is_carried(const Node& node) const noexcept {
    return node.joint == nullptr && scene_.robots[node.robot].base.kind == RobotBase::Kind::kObject;
  }

  const Scene& scene_;
  std::vector<double> radii_;                  // by object
  std::vector<Node> nodes_;                    // all links of all robots
  std::vector<std::uint32_t> node_of_object_;  // kNoNode: not a link
  std::vector<ChainJoint> joints_;
  std::vector<PlacedAxis> axes_;  // by node; of a root: the origin of what carries it
  std::vector<std::uint32_t> moving_;
  std::vector<double> reaches_;  // by joint, of the last displacement()
};

}  // namespace clearance
