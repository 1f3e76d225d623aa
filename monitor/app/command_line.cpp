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

// Words beside the names of an option: its type, its default, what it needs and excludes.
std::string words_beside(const CLI::Option& option) {
  if (!option.get_option_text().empty()) return " " + option.get_option_text();
  std::string words;
  if (option.get_type_size() != 0) {
    if (!option.get_type_name().empty()) words += " " + option.get_type_name();
    if (!option.get_default_str().empty()) words += "=" + option.get_default_str();
    if (option.get_expected_max() == CLI::detail::expected_max_vector_size) {
      words += " ...";
    } else if (option.get_expected_min() > 1) {
      words += " x " + std::to_string(option.get_expected());
    }
    if (option.get_required()) words += " REQUIRED";
  }
  if (!option.get_needs().empty()) words += " Needs:";
  for (const CLI::Option* other : option.get_needs()) words += " " + other->get_name();
  if (!option.get_excludes().empty()) words += " Excludes:";
  for (const CLI::Option* other : option.get_excludes()) words += " " + other->get_name();
  return words;
}

// "[FILES...]".
std::string usage_of(const CLI::Option& positional) {
  std::string name = positional.get_name(true, false);
  if (positional.get_expected_max() >= CLI::detail::expected_max_vector_size) {
    name += "...";
  } else if (positional.get_expected_max() > 1) {
    name += "(" + std::to_string(positional.get_expected()) + "x)";
  }
  return positional.get_required() ? name : "[" + name + "]";
}

// A description stands beside its name, or on the next line if the name is too long.
std::string entry(const std::string& name, const std::string& description) {
  constexpr std::size_t kColumn = 30;
  std::string text = "  " + name;
  if (description.empty()) return text + "\n";
  text += text.size() < kColumn ? std::string(kColumn - text.size(), ' ')
                                : "\n" + std::string(kColumn, ' ');
  for (const char c : description) {
    text += c;
    if (c == '\n') text.append(kColumn, ' ');
  }
  return text + "\n";
}

std::string entries(const std::vector<const CLI::Option*>& options) {
  std::string text;
  for (const CLI::Option* option : options) {
    const bool is_positional = option->get_positional();
    text += entry(option->get_name(is_positional, !is_positional) + words_beside(*option),
                  option->get_description());
  }
  return text;
}

std::string usage(const CLI::App& app, const std::string& name) {
  std::string text = "Usage: " + name;
  for (const CLI::App* part : alternatives_of(app)) {
    std::string words;
    for (const CLI::Option* option : options_of(*part)) {
      words += (words.empty() ? "" : " | ") + word_for(*option);
    }
    text += " (" + words + ")";
  }
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) text += " " + usage_of(*option);
  }
  for (const CLI::Option* option : app.get_options()) {
    if (option->nonpositional() && option->get_required()) text += " " + word_for(*option);
  }
  const bool has_subcommands = !named_subcommands_of(app).empty();
  return text + (has_subcommands ? " SUBCOMMAND ...\n" : " [OPTIONS]\n");
}

// The text of --help, the same for every version of CLI11: what a command needs stands before what
// it can take. The usage line names required arguments before "[OPTIONS]". Groups of options that
// require exactly one of them, arguments and subcommands stand before options. In each list,
// required options come first, --help and --version last.
class HelpFormatter : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const override {
    std::string text = app->get_description();
    text += (text.empty() ? "" : "\n") + usage(*app, name);
    for (const CLI::App* part : alternatives_of(*app))
      text += "\n" + part->get_description() + ":\n" + entries(options_of(*part));
    const auto positionals =
        app->get_options([](const CLI::Option* option) { return option->get_positional(); });
    if (!positionals.empty()) text += "\nPositionals:\n" + entries(positionals);
    const std::vector<const CLI::App*> parts = named_subcommands_of(*app);
    if (!parts.empty()) text += "\nSubcommands (each has its own --help):\n";
    for (const CLI::App* part : parts) text += entry(part->get_name(), part->get_description());
    return text + groups(*app) + "\n" + (app->get_footer().empty() ? "" : app->get_footer() + "\n");
  }

 private:
  static std::string groups(const CLI::App& app) {
    const auto rank = [](const CLI::Option* option) {
      if (option->get_required()) return 0;
      return option->check_lname("help") || option->check_lname("version") ? 2 : 1;
    };
    std::string text;
    for (const std::string& group : app.get_groups()) {
      auto options = app.get_options([&group](const CLI::Option* option) {
        return option->get_group() == group && option->nonpositional();
      });
      if (group.empty() || options.empty()) continue;
      std::ranges::stable_sort(options, {}, rank);
      // CLI11 2.5 has other letters for its own group.
      text += (text.empty() ? "\n" : "\n\n") + (group == "OPTIONS" ? "Options" : group) + ":\n" +
              entries(options);
    }
    return text;
  }
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

// "--output", of an option that is named "-o,--output".
std::string long_name(const Option& option) {
  return option.name.substr(option.name.find(',') + 1);
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
    CLI::Option* const added = app.get_option(long_name(option));
    for (const auto& other : option.rule.needs) added->needs(app.get_option(other));
    for (const auto& other : option.rule.excludes) added->excludes(app.get_option(other));
  }
  for (const CommandLine& part : line.subcommands)
    build(*app.add_subcommand(part.name, part.about), part);
  if (!line.subcommands.empty()) app.require_subcommand(1);
  app.footer(line.footer);
}

// The first value that its option's check refuses, of a command and of its chosen subcommands.
// Since version 2.5, CLI11 looks for what is missing before it checks what is there.
std::optional<CLI::ValidationError> wrong_value(const CLI::App& app, const CommandLine& line) {
  for (const std::vector<Option>* options : {&line.one_of, &line.options}) {
    for (const Option& option : *options) {
      if (!option.check.fault) continue;
      const CLI::Option* const given = app.get_option(long_name(option));
      for (const std::string& text : given->results()) {
        const std::string fault = option.check.fault(text);
        if (!fault.empty()) return CLI::ValidationError(given->get_name(), fault);
      }
    }
  }
  for (const CommandLine& part : line.subcommands) {
    if (!app.got_subcommand(part.name)) continue;
    if (auto wrong = wrong_value(*app.get_subcommand(part.name), part)) return wrong;
  }
  return std::nullopt;
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
    // An option that there is not, or a value that was meant for another one, is often why
    // something is missing.
    const std::vector<std::string> unknown = app.remaining(true);
    if (!unknown.empty()) print(stderr, "{}\n", CLI::ExtrasError("", unknown).what());
    if (const auto wrong = wrong_value(app, line)) {
      say(app, *wrong);
    } else {
      say(app, error);
    }
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
