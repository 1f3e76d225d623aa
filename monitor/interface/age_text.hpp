// The age of an input, as text for all programs.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "monitor/inputs/elapsed.hpp"

namespace clearance {

// "1020 ms"; "never seen" of an age below 0. After an unknown time (TickTime), no age is known.
[[nodiscard]] inline std::string age_text(std::int64_t age_ns) {
  if (age_ns < 0) return "never seen";
  if (age_ns >= kForgottenNs) return "an unknown time";
  return fmt::format("{} ms", age_ns / 1'000'000);
}

}  // namespace clearance
