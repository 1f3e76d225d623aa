#include "tools/scene/send.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>

#include "config/edit/change_reader.hpp"
#include "config/text/file_bytes.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/client/commands.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance {
namespace {

constexpr const char* kSendFooter =
    R"(Changes are a YAML list; idl/COMMANDS.md has them all. Lengths are in m and angles in rad, unless the file is a map:
  units: {length: mm, angle: deg}
  changes:
    - attach: {object: part, to: left_hand, touch: [left_finger]}
    - set_pair: {between: [part, bin], rule: publish}

Exit status:
  0  the changes are in force, or would be accepted (--dry-run)
  1  a file could not be read
  2  wrong usage
  3  the changes have errors (printed)
  4  DDS could not be joined, no daemon takes commands, or no result came
  6  the daemon refused the changes (its reason is printed)

Examples:
  clearance-scene send changes.yaml --as planner
  clearance-scene send --change 'attach: {object: part, to: left_hand}' --partition lab
  clearance-scene send --change 'read_cell_again: {}' --dry-run)";

std::string is_hexadecimal(const std::string& text) {
  const bool fits = !text.empty() && text.size() <= 16 &&
                    text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  return fits ? std::string()
              : fmt::format("found '{}'; expected a revision of 1 to 16 hexadecimal digits", text);
}

// Returns nothing after a message.
std::optional<std::string> text_of(const std::string& file) {
  if (file == "-") return std::string(std::istreambuf_iterator<char>(std::cin), {});
  auto read = read_bytes(file);
  if (auto* text = std::get_if<std::string>(&read)) return std::move(*text);
  print(stderr, "clearance-scene: {}\n", std::get<FileFault>(read).reason);
  return std::nullopt;
}

// Appends the changes of a text. Returns an exit code.
int add_changes(const std::string& text, const std::filesystem::path& file,
                std::vector<CellChange>& changes) {
  auto read = read_changes(text, file);
  if (const auto* errors = std::get_if<std::vector<CellError>>(&read)) {
    for (const CellError& error : *errors) print(stderr, "{}\n", error.text);
    return kBadCell;
  }
  for (CellChange& change : std::get<std::vector<CellChange>>(read))
    changes.push_back(std::move(change));
  return kOk;
}

int print_result(const CommandResult& result, bool dry_run) {
  if (!result.done()) {
    print(stderr, "refused ({}): {}{}{}\n", name_of(result.status), result.path,
          result.path.empty() ? "" : ": ", result.reason);
    return kRefused;
  }
  if (dry_run) {
    print(stdout, "would be accepted, as revision {:016x}\n", result.scene_revision);
  } else if (result.in_force_from == 0) {
    print(stdout, "nothing to change: revision {:016x} is in force\n", result.scene_revision);
  } else {
    print(stdout, "done: revision {:016x} is in force from cycle {}\n", result.scene_revision,
          result.in_force_from);
  }
  return kOk;
}

}  // namespace

CLI::App* add_send(CLI::App& app, SendArguments& arguments) {
  CLI::App* const send =
      app.add_subcommand("send", "Change the scene of a running daemon, and print its answer");
  send->add_option("CHANGES", arguments.changes, "A file with changes (YAML); -: stdin");
  send->add_option("--change", arguments.change,
                   "A change in YAML, after those of CHANGES; repeatable")
      ->allow_extra_args(false);
  send->add_option("--as", arguments.client,
                   "Name of this client: one that the daemon's cell names under 'commands'")
      ->capture_default_str();
  send->add_option("--file", arguments.files,
                   "Send this file along; changes name it as \"sent:NAME\"; repeatable")
      ->check(CLI::ExistingFile)
      ->allow_extra_args(false);
  send->add_option("--revision", arguments.revision,
                   "Refuse the changes unless this revision of the scene is in force")
      ->check(is_hexadecimal);
  send->add_flag("--dry-run", arguments.dry_run, "Only ask whether the changes would be accepted");
  send->add_option("--timeout", arguments.timeout_s, "Wait for a result for this time, s")
      ->check(positive_number())
      ->capture_default_str();
  for (const TopicKind kind : {TopicKind::kCommands, TopicKind::kCommandResults}) {
    const Topic& each = topic(kind);
    send->add_option(fmt::format("--{}", each.key), arguments.topics.*each.name, "Topic name")
        ->capture_default_str();
  }
  arguments.dds.add_to(*send, false);
  send->footer(kSendFooter);
  return send;
}

int send_changes(const SendArguments& arguments) {
  std::vector<CellChange> changes;
  if (!arguments.changes.empty()) {
    const auto text = text_of(arguments.changes);
    if (!text) return kFailed;
    if (const int failed = add_changes(*text, arguments.changes, changes); failed != kOk)
      return failed;
  }
  for (const std::string& change : arguments.change) {
    if (const int failed = add_changes(change, "--change", changes); failed != kOk) return failed;
  }
  if (changes.empty()) {
    print(stderr, "clearance-scene: found no changes; expected CHANGES or --change\n");
    return kUsage;
  }
  client::CommandOptions options{.dry_run = arguments.dry_run};
  if (!arguments.revision.empty()) {
    (void)std::from_chars(arguments.revision.data(),
                          arguments.revision.data() + arguments.revision.size(),
                          options.scene_revision, 16);
  }
  for (const std::filesystem::path& file : arguments.files) {
    auto bytes = text_of(file.string());
    if (!bytes) return kFailed;
    options.files.push_back({file.filename().string(), *std::move(bytes)});
  }

  client::Connection connection(arguments.dds.resolve(), arguments.topics);
  client::Commands commands(connection, arguments.client);
  const auto timeout = std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(arguments.timeout_s));
  if (const auto result = commands.send(changes, options, timeout))
    return print_result(*result, arguments.dry_run);
  if (commands.is_heard()) {
    print(stderr, "clearance-scene: no result came within {} s; the changes may be made or not\n",
          arguments.timeout_s);
  } else {
    print(stderr,
          "clearance-scene: no daemon takes commands on {} ({}); a cell allows them with "
          "'commands: {{from: [{}]}}', and clearanced with --commands {}\n",
          connection.where(), arguments.topics.commands, arguments.client, arguments.client);
  }
  return kDdsFailed;
}

}  // namespace clearance
