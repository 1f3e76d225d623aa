// Puts the signal handling, the exceptions and the exit codes of all programs in one place.
#include "monitor/app/program.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/text/printable.hpp"
#include "monitor/app/help_formatter.hpp"
#include "monitor/app/print.hpp"
#include "monitor/files/build_info.hpp"

namespace clearance {
namespace {

// Prints CLI11's message through print().
int say(const CLI::App& app, const CLI::Error& error) {
  std::ostringstream out, err;
  const int status = app.exit(error, out, err);
  print(stdout, "{}", out.str());
  print(stderr, "{}", err.str());
  return status;
}

}  // namespace

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

// CLI11 has an exit code for each mistake; here all of them are kUsage.
std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  app.set_version_flag("--version", std::string("clearance ") + kBuild);
  app.name(std::filesystem::path(argv[0]).filename());
  const auto formatter = std::make_shared<HelpFormatter>();
  app.formatter(formatter);
  for (CLI::App* subcommand : app.get_subcommands({})) subcommand->formatter(formatter);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // A mistyped option is often why something else is missing.
    const std::vector<std::string> unknown = app.remaining(true);
    if (!unknown.empty()) print(stderr, "{}\n", CLI::ExtrasError("", unknown).what());
    say(app, error);
    return kUsage;
  } catch (const CLI::ParseError& error) {
    return say(app, error) == 0 ? kOk : kUsage;
  }
  return std::nullopt;
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
