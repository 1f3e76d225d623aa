// The slip of tests/mutants/*.slips that is made: the number in the environment variable
// CLEARANCE_SLIP, or none. Only builds with -DCLEARANCE_MUTANTS=ON include this.
#pragma once

#include <cstdlib>
#include <type_traits>

inline const int clearance_chosen_slip = [] {
  const char* number = std::getenv("CLEARANCE_SLIP");
  return number ? std::atoi(number) : 0;
}();

// Whether the slip with this number is made. The compiler's own evaluation of constants has no
// slips.
constexpr bool clearance_slip(int number) {
  return !std::is_constant_evaluated() && clearance_chosen_slip == number;
}
