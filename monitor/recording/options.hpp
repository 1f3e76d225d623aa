// The content of a recording, and the number of its files.
#pragma once

#include <cstdint>
#include <set>

#include "monitor/wire/topics.hpp"

namespace clearance {

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
};

// Returns true when the report of this cycle keeps its pairs.
[[nodiscard]] inline bool keeps_pairs(const RecordingOptions& options,
                                      std::uint64_t cycle) noexcept {
  return options.pairs_every <= 1 || cycle % options.pairs_every == 0;
}

}  // namespace clearance
