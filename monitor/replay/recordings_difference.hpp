// The first difference of two recordings of the same cycles, such as those of two daemons that run
// one cell. No monitor runs: the recorded reports themselves are compared.
//
// Partners (monitor/loop) tick other inputs before they join and while they are apart. Only
// their ticks of the same lineage are compared.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace clearance {

struct RecordingsDifference {
  // In this order they are looked for in a cycle, since each may be the reason of the next.
  enum class Kind : std::uint8_t {
    kSame,
    kMissing,  // a cycle that follows a compared one is in only one recording
    kScene,    // another scene revision
    kInputs,   // another batch of a source, or the same one with other content
    kTime,     // the tick was given another time
    kResult,   // the same inputs led to another report, separation, gradient or zone state
  };

  // Cycles that were compared one after another, with both ends.
  struct Stretch {
    std::uint64_t first = 0, last = 0;
  };

  std::string error;   // not empty: a file cannot be compared at all
  std::string damage;  // not empty: a file ends early; what is before the damage was compared
  bool stopped = false;
  std::uint64_t compared = 0;                     // cycles
  std::uint64_t first_cycle = 0, last_cycle = 0;  // of those
  std::vector<Stretch> stretches;                 // of those
  // Cycles of the first and of the second recording before the last compared one that the other one
  // has no counterpart of, or only one of another lineage.
  std::array<std::uint64_t, 2> left_out{};
  Kind kind = Kind::kSame;
  std::uint64_t cycle = 0;  // of the difference
  std::int64_t now_ns = 0;  // the tick's time in the first recording that has the cycle
  std::string what;         // the field or the batch, with both values

  [[nodiscard]] bool is_same() const noexcept { return error.empty() && kind == Kind::kSame; }
};

// Cycles with the same number are compared, from the first to the last number that both files have.
// If both files have lineages, only cycles of the same lineage are compared. Batches whose source
// does not count (sequence number 0) are not compared. `stop` is asked between cycles and may be
// empty.
[[nodiscard]] RecordingsDifference compare_recordings(const std::filesystem::path& first,
                                                      const std::filesystem::path& second,
                                                      const std::function<bool()>& stop = {});

}  // namespace clearance
