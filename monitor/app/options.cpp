// The messages of checks read "found ...; expected ...", like those about cell files.
#include "monitor/app/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/text/sentences.hpp"

namespace clearance {
namespace {

// Returns nothing for a text that is no number as a whole.
template <class Number>
std::optional<Number> read_as(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  return read.ec == std::errc{} && read.ptr == end ? std::optional(value) : std::nullopt;
}

// CLI11 would convert more ("0x10", " 7"); numbers are decimal here, such as "1e3".
template <class Accepts>
Check number(const std::string& expected, Accepts accepts, const std::string& shown = "") {
  return expecting(
      expected,
      [accepts](const std::string& text) {
        const bool has_plus = text.starts_with("+") && !text.starts_with("+-");
        const auto value = read_as<double>(std::string_view(text).substr(has_plus ? 1 : 0));
        return value && std::isfinite(*value) && accepts(*value);
      },
      shown);
}

}  // namespace

Check expecting(const std::string& expected, std::function<bool(const std::string&)> accepts,
                const std::string& shown) {
  return {[expected, accepts = std::move(accepts)](const std::string& text) {
            return accepts(text) ? "" : fmt::format("found '{}'; expected {}", text, expected);
          },
          shown};
}

Check finite_number() {
  return number("a finite number", [](double) { return true; });
}
Check positive_number() {
  return number("a number above 0", [](double value) { return value > 0.0; });
}
Check number_from_zero() {
  return number("a number, 0 or more", [](double value) { return value >= 0.0; });
}
Check number_in(double smallest, double largest) {
  return number(
      fmt::format("a number from {:g} to {:g}", smallest, largest),
      [=](double value) { return smallest <= value && value <= largest; },
      fmt::format("FLOAT in [{:g} - {:g}]", smallest, largest));
}

// This is stricter than CLI11: "1e3", "0x10" and " 7" are no whole numbers here.
Check whole_number(std::int64_t smallest, std::int64_t largest) {
  return expecting(fmt::format("a whole number from {} to {}", smallest, largest),
                   [=](const std::string& text) {
                     const auto value = read_as<std::int64_t>(text);
                     return value && *value >= smallest && *value <= largest;
                   });
}
Check whole_number_in(std::int64_t smallest, std::int64_t largest) {
  return {whole_number(smallest, largest).fault,
          fmt::format("INT in [{} - {}]", smallest, largest)};
}

Check one_word_of(const std::vector<std::string>& words) {
  return expecting(
      one_of(words),
      [words](const std::string& text) { return std::ranges::find(words, text) != words.end(); },
      fmt::format("{{{}}}", fmt::join(words, ",")));
}

Check existing_file() {
  return expecting(
      "a file that exists",
      [](const std::string& text) {
        std::error_code missing;
        return std::filesystem::exists(text, missing) &&
               !std::filesystem::is_directory(text, missing);
      },
      "FILE");
}

Option packages_option(Packages& packages, std::vector<std::string> excludes) {
  const auto is_complete = [](const std::string& text) {
    const std::size_t equals = text.find('=');
    return equals != std::string::npos && equals > 0 && equals + 1 < text.size();
  };
  return {"--package",
          &packages,
          "NAME=DIRECTORY of a package:// that the URDF names; repeatable",
          expecting("NAME=DIRECTORY", is_complete),
          {.excludes = std::move(excludes)}};
}

Option force_option(bool& force) { return {"--force", &force, "Overwrite files that exist"}; }

// spdlog's names of its levels.
Option log_level_option(std::string& level) {
  return {"--log-level", &level, "trace, debug, info, warn, error or off",
          one_word_of({"trace", "debug", "info", "warn", "error", "off"}), shown()};
}

}  // namespace clearance
