// The content of a recording, and the number of its files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>

#include "monitor/wire/topics.hpp"

namespace clearance {

// Recording by event: only what was just before and after something that matters goes to the disk.
struct EventOptions {
  // The time before an event and after it that a file holds, ns. 0: everything is recorded.
  std::int64_t around_ns = 0;
  // Memory for the time before an event, taken once. If it holds less than that time, files begin
  // later.
  std::size_t ring_bytes = std::size_t{256} << 20;
  // Files of events are deleted, the oldest first, while all of them have more bytes than this; 0:
  // never; none: event_cap() decides. A file that reaches a quarter of it is continued in another.
  std::optional<std::uint64_t> keep_bytes = {};
  // Files that were written longer ago than this are deleted, ns; 0: never.
  std::int64_t keep_ns = 0;

  [[nodiscard]] bool any() const noexcept { return around_ns > 0; }
};

struct RecordingOptions {
  bool overwrite = true;  // false: an existing file is an error
  bool compress = true;   // chunks, by zstd
  // The files that the cell names go in as well when all of them, compressed, are no more than
  // this; 0: none.
  std::uint64_t attach_bytes = std::uint64_t{64} << 20;
  // The catalogue is always kept, because it is needed to read the others. Without poses and joint
  // states nothing can be replayed, and without reports no tick is compared.
  std::set<TopicKind> left_out = {};
  // One report in so many is kept whole. The reports between are kept without their pairs, which
  // are most of their size. A replay still knows every tick and makes the same reports.
  std::uint64_t pairs_every = 1;
  // A new file begins when one has this size (bytes) or spans this time (ns); 0: never. Each file
  // can be read by itself.
  std::uint64_t roll_bytes = 0;
  std::int64_t roll_ns = 0;
  // One tick in so many is kept: its report, and for each source and set of objects the newest
  // batch since the tick kept before. The ticks between leave only changes of zones. Such a
  // recording shows a run and can be replayed at its lower rate. The reports cannot be made again
  // to the bit.
  std::uint64_t ticks_every = 1;
  EventOptions events = {};
  // One frame of a sensor in so many is kept whole, of the others only a note that a tick saw them.
  // 0: none. A replay gives the same reports only with all of them (1).
  std::uint64_t clouds_every = 1;
};

// Returns true when the report of this cycle keeps its pairs.
[[nodiscard]] inline bool keeps_pairs(const RecordingOptions& options,
                                      std::uint64_t cycle) noexcept {
  return options.pairs_every <= 1 || cycle % options.pairs_every == 0;
}

}  // namespace clearance
