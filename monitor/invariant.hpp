// What must hold wherever the tick comes by, whatever it was told: checked in tests, and wherever
// the build is configured with CLEARANCE_INVARIANTS=ON. monitor/broad_phase/README.md says what is
// checked and what it costs.
#pragma once

namespace clearance {

#ifdef CLEARANCE_INVARIANTS
inline constexpr bool kInvariantsChecked = true;
#else
inline constexpr bool kInvariantsChecked = false;
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
