// Counts what operator new hands out, in the whole test program, and malloc and its like, wherever
// they are called from what is linked into it: Eigen's matrices come from there.
#pragma once

#include <cstdint>

namespace clearance {

// Allocations of this thread so far.
[[nodiscard]] std::uint64_t allocations() noexcept;

}  // namespace clearance
