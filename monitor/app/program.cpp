// Puts the signal handling, the exceptions and the exit codes of all programs in one place.
#include "monitor/app/program.hpp"

#include <cstdio>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/text/printable.hpp"
#include "monitor/app/print.hpp"

namespace clearance {
// StopSignal blocks the signals before anything else starts a thread.
int run_program(const char* name, const std::function<int(StopSignal&)>& body,
                const ExitCodeOf& exit_code_of) {
  StopSignal stop;
  try {
    return body(stop);
  } catch (const std::exception& error) {
    print(stderr, "{}: {}\n", name, printable(error.what()));
    return exit_code_of ? exit_code_of(error) : kFailed;
  }
}

CellOptions told_on_stderr() {
  return {.tell = [](const std::string& line) { print(stderr, "{}\n", printable(line)); }};
}

// The number of errors stands last, where a person looks first.
std::optional<Cell> cell_or_errors(CellResult result) {
  if (Cell* const cell = std::get_if<Cell>(&result)) return std::move(*cell);
  const auto& errors = std::get<std::vector<CellError>>(result);
  for (const CellError& error : errors) print(stderr, "{}\n", printable(error.text));
  print(stderr, "{} error{}\n", errors.size(), errors.size() == 1 ? "" : "s");
  return std::nullopt;
}

}  // namespace clearance
