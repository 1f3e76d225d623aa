// Counts the allocations of operator new in the whole test program. Calls of malloc and its
// relatives are counted wherever the linked code makes them: Eigen's matrices are allocated there.
#pragma once

#include <cstdint>

namespace clearance {

// The number of allocations that this thread has made so far, and the bytes that they asked for.
[[nodiscard]] std::uint64_t allocations() noexcept;
[[nodiscard]] std::uint64_t allocated_bytes() noexcept;

}  // namespace clearance
