// Counts what operator new hands out, in the whole test program, and malloc and its like, wherever
// they are called from what is linked into it: Eigen's matrices come from there.
#pragma once

#include <cstdint>

namespace clearance {

// Allocations of this thread so far, and how many bytes they asked for.
[[nodiscard]] std::uint64_t allocations() noexcept;
[[nodiscard]] std::uint64_t allocated_bytes() noexcept;

}  // namespace clearance
