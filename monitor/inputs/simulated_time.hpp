// The time of a simulation, from the messages of its clock (/clock of ROS 2).
//
// A message states the simulated time at which it was sent. Until the next one comes, the time goes
// on as between the last two, by at most the step between them. A message with the same time again
// is a pause, in which nothing ages.
//
// Joints, poses and frames often come before the message of their time. A stamp that is ahead of
// the clock by no more than two steps and kLateNs leads the time. A recorder that takes its time
// from a clock is late by one step, and a player of its bag by another.
//
// A clock that goes back has begun anew. One that is silent for kSilentNs may be paused, or dead.
// Both mean that an unknown time has passed (TickTime), and inputs count when they come again.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

#include "monitor/inputs/tick_time.hpp"

namespace clearance {

// One thread calls note(), and the tick thread calls tick_time(). All other members are for any
// thread. None allocates, throws or locks.
class SimulatedTime {
 public:
  static constexpr std::int64_t kSilentNs = 1'000'000'000;
  // A larger step is a jump: until the next message, only stamps of inputs lead the time on.
  static constexpr std::int64_t kLongestStepNs = 250'000'000;
  // A message of the clock may come so much later than what was sent after it, simulated ns.
  static constexpr std::int64_t kLateNs = 5'000'000;

  enum class Change : std::uint8_t { kGoesOn, kFirst, kBack };
  // A message of the clock: its time, its time of sending (CLOCK_REALTIME of the sender), and when
  // it came (CLOCK_MONOTONIC).
  Change note(std::int64_t time_ns, std::int64_t sent_ns, std::int64_t came_ns) noexcept;
  // An input with this stamp has come: to be told before a tick can use it. A stamp after
  // latest_ns() changes nothing.
  void lead(std::int64_t stamp_ns) noexcept;

  // False before the first message.
  [[nodiscard]] bool is_known() const noexcept { return count_.load() > 0; }
  [[nodiscard]] bool is_silent(std::int64_t monotonic_ns) const noexcept;
  // The number of times that the clock went back.
  [[nodiscard]] std::uint64_t resets() const noexcept;
  // The time of the last message; 0 before the first.
  [[nodiscard]] std::int64_t clock_ns() const noexcept;
  // The latest time to which a stamp can lead: kLateNs and twice the last step after the last
  // message, and never less than before. Twice a step counts as kLongestStepNs at most, and so it
  // does while no step is known. A clock that goes back allows stamps that are as far ahead of it
  // as before.
  [[nodiscard]] std::int64_t latest_ns() const noexcept { return last().latest_ns; }
  // The present time; 0 before the first message.
  [[nodiscard]] std::int64_t now_ns(std::int64_t monotonic_ns) const noexcept;
  // The simulated time at which something was sent. `sent_ns` is CLOCK_REALTIME of the clock's
  // machine, or of one that is synchronised with it. What was sent before the messages that are
  // kept counts as older than it is.
  [[nodiscard]] std::int64_t at(std::int64_t sent_ns) const noexcept;

  // Returns the simulated time that passes in a true time, by the speed of the last two messages,
  // rounded up, ns.
  [[nodiscard]] std::int64_t passes_in(std::int64_t true_ns) const noexcept;

  // The time of the coming tick: later than that of the tick before, unless an unknown time has
  // passed. In a pause, it is later by 1 ns, since no two ticks may have one time.
  [[nodiscard]] TickTime tick_time(std::int64_t monotonic_ns) noexcept;

 private:
  // What one message says.
  struct Segment {
    std::int64_t sent_ns = 0, came_ns = 0;
    std::int64_t clock_ns = 0;  // its time
    // The simulated time when it was sent, and the latest one until the next message comes. The
    // former is `clock_ns`, unless the time had gone on farther by then.
    std::int64_t begin_ns = 0, end_ns = 0;
    std::int64_t step_ns = 0, interval_ns = 1;  // simulated and true time between the last two
    std::int64_t latest_ns = 0;                 // see latest_ns()
    std::uint64_t resets = 0;

    [[nodiscard]] std::int64_t after(std::int64_t passed_ns) const noexcept;
    // Requires that `led_ns` was read before the message was: only stamps of another run are after
    // the latest time then.
    [[nodiscard]] std::int64_t present(std::int64_t monotonic_ns,
                                       std::int64_t led_ns) const noexcept;
  };
  static constexpr std::size_t kKept = 1024;  // 100 ms of a clock of 10 kHz
  static constexpr std::size_t kWords = sizeof(Segment) / sizeof(std::int64_t);

  // The message of this number, or nothing if it has been replaced.
  [[nodiscard]] std::optional<Segment> segment(std::uint64_t number) const noexcept;
  [[nodiscard]] Segment last() const noexcept;

  std::array<std::array<std::atomic<std::int64_t>, kWords>, kKept> kept_{};
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::int64_t> led_ns_{0};  // the latest stamp that has led, maybe in another run
  // Of the tick thread.
  std::int64_t told_ns_ = 0;
  std::uint64_t told_resets_ = 0;
  bool told_silence_ = false;
};

}  // namespace clearance
