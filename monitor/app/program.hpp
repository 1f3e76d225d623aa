// What every program does in the same way: its exit status, --version, and its message on failure.
#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <optional>

#include "config/cell/cell_file.hpp"
#include "monitor/app/stop_signal.hpp"

namespace clearance {

// The same for all programs; each --help lists those that it uses.
enum ExitCode : int {
  kOk = 0,
  kFailed = 1,
  kUsage = 2,
  kBadCell = 3,
  kDdsFailed = 4,
  kIncomplete = 5,  // a file or a stream is not complete: --help says which
};

// The exit code of a program that an exception ended.
using ExitCodeOf = std::function<ExitCode(const std::exception&)>;

// All that main() does: calls `body` and returns its exit code. An exception goes to stderr as
// "NAME: what", and `exit_code_of` gives its exit code (without one: kFailed). The signals that
// stop a program wait for `body` from the first moment on.
[[nodiscard]] int run_program(const char* name, const std::function<int(StopSignal&)>& body,
                              const ExitCodeOf& exit_code_of = {});

// Adds --version. The exit code when there is nothing more to do: --help, --version or wrong usage.
[[nodiscard]] std::optional<int> parse(CLI::App& app, int argc, char** argv);

// What reading a cell tells the person who waits for it goes to stderr.
[[nodiscard]] CellOptions told_on_stderr();

// The cell, or nothing after every error in the cell has gone to stderr, a line each.
[[nodiscard]] std::optional<Cell> cell_or_errors(CellResult result);

}  // namespace clearance
