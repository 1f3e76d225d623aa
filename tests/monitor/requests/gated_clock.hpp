// A clock that lets the loop tick only as often as a test asks for, or freely.
//
// While the loop waits in it, the test may read the loop's monitor.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "monitor/loop/ports.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {

class GatedClock final : public Clock {
 public:
  std::int64_t realtime_ns() noexcept override { return kStart + now_; }
  std::int64_t monotonic_ns() noexcept override { return now_; }
  std::int64_t steady_ns() noexcept override { return now_; }
  void sleep_until(std::int64_t monotonic_ns) noexcept override {
    std::unique_lock lock(mutex_);
    now_ = std::max(now_, monotonic_ns);
    waits_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return is_free_ || ticks_ > 0; });
    waits_ = false;
    if (ticks_ > 0) --ticks_;
    if (!is_free_) return;
    const bool is_long = ++free_ticks_ > kFastTicks;
    lock.unlock();
    std::this_thread::sleep_for(is_long ? kLongPause : kPause);
  }

  // Runs this many ticks.
  void run(int ticks) {
    std::unique_lock lock(mutex_);
    ticks_ = ticks;
    changed_.notify_all();
    changed_.wait(lock, [this] { return ticks_ == 0 && waits_; });
  }
  void run_freely() {
    const std::lock_guard lock(mutex_);
    is_free_ = true;
    free_ticks_ = 0;
    changed_.notify_all();
  }
  // Returns when the loop waits.
  void stop() {
    std::unique_lock lock(mutex_);
    is_free_ = false;
    changed_.wait(lock, [this] { return waits_; });
  }

 private:
  // The loop's time runs faster than that of the machine, but not for long: other threads may have
  // to wait for a processor.
  static constexpr std::chrono::microseconds kPause{30}, kLongPause{2000};
  static constexpr int kFastTicks = 100;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::int64_t now_ = 0;
  bool is_free_ = false, waits_ = false;
  int ticks_ = 0, free_ticks_ = 0;
};

}  // namespace clearance::test
