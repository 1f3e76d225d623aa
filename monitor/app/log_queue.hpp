// Lines of the log on their way from any thread to the one that writes them.
#pragma once

#include <spdlog/common.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace clearance {

struct LogLine {
  std::chrono::system_clock::time_point time;
  spdlog::level::level_enum level = spdlog::level::off;
  std::string text;
  std::uint64_t left_out_before = 0;  // lines that found the queue full since the line before
};

// Bounded and lock-free: push() never waits for the thread that writes, whatever that waits for.
// A queue that was full takes lines again when half of it is free, so that they come with few gaps.
// (A ring whose slots count their turns: D. Vyukov, Bounded MPMC queue.)
class LogQueue {
 public:
  explicit LogQueue(std::size_t lines);  // a power of two
  LogQueue(const LogQueue&) = delete;
  LogQueue& operator=(const LogQueue&) = delete;

  // Any thread. A line that finds no room is counted and lost.
  void push(LogLine line) noexcept;
  // Counts lines that were lost elsewhere.
  void leave_out(std::uint64_t lines) noexcept {
    left_out_.fetch_add(lines, std::memory_order_relaxed);
  }

  // The thread that writes. False: no line is ready.
  bool pop(LogLine& line) noexcept;
  // Lines left out after the last one that was pushed; counts anew from here.
  [[nodiscard]] std::uint64_t take_left_out() noexcept {
    return left_out_.exchange(0, std::memory_order_relaxed);
  }

  // Lines that were ever pushed. Any thread.
  [[nodiscard]] std::uint64_t pushed() const noexcept { return back_.load(); }

 private:
  struct Slot {
    std::atomic<std::uint64_t> turn;  // n: free for line n; n + 1: holds line n
    LogLine line;
  };

  bool place(LogLine& line) noexcept;

  std::vector<Slot> slots_;
  std::atomic<std::uint64_t> back_{0}, front_{0};  // lines pushed, lines popped
  std::atomic<bool> overflowed_{false};
  std::atomic<std::uint64_t> left_out_{0};
};

}  // namespace clearance
