// Checks for options of the command line, each of which names what it found and what it expected;
// and options that several programs have.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "monitor/app/command_line.hpp"

namespace clearance {

// What `accepts` does; `expected` is a noun with its article. `shown` as in Check.
[[nodiscard]] Check expecting(const std::string& expected,
                              std::function<bool(const std::string&)> accepts,
                              const std::string& shown = {});

// A finite number; a finite number above 0; a finite number from 0 on.
[[nodiscard]] Check finite_number();
[[nodiscard]] Check positive_number();
[[nodiscard]] Check number_from_zero();

// A number, or a whole number, in this range, both ends included. --help shows the ranges of "_in".
[[nodiscard]] Check number_in(double smallest, double largest);
[[nodiscard]] Check whole_number(std::int64_t smallest, std::int64_t largest);
[[nodiscard]] Check whole_number_in(std::int64_t smallest, std::int64_t largest);

// One of these words.
[[nodiscard]] Check one_word_of(const std::vector<std::string>& words);

// A file, and no folder.
[[nodiscard]] Check existing_file();

// "--package NAME=DIRECTORY", repeatable: where the package:// of a URDF are. `excludes` as in
// OptionRule.
[[nodiscard]] Option packages_option(Packages& packages, std::vector<std::string> excludes = {});

// "--force", without which no program overwrites a file.
[[nodiscard]] Option force_option(bool& force);

// "--log-level" with its six values; `level` holds the default.
[[nodiscard]] Option log_level_option(std::string& level);

}  // namespace clearance
