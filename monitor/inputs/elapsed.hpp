// Differences of any two times, ns. They saturate at the ends of the range instead of overflowing.
#pragma once

#include <cstdint>
#include <limits>

namespace clearance {

// The age, ns, given to a value whose real age is not known: a hundred years. It grows like others.
inline constexpr std::int64_t kForgottenNs = 3'155'760'000'000'000'000;

[[nodiscard]] inline double seconds(std::int64_t ns) noexcept {
  return static_cast<double>(ns) * 1e-9;
}

// Returns later - earlier, or 0 when `later` is not later.
[[nodiscard]] inline std::int64_t elapsed(std::int64_t earlier, std::int64_t later) noexcept {
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (later <= earlier) return 0;
  const std::uint64_t apart =
      static_cast<std::uint64_t>(later) - static_cast<std::uint64_t>(earlier);
  return static_cast<std::int64_t>(apart < kMost ? apart : kMost);
}

// Returns a - b, saturated at the end of the range.
[[nodiscard]] inline std::int64_t less(std::int64_t a, std::int64_t b) noexcept {
  std::int64_t difference = 0;
  if (!__builtin_sub_overflow(a, b, &difference)) return difference;
  return b > 0 ? std::numeric_limits<std::int64_t>::min()
               : std::numeric_limits<std::int64_t>::max();
}

}  // namespace clearance
