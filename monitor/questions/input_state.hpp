// The inputs of a running loop at one tick: what a question does not state itself.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "monitor/monitor.hpp"

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

// The state before any tick: room for what the loop knows of this scene.
[[nodiscard]] InputState room_for_inputs(const Scene& scene);

// Reads the inputs of a loop for several threads. One copy in the tick thread serves all that asked
// before it.
class InputStates {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // `loop_ended` is set once the thread of the loop has ended. Both must outlive this.
  InputStates(TickLoop& loop, const std::atomic<bool>& loop_ended)
      : loop_(loop), loop_ended_(loop_ended) {}

  // Returns inputs that the loop had at `since` or later, while it ticked the scene of this cell.
  // Waits for the next tick. Returns null if the loop ticks another scene, or has ended.
  [[nodiscard]] std::shared_ptr<const InputState> of(const std::shared_ptr<const Cell>& cell,
                                                     Time since);

 private:
  TickLoop& loop_;
  const std::atomic<bool>& loop_ended_;
  std::mutex mutex_;
  std::shared_ptr<const Cell> cell_;
  std::shared_ptr<const InputState> last_;
  Time asked_ = Time::min();  // before the loop answered
};

}  // namespace clearance
