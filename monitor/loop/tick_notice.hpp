// The notice that the leading one of two partners sends before each tick.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "config/scene/sensor.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/tick_time.hpp"

namespace clearance {

// The largest number of batches that a tick of partners uses; more wait for the next tick.
inline constexpr std::size_t kMostTickInputs = 256;
// The number of batches of the largest size that any tick takes in; more wait for the next tick.
inline constexpr std::size_t kLargestBatchesATick = 64;

// A leader that has not written a notice for 15 ms does not write what has one leader. The notice
// of a tick stands a quarter of a period before it.
inline constexpr double kLeastPartnersHz = 50.0;

// A batch that a tick uses.
struct TickInput {
  SourceName source;
  std::uint64_t sequence_number = 0;
  std::uint64_t content = 0;  // checksum of its samples
};

// A frame of a sensor that a tick is shown.
struct TickFrame {
  std::uint32_t sensor = 0;
  std::uint64_t content = 0;  // SensorFrame::content
};

// The role of a daemon among the two partners. The values are those of PartnerHealth on the wire.
enum class PartnerStanding : std::uint8_t {
  kAlone = 0,     // it has no partner
  kStarting = 1,  // it publishes nothing until it has the partner's state, or hears no partner
  kLeading = 2,   // it decides when both tick, and on which inputs
  kFollowing = 3,
  // The daemon could not follow, and ticks what it has: its reports are true, and rest on other
  // inputs than the partner's. It asks for the partner's state.
  kApart = 4,
};
[[nodiscard]] constexpr const char* name(PartnerStanding standing) noexcept {
  constexpr std::array kNames = {"alone", "starting", "leading", "following", "apart"};
  return kNames[static_cast<std::size_t>(standing) % kNames.size()];
}

// The fields are those of PartnerTick in idl/partners.idl.
struct TickNotice {
  std::uint64_t daemon = 0;
  std::int64_t start_ns = 0;
  std::uint64_t revision = 0;
  std::uint64_t term = 0;
  std::uint64_t lineage = 0, before = 0, since_cycle = 0, becoming = 0;
  std::uint64_t cycle = 0;
  TickTime time;
  // When it ticks. CLOCK_MONOTONIC of this machine, in a notice that was heard too.
  std::int64_t due_ns = 0;
  // The told time is this much later than the time at `due_ns`: a leader that was held up tells a
  // later one.
  std::int64_t told_late_ns = 0;
  std::array<TickInput, kMostTickInputs> inputs;
  std::size_t count = 0;
  std::array<TickFrame, kMaxSensors> frames;
  std::size_t frame_count = 0;

  // Sums of the stated times and of this machine's do not overflow. `now_ns`: of its clocks.
  [[nodiscard]] bool has_possible_times(std::int64_t now_ns) const noexcept {
    const auto is_near = [](std::int64_t ns) { return ns >= -kForgottenNs && ns <= kForgottenNs; };
    return is_near(less(time.now_ns, now_ns)) && is_near(time.clock_offset_ns) &&
           is_near(told_late_ns) && is_near(due_ns) &&
           time.report_delay_ns >= TickTime::kNotMeasured;
  }
  [[nodiscard]] std::span<const TickInput> used() const noexcept {
    return std::span(inputs).first(count);
  }
  [[nodiscard]] std::span<const TickFrame> shown() const noexcept {
    return std::span(frames).first(frame_count);
  }
};

}  // namespace clearance
