// How a figure is written into a table.
#pragma once

#include <fmt/format.h>

#include <string>

#include "tools/bench/report/figures.hpp"

namespace clearance::bench {

[[nodiscard]] inline std::string time_of(double ns) {
  return ns < 10000.0 ? fmt::format("{:.0f}", ns) : fmt::format("{:.2e}", ns);
}

[[nodiscard]] inline std::string ns(const Figure* f) { return f ? time_of(f->ns) : "-"; }

// Time, and how many queries failed if any did.
[[nodiscard]] inline std::string ns_and_failures(const Figure* f) {
  if (!f) return "-";
  return f->failures > 0.0 ? fmt::format("{} ({:.0f})", time_of(f->ns), f->failures)
                           : time_of(f->ns);
}

}  // namespace clearance::bench
