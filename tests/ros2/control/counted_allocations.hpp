// Counts the calls of malloc and its relatives, those of plug-ins included.
#pragma once

#include <cstdint>

// Returns the calls of this thread so far.
[[nodiscard]] std::uint64_t counted_allocations() noexcept;
