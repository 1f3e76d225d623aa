// Lengths in the sentences of a replay.
#pragma once

#include <fmt/format.h>

#include <string>

namespace clearance {

// "0.05 m", in at most as many significant digits as given.
[[nodiscard]] inline std::string metres(double value, int digits = 9) {
  return fmt::format("{:.{}g} m", value, digits);
}

}  // namespace clearance
