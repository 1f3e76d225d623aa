// Counts the calls of malloc and its relatives in the whole process, plug-ins included.
#pragma once

#include <cstdint>

// Of this thread, so far.
[[nodiscard]] std::uint64_t counted_allocations() noexcept;
