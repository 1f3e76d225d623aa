// Invariants at the borders of the tick's stages, which hold for all inputs. They are checked in
// tests, and in builds configured with CLEARANCE_INVARIANTS=ON, which is the default. The README.md
// of this folder lists the checks and their cost.
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

// Prints the broken invariant to standard error and ends the program, because its results can no
// longer be trusted. `file`: without its folder, which two builds of one commit may name
// differently.
[[noreturn]] void invariant_broken(const char* what, const char* file, int line) noexcept;

}  // namespace clearance

#define CLEARANCE_INVARIANT(holds)                                      \
  do {                                                                  \
    if constexpr (::clearance::kInvariantsChecked) {                    \
      if (!(holds)) [[unlikely]]                                        \
        ::clearance::invariant_broken(#holds, __FILE_NAME__, __LINE__); \
    }                                                                   \
  } while (false)
