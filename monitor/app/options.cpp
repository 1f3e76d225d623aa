// Wraps conditions in CLI11 validators. Their messages read "found ...; expected ...", like those
// about cell files.
#include "monitor/app/options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace clearance {
namespace {

// The form of every message about an option.
std::string unexpected(const std::string& found, const std::string& expected) {
  return fmt::format("found '{}'; expected {}", found, expected);
}

// CLI11 would convert more ("0x10", " 7"); numbers are decimal here, such as "1e3".
CLI::Validator number(bool (*accepts)(double), const char* expected) {
  const auto fault = [accepts, expected](const std::string& text) {
    double value = 0.0;
    const char* const begin =
        text.data() + (text.starts_with("+") && !text.starts_with("+-") ? 1 : 0);
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(begin, end, value);
    const bool whole = read.ec == std::errc{} && read.ptr == end;
    return whole && accepts(value) ? std::string() : unexpected(text, expected);
  };
  return {fault, ""};
}

}  // namespace

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

// This is stricter than CLI11: "1e3", "0x10" and " 7" are no whole numbers here.
CLI::Validator whole_number(std::int64_t smallest, std::int64_t largest) {
  const auto fault = [=](const std::string& text) {
    std::int64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, value);
    const bool whole = read.ec == std::errc{} && read.ptr == end;
    if (whole && value >= smallest && value <= largest) return std::string();
    return unexpected(text, fmt::format("a whole number from {} to {}", smallest, largest));
  };
  return {fault, ""};
}

CLI::Option* add_packages(CLI::App& app,
                          std::vector<std::pair<std::string, std::filesystem::path>>& packages) {
  const auto fault = [](const std::string& text) {
    const std::size_t equals = text.find('=');
    const bool is_complete = equals != std::string::npos && equals > 0 && equals + 1 < text.size();
    return is_complete ? std::string() : unexpected(text, "NAME=DIRECTORY");
  };
  const auto add = [&packages](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      const std::size_t equals = text.find('=');
      packages.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
  };
  return app
      .add_option_function<std::vector<std::string>>(
          "--package", add, "NAME=DIRECTORY of a package:// that the URDF names; repeatable")
      ->allow_extra_args(false)
      ->check(fault);
}

// One wording for all programs.
void add_force(CLI::App& app, bool& force) {
  app.add_flag("--force", force, "Overwrite files that exist");
}

// spdlog's names of its levels.
void add_log_level(CLI::App& app, std::string& level) {
  app.add_option("--log-level", level, "trace, debug, info, warn, error or off")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
}

}  // namespace clearance
