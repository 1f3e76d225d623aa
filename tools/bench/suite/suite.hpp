// `clearance-bench --suite`: its command line, and the table and the picture that it writes.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/bench/suite/race.hpp"

namespace clearance::bench {

// Runs `clearance-bench --suite` with the words after it. Returns the exit status.
[[nodiscard]] int run_suite(std::span<const std::string> words);

// All rows, one a line.
[[nodiscard]] std::string suite_csv(std::span<const RaceRow> rows, std::span<const Rival> rivals);
// A page: settings, picture, the rows of all separations together.
[[nodiscard]] std::string suite_page(std::span<const RaceRow> rows, std::span<const Rival> rivals,
                                     const RaceOptions& options);
// Draws the largest error against the median time, a mark for each rival and class. Returns an
// empty text or the fault.
[[nodiscard]] std::string draw_suite(const std::filesystem::path& svg,
                                     std::span<const RaceRow> rows, std::span<const Rival> rivals);

}  // namespace clearance::bench
