// The simulated motion of a cell's objects: the `simulation:` section of a cell file.
//
// It has serial chains whose joints swing sinusoidally, and free movers. The simulated robot, the
// tests and the benchmarks use it; the tick never does. Positions are functions of time alone: any
// instant may be asked for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/pose.hpp"

namespace clearance {

// value(t) = centre + amplitude * sin(2 pi frequency_hz t + phase); rad for angles, m for lengths.
struct Swing {
  double centre = 0.0;
  double amplitude = 0.0;
  double frequency_hz = 0.0;
  double phase = 0.0;  // rad
};

// Revolute joints rotate about their axis, prismatic ones translate along it.
enum class JointKind : std::uint8_t { kRevolute, kPrismatic };

// One joint and the link that it carries. The link's frame is the joint's, rotated or shifted by
// the joint's value.
struct SimulatedJoint {
  // The objects that the link carries, each with the link's frame; may be empty.
  std::vector<std::uint32_t> objects;
  Pose parent_from_joint{};   // in the frame of the link before (the first: of the base)
  Vec3 axis = Vec3::UnitZ();  // unit, in the joint's frame
  JointKind kind = JointKind::kRevolute;
  Swing motion;
};

struct SimulatedChain {
  std::string name;
  Pose world_from_base;
  std::vector<SimulatedJoint> joints;  // from the base outwards
};

// An object on its own: its origin swings along `amplitude`, and it spins about a fixed axis of the
// world.
struct SimulatedMover {
  std::uint32_t object = 0;
  Pose centre;                    // in the world, before swing and spin are applied
  Vec3 amplitude = Vec3::Zero();  // m
  double frequency_hz = 0.0;
  double phase = 0.0;        // rad
  Vec3 spin = Vec3::Zero();  // rad/s, along world axes
};

// A frame of tf that moves as a mover does: a camera's, which is no object.
struct SimulatedFrame {
  std::string name;
  SimulatedMover motion;  // its object is not used
};

// The whole section; empty when a cell has none.
struct Simulation {
  std::vector<SimulatedChain> chains;
  std::vector<SimulatedMover> movers;
  std::vector<SimulatedFrame> frames;
  [[nodiscard]] bool empty() const noexcept {
    return chains.empty() && movers.empty() && frames.empty();
  }
};

// One object at one instant. The twist is the exact derivative of the pose.
struct PoseAt {
  std::uint32_t object = 0;  // index into Scene::objects
  Pose world_from_object;    // unit quaternion
  Twist twist;
};

// Replaces `poses` by the pose of every object that the simulation moves, `t_s` seconds after its
// start. Chains come in the order of the file, then movers. The result is deterministic. Allocates
// only when `poses` has to grow.
void poses_at(const Simulation& simulation, double t_s, std::vector<PoseAt>& poses);

// World from the frame, `t_s` seconds after the start.
[[nodiscard]] Pose frame_at(const SimulatedFrame& frame, double t_s);

}  // namespace clearance
