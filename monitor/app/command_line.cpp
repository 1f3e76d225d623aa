// Translates tables of options for CLI11, and its messages and exit codes into ours.
#include "monitor/app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>
#include <sstream>
#include <type_traits>

#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/files/build_info.hpp"

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

// The text of --help: what a command needs stands before what it can take. Differs from CLI11's
// formatter in three respects. The usage line names required arguments before "[OPTIONS]".
// Arguments, groups of options that require exactly one of them, and subcommands stand before
// options. In each list, required options come first, --help and --version last.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* app, std::string name) const override {
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

  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    const auto rank = [](const CLI::Option* option) {
      if (option->get_required()) return 0;
      return option->check_lname("help") || option->check_lname("version") ? 2 : 1;
    };
    std::ranges::stable_sort(options, {}, rank);
    return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
  }

  // The alternatives, then positional arguments, then subcommands that have a name.
  std::string make_positionals(const CLI::App* app) const override {
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

  // Nothing: make_positionals() has them.
  std::string make_subcommands(const CLI::App*, CLI::AppFormatMode) const override { return ""; }
};

void add_packages(Packages& packages, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    packages.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
}

CLI::Option* add_variable(CLI::App& app, const Option& option) {
  return std::visit(
      [&](auto* variable) -> CLI::Option* {
        using Type = std::remove_pointer_t<decltype(variable)>;
        if constexpr (std::is_same_v<Type, bool>) {
          return app.add_flag(option.name, *variable, option.help);
        } else if constexpr (std::is_same_v<Type, Packages>) {
          return app.add_option_function<std::vector<std::string>>(
              option.name, [variable](const auto& texts) { add_packages(*variable, texts); },
              option.help);
        } else {
          return app.add_option(option.name, *variable, option.help);
        }
      },
      option.variable);
}

// Other options are named by the rule, and may not be there yet.
void add_option(CLI::App& app, const Option& option) {
  CLI::Option* const added = add_variable(app, option);
  const OptionRule& rule = option.rule;
  if (added->get_expected_max() > 1 && !added->get_positional())
    added->allow_extra_args(rule.takes_all);
  added->required(rule.required);
  if (option.check.fault) added->check(CLI::Validator(option.check.fault, option.check.shown));
  if (rule.shows_default) added->capture_default_str();
  if (!rule.group.empty()) added->group(rule.group);
  if (rule.value_alone) {
    added->expected(0, 1)->default_str(*rule.value_alone)->option_text(rule.value_name);
  } else if (!rule.value_name.empty()) {
    added->type_name(rule.value_name);
  }
}

// Variables are set only by what was given, so a subcommand that was not chosen sets none.
void build(CLI::App& app, const CommandLine& line) {
  if (!line.one_of.empty()) {
    CLI::App* const one_of = app.add_option_group("cell", "One of");
    for (const Option& option : line.one_of) add_option(*one_of, option);
    one_of->require_option(1);
  }
  for (const Option& option : line.options) add_option(app, option);
  for (const Option& option : line.options) {
    const auto name = option.name.substr(option.name.find(',') + 1);
    for (const auto& other : option.rule.needs) app.get_option(name)->needs(app.get_option(other));
    for (const auto& other : option.rule.excludes)
      app.get_option(name)->excludes(app.get_option(other));
  }
  for (const CommandLine& part : line.subcommands)
    build(*app.add_subcommand(part.name, part.about), part);
  if (!line.subcommands.empty()) app.require_subcommand(1);
  app.footer(line.footer);
}

// Prints CLI11's message through print().
int say(const CLI::App& app, const CLI::Error& error) {
  std::ostringstream out, err;
  const int status = app.exit(error, out, err);
  print(stdout, "{}", out.str());
  print(stderr, "{}", err.str());
  return status;
}

}  // namespace

void CommandLine::add(std::vector<Option> more) {
  std::ranges::move(more, std::back_inserter(options));
}

// CLI11 has an exit code for each mistake; here all of them are kUsage.
std::optional<int> parse(CommandLine& line, int argc, char** argv) {
  CLI::App app(line.about, std::filesystem::path(argv[0]).filename());
  app.formatter(std::make_shared<HelpFormatter>());
  build(app, line);
  app.set_version_flag("--version", std::string("clearance ") + kBuild);
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
  for (const CommandLine& part : line.subcommands) {
    if (app.got_subcommand(part.name)) line.chosen = part.name;
  }
  return std::nullopt;
}

}  // namespace clearance
