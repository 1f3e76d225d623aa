// The command line of a program as a table: name, variable, help and check of each option. Only
// command_line.cpp knows the library that parses it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace clearance {

// A condition on the text of a value.
struct Check {
  std::function<std::string(const std::string&)> fault;  // what is wrong; empty: nothing
  std::string shown = {};                                // in --help, after the value's type
};

using Packages = std::vector<std::pair<std::string, std::filesystem::path>>;

// What an option sets. A bool makes it a flag. Of a vector, each use of the option adds one value.
using OptionVariable =
    std::variant<bool*, int*, unsigned*, std::uint16_t*, std::int64_t*, std::uint64_t*, double*,
                 std::string*, std::filesystem::path*, std::optional<int>*,
                 std::optional<unsigned>*, std::optional<double>*, std::optional<std::string>*,
                 std::vector<double>*, std::vector<std::string>*,
                 std::vector<std::filesystem::path>*, Packages*>;

// Other options are those of the same command.
struct OptionRule {
  bool required = false;
  bool shows_default = false;                   // the variable's present value, in --help
  bool takes_all = false;                       // of a vector: all words up to the next option
  std::vector<std::string> needs = {};          // other options
  std::vector<std::string> excludes = {};       // other options
  std::string group = {};                       // its heading in --help
  std::string value_name = {};                  // in --help, in place of the type
  std::optional<std::string> value_alone = {};  // the value if none is given
};

// Rules that state only this.
[[nodiscard]] inline OptionRule required() { return {.required = true}; }
[[nodiscard]] inline OptionRule shown() { return {.shows_default = true}; }
[[nodiscard]] inline OptionRule needing(std::string other) { return {.needs = {std::move(other)}}; }
[[nodiscard]] inline OptionRule excluding(std::string other) {
  return {.excludes = {std::move(other)}};
}

struct Option {
  Option(std::string its_name, OptionVariable sets, std::string text, Check its_check = {},
         OptionRule its_rule = {})
      : name(std::move(its_name)),
        variable(sets),
        help(std::move(text)),
        check(std::move(its_check)),
        rule(std::move(its_rule)) {}
  Option(std::string its_name, OptionVariable sets, std::string text, OptionRule its_rule)
      : Option(std::move(its_name), sets, std::move(text), Check{}, std::move(its_rule)) {}

  std::string name;  // "--force", "-o,--output", or "CELL" for a positional argument
  OptionVariable variable;
  std::string help;
  Check check;
  OptionRule rule;
};

// A program, or one of its subcommands. Variables must outlive it.
struct CommandLine {
  std::string about;
  std::string footer = {};
  std::string name = {};  // of a subcommand
  std::vector<Option> options = {};
  std::vector<Option> one_of = {};            // options of which exactly one is required
  std::vector<CommandLine> subcommands = {};  // if there are any, one of them is required
  std::string chosen = {};                    // the name of the subcommand that was given

  void add(std::vector<Option> more);
};

// Adds --help and --version, and sets the variables. Returns an exit code when nothing remains to
// be done: --help, --version or wrong usage.
[[nodiscard]] std::optional<int> parse(CommandLine& line, int argc, char** argv);

}  // namespace clearance
