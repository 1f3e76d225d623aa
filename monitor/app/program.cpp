#include "monitor/app/program.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "monitor/daemon/recording.hpp"
#include "monitor/dds/participant.hpp"
#include "monitor/recording/build.hpp"

namespace clearance {
namespace {

int last_words(const char* name, const std::exception& error, ExitCode code) {
  std::fprintf(stderr, "%s: %s\n", name, error.what());
  return code;
}

CLI::Validator number(bool (*suits)(double), const char* expected) {
  const auto fault = [suits, expected](const std::string& text) {
    double value = 0.0;
    if (CLI::detail::lexical_cast(text, value) && suits(value)) return std::string();
    return "found '" + text + "'; expected " + expected;
  };
  return {fault, ""};
}

}  // namespace

int run_program(const char* name, const std::function<int(StopSignal&)>& body) {
  StopSignal stop;
  try {
    return body(stop);
  } catch (const DdsError& error) {
    return last_words(name, error, kDdsFailed);
  } catch (const RecordError& error) {
    return last_words(name, error, kIncomplete);
  } catch (const std::exception& error) {
    return last_words(name, error, kFailed);
  }
}

std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  app.set_version_flag("--version", std::string("clearance ") + kBuild);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // A mistyped option is often why something else is missing.
    const std::vector<std::string> unknown = app.remaining(true);
    if (!unknown.empty()) std::fprintf(stderr, "%s\n", CLI::ExtrasError("", unknown).what());
    app.exit(error);
    return kUsage;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kUsage;
  }
  return std::nullopt;
}

std::optional<Scene> scene_or_errors(CellResult cell) {
  if (Scene* const scene = std::get_if<Scene>(&cell)) return std::move(*scene);
  const auto& errors = std::get<std::vector<CellError>>(cell);
  for (const CellError& error : errors) std::fprintf(stderr, "%s\n", error.text.c_str());
  std::fprintf(stderr, "%zu error%s\n", errors.size(), errors.size() == 1 ? "" : "s");
  return std::nullopt;
}

CLI::Validator finite_number() {
  return number([](double value) { return std::isfinite(value); }, "a finite number");
}
CLI::Validator positive_number() {
  return number([](double value) { return std::isfinite(value) && value > 0.0; },
                "a number above 0");
}
CLI::Validator number_from_zero() {
  return number([](double value) { return std::isfinite(value) && value >= 0.0; },
                "a number, 0 or more");
}

CLI::Validator whole_number(std::int64_t smallest, std::int64_t largest) {
  const auto fault = [=](const std::string& text) {
    std::int64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, value);
    const bool whole = read.ec == std::errc{} && read.ptr == end;
    if (whole && value >= smallest && value <= largest) return std::string();
    return "found '" + text + "'; expected a whole number from " + std::to_string(smallest) +
           " to " + std::to_string(largest);
  };
  return {fault, ""};
}

bool output_is_not_an_input(const char* program, const std::filesystem::path& output,
                            std::initializer_list<std::filesystem::path> inputs) {
  std::error_code not_there;
  for (const std::filesystem::path& input : inputs) {
    if (!std::filesystem::equivalent(output, input, not_there)) continue;
    std::fprintf(stderr, "%s: %s is a file that is read; expected another one to write\n", program,
                 output.c_str());
    return false;
  }
  return true;
}

void add_force(CLI::App& app, bool& force) {
  app.add_flag("--force", force, "Write over files that are there already");
}

bool can_create(const char* program, const std::filesystem::path& file, bool force) {
  std::error_code unknown;
  if (file.has_parent_path() && !std::filesystem::exists(file.parent_path(), unknown)) {
    std::fprintf(stderr, "%s: cannot create %s: there is no folder %s\n", program, file.c_str(),
                 file.parent_path().c_str());
    return false;
  }
  if (force || file.empty() || !std::filesystem::exists(file, unknown)) return true;
  std::fprintf(stderr, "%s: %s is there already; --force writes over it\n", program, file.c_str());
  return false;
}

void remove_unfinished(const char* program, const std::filesystem::path& file) {
  std::error_code failed;
  const bool regular =
      std::filesystem::is_regular_file(std::filesystem::symlink_status(file, failed));
  const bool removed = regular && std::filesystem::remove(file, failed);
  std::fprintf(stderr, "%s: %s was not finished%s\n", program, file.c_str(),
               removed ? " and is removed" : "; what is in it is not all");
}

}  // namespace clearance
