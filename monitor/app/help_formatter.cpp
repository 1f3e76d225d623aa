#include "monitor/app/help_formatter.hpp"

#include <algorithm>

namespace clearance {
namespace {

// CLI11 keeps an option group as a subcommand without a name.
std::vector<const CLI::App*> alternatives_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* part) { return part->get_name().empty(); });
}

std::vector<const CLI::App*> named_subcommands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* part) { return !part->get_name().empty(); });
}

// CLI11 gives each of them a --help of its own.
std::vector<const CLI::Option*> options_of(const CLI::App& alternatives) {
  return alternatives.get_options(
      [&alternatives](const CLI::Option* option) { return option != alternatives.get_help_ptr(); });
}

// "CELL", or "--urdf TEXT".
std::string word_for(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true, false);
  const std::string name = option.get_name();
  return option.get_type_size() == 0 ? name : name + " " + option.get_type_name();
}

}  // namespace

std::string HelpFormatter::make_usage(const CLI::App* app, std::string name) const {
  std::string usage = "Usage: " + name;
  for (const CLI::App* part : alternatives_of(*app)) {
    std::string words;
    for (const CLI::Option* option : options_of(*part)) {
      words += (words.empty() ? "" : " | ") + word_for(*option);
    }
    usage += " (" + words + ")";
  }
  for (const CLI::Option* option : app->get_options()) {
    if (option->get_positional()) usage += " " + make_option_usage(option);
  }
  for (const CLI::Option* option : app->get_options()) {
    if (option->nonpositional() && option->get_required()) usage += " " + word_for(*option);
  }
  const bool has_subcommands = !named_subcommands_of(*app).empty();
  return usage + (has_subcommands ? " SUBCOMMAND ...\n" : " [OPTIONS]\n");
}

std::string HelpFormatter::make_group(std::string group, bool is_positional,
                                      std::vector<const CLI::Option*> options) const {
  const auto rank = [](const CLI::Option* option) {
    if (option->get_required()) return 0;
    return option->check_lname("help") || option->check_lname("version") ? 2 : 1;
  };
  std::ranges::stable_sort(options, {}, rank);
  return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
}

std::string HelpFormatter::make_positionals(const CLI::App* app) const {
  std::string text;
  for (const CLI::App* part : alternatives_of(*app)) {
    text += "\n" + part->get_description() + ":\n";
    for (const CLI::Option* option : options_of(*part)) {
      text += make_option(option, option->get_positional());
    }
  }
  text += CLI::Formatter::make_positionals(app);
  const std::vector<const CLI::App*> parts = named_subcommands_of(*app);
  if (!parts.empty()) text += "\nSubcommands (each has its own --help):\n";
  for (const CLI::App* part : parts) text += make_subcommand(part);
  return text;
}

std::string HelpFormatter::make_subcommands(const CLI::App*, CLI::AppFormatMode) const {
  return "";
}

}  // namespace clearance
