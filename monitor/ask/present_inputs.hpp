// The inputs that a monitor knows at one tick, which a question need not state.
#pragma once

#include <cstdint>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

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

// The state before any tick: room for what a monitor knows of this scene.
[[nodiscard]] InputState room_for_inputs(const Scene& scene);

// Reads all but `cycle` and `now_ns`, between two ticks. The room is that of the monitor's scene.
// Allocates nothing.
void read_inputs(const Monitor& monitor, InputState& state) noexcept;

}  // namespace clearance
