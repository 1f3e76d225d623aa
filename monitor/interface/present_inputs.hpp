// The inputs that a tick knows, which a question need not state.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pose.hpp"
#include "monitor/interface/report.hpp"

namespace clearance {

// The pose of a body at the last tick.
struct PresentPose {
  enum class State : std::uint8_t { kUsable, kUnknown, kLate, kContradicted, kAbsent };
  State state = State::kUnknown;
  Pose world_from_body = {};  // if it is usable
};

// The position of a joint variable at the last tick.
struct PresentJoint {
  PresentPose::State state = PresentPose::State::kUnknown;
  double position = 0.0;  // rad or m, if it is usable
  double velocity = 0.0;  // per second; NaN: not known
};

// A joint that moves faster than this does not stay where it is, rad/s or m/s. Drives at rest
// report less.
inline constexpr double kRestSpeed = 2e-3;

struct PresentObject {
  std::uint32_t object = 0;  // index into Scene::objects
  PresentPose pose = {};
  double age = 0.0;  // s: the object had that pose this long before the tick
};

struct InputState {
  std::uint64_t cycle = 0;                  // the last tick; 0: none yet
  std::int64_t now_ns = 0;                  // its time
  std::vector<PresentJoint> joints = {};    // in the order of Scene::variables
  std::vector<double> joint_ages = {};      // s: they had these positions this long before the tick
  std::vector<PresentObject> objects = {};  // those that are neither fixed nor links of robots
  std::vector<ContactReport> contacts = {};  // for each of contact_pairs()
};

}  // namespace clearance
