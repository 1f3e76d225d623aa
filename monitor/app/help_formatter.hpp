// The text of --help: what a command needs stands before what it can take.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace clearance {

// Differs from CLI11's formatter in three respects. The usage line names required arguments before
// "[OPTIONS]". Arguments, groups of options that require exactly one of them, and subcommands
// stand before options. In each list, required options come first, --help and --version last.
class HelpFormatter : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_usage(const CLI::App* app, std::string name) const override;
  [[nodiscard]] std::string make_group(std::string group, bool is_positional,
                                       std::vector<const CLI::Option*> options) const override;
  // The alternatives, then positional arguments, then subcommands that have a name.
  [[nodiscard]] std::string make_positionals(const CLI::App* app) const override;
  // Nothing: make_positionals() has them.
  [[nodiscard]] std::string make_subcommands(const CLI::App* app,
                                             CLI::AppFormatMode mode) const override;
};

}  // namespace clearance
