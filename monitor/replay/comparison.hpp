// The extent to which a replayed report must agree with the recorded one.
#pragma once

#include <cstdint>

namespace clearance {

enum class Comparison : std::uint8_t {
  kBits,    // every field of the tick, to the bit
  kBounds,  // only what is certified: bounds of one pair overlap. For other builds, or when
            // the history before the recording is missing
};

}  // namespace clearance
