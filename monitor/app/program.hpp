// What every program does in the same way: its exit status, its command line, the cell that it
// reads, the files that it writes, and its last words.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>

#include "config/cell_file.hpp"
#include "monitor/app/stop_signal.hpp"

namespace clearance {

enum ExitCode : int {
  kOk = 0,
  kFailed = 1,
  kUsage = 2,
  kBadCell = 3,
  kDdsFailed = 4,
  kIncomplete = 5,  // what was to be recorded, read or heard is not all there: --help says more
};

// All that main() does: calls `body` and returns its exit code; what it throws goes to stderr as
// "NAME: what". The signals that stop a program wait for `body` from the first moment on.
[[nodiscard]] int run_program(const char* name, const std::function<int(StopSignal&)>& body);

// Adds --version. The exit code when there is nothing more to do: --help, --version or wrong usage.
[[nodiscard]] std::optional<int> parse(CLI::App& app, int argc, char** argv);

// The scene, or nothing after every error in the cell has gone to stderr, a line each.
[[nodiscard]] std::optional<Scene> scene_or_errors(CellResult cell);

// Of options: a finite number; such a number above 0; or from 0 on.
[[nodiscard]] CLI::Validator finite_number();
[[nodiscard]] CLI::Validator positive_number();
[[nodiscard]] CLI::Validator number_from_zero();
// Of options: a whole number in this range, both included.
[[nodiscard]] CLI::Validator whole_number(std::int64_t smallest, std::int64_t largest);

// False, after saying so on stderr, when `output` is one of the files that are read: it would be
// destroyed.
[[nodiscard]] bool output_is_not_an_input(const char* program, const std::filesystem::path& output,
                                          std::initializer_list<std::filesystem::path> inputs);

// "--force", without which no program writes over a file.
void add_force(CLI::App& app, bool& force);

// False, after saying so on stderr, when the file is there and `force` is not given, or its folder
// is not there. An empty name is no file.
[[nodiscard]] bool can_create(const char* program, const std::filesystem::path& file, bool force);

// What the program did not write to its end must not be taken for whole: removes the file, if it
// is a regular one, and says on stderr what became of it.
void remove_unfinished(const char* program, const std::filesystem::path& file);

}  // namespace clearance
