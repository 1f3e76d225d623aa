// What must hold at the borders of the tick's stages, whatever the inputs are: checked in tests and
// wherever the build is configured with CLEARANCE_INVARIANTS=ON, which is the default. README.md
// here has the table of what is checked, and what it costs.
#pragma once

namespace clearance {

#ifdef CLEARANCE_INVARIANTS
inline constexpr bool kInvariantsChecked = true;
#else
inline constexpr bool kInvariantsChecked = false;
#endif

// Debug and sanitizer builds, where time does not matter, check more.
#ifdef CLEARANCE_MORE_INVARIANTS
inline constexpr bool kMoreInvariantsChecked = true;
#else
inline constexpr bool kMoreInvariantsChecked = false;
#endif

// Names what does not hold on standard error and ends the program: no figure of it can be trusted.
[[noreturn]] void invariant_broken(const char* what, const char* file, int line) noexcept;

}  // namespace clearance

#define CLEARANCE_INVARIANT(holds)                                 \
  do {                                                             \
    if constexpr (::clearance::kInvariantsChecked) {               \
      if (!(holds)) [[unlikely]]                                   \
        ::clearance::invariant_broken(#holds, __FILE__, __LINE__); \
    }                                                              \
  } while (false)
