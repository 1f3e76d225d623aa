// Counts what operator new hands out, in the whole test program.
#pragma once

#include <cstdint>

namespace clearance {

// Allocations of this thread so far.
[[nodiscard]] std::uint64_t allocations() noexcept;

}  // namespace clearance
