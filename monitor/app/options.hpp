// Validators for options of the command line: each names what it found and what it expected.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace clearance {

// A finite number; a finite number above 0; a finite number from 0 on.
[[nodiscard]] CLI::Validator finite_number();
[[nodiscard]] CLI::Validator positive_number();
[[nodiscard]] CLI::Validator number_from_zero();

// A whole number in this range, both ends included.
[[nodiscard]] CLI::Validator whole_number(std::int64_t smallest, std::int64_t largest);

// "--package NAME=DIRECTORY", repeatable: where the package:// of a URDF are.
CLI::Option* add_packages(CLI::App& app,
                          std::vector<std::pair<std::string, std::filesystem::path>>& packages);

// "--force", without which no program overwrites a file.
void add_force(CLI::App& app, bool& force);

// "--log-level" with its six values; `level` holds the default.
void add_log_level(CLI::App& app, std::string& level);

}  // namespace clearance
