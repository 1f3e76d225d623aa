// The exit status and the failure message, which all programs share.
#pragma once

#include <exception>
#include <functional>
#include <optional>

#include "config/cell/cell_file.hpp"
#include "monitor/app/stop_signal.hpp"

namespace clearance {

// The exit codes of all programs; each --help lists those that it uses.
enum ExitCode : int {
  kOk = 0,
  kFailed = 1,
  kUsage = 2,
  kBadCell = 3,
  kDdsFailed = 4,
  kIncomplete = 5,  // a file or a stream is not complete: --help says which
  kRefused = 6,     // a daemon refused what it was asked
  kDamaged = 7,     // a bit of the program's memory has flipped
};

// Returns the exit code of a program that an exception has ended.
using ExitCodeOf = std::function<ExitCode(const std::exception&)>;

// Does all the work of main(): calls `body` and returns its exit code. An exception goes to stderr
// as "NAME: text", and `exit_code_of` gives its exit code (without one: kFailed). Signals that stop
// a program are kept for `body` from the first moment on.
[[nodiscard]] int run_program(const char* name, const std::function<int(StopSignal&)>& body,
                              const ExitCodeOf& exit_code_of = {});

// Options that send progress messages about a cell to stderr.
[[nodiscard]] CellOptions told_on_stderr();

// Returns the scene. If the cell has errors, writes them to stderr, one per line, and returns
// nothing.
[[nodiscard]] std::optional<Cell> cell_or_errors(CellResult result);

}  // namespace clearance
