// The inputs of a running loop, read for the threads that answer questions.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>

#include "config/cell/cell.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/interface/present_inputs.hpp"
#include "monitor/loop/tick_loop.hpp"

namespace clearance {

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
  Mutex mutex_;
  GUARDED_BY(mutex_) std::shared_ptr<const Cell> cell_;
  GUARDED_BY(mutex_) std::shared_ptr<const InputState> last_;
  GUARDED_BY(mutex_) Time asked_ = Time::min();  // before the loop answered
};

}  // namespace clearance
