#include "tools/scene/send.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <optional>
#include <thread>
#include <utility>
#include <variant>

#include "config/edit/change_reader.hpp"
#include "config/text/file_bytes.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/client/client.hpp"
#include "monitor/client/commands.hpp"
#include "monitor/dds/dds_log.hpp"

namespace clearance {
namespace {

// Commands that are repeated wait so long at most, by parts that cover the interval evenly.
constexpr std::chrono::duration<double, std::milli> kLongestWait{4.0};
constexpr double kGoldenRatio = 0.6180339887498949;

constexpr const char* kSendFooter =
    R"(Changes are a YAML list; idl/COMMANDS.md has them all. Lengths are in m and angles in rad, unless the file is a map
that states units. An entry of objects, as in add_object, is in the units of the cell in any case:
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
  clearance-scene send --change 'read_cell_again: {}' --dry-run
  clearance-scene send attach.yaml --back detach.yaml --repeat 1000)";

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
    const bool is_stranger = result.status == CommandStatus::kNotNamed;
    print(stderr, "refused ({}): {}{}{}{}\n", name_of(result.status), result.path,
          result.path.empty() ? "" : ": ", result.reason,
          is_stranger ? ". --as NAME sends under another name" : "");
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
  if (!result.reason.empty()) print(stderr, "but {}\n", result.reason);
  return kOk;
}

// The time from each command to the first report that holds it.
class Latencies {
 public:
  Latencies(client::Connection& connection, client::Commands& commands,
            std::chrono::nanoseconds timeout)
      : commands_(commands), reports_(connection, {.depth = 256}), timeout_(timeout) {}

  // Returns the daemon's refusal, or a result without a status other than done. Nothing when no
  // result or report came in time.
  std::optional<CommandResult> send(const std::vector<CellChange>& changes,
                                    const client::CommandOptions& options, std::size_t list) {
    while (reports_.next()) {
    }
    const std::int64_t began_ns = client::now_ns();
    auto result = commands_.send(changes, options, timeout_);
    if (!result || !result->done()) return result;
    const std::int64_t answered_ns = client::now_ns();
    while (reports_->cycle < result->in_force_from) {
      if (!reports_.next(timeout_)) return std::nullopt;
    }
    // A report that came before the result waits, and has its time of publishing.
    const std::int64_t held_ns =
        std::min(client::now_ns(), std::max(began_ns, reports_->publish_ns));
    in_force_[list].push_back(1e-6 * static_cast<double>(held_ns - began_ns));
    answered_[list].push_back(1e-6 * static_cast<double>(answered_ns - began_ns));
    return result;
  }

  void print_table() {
    print(stdout, "{:<10} {:>8}  {:>32}  {:>32}\n", "", "", "first report ms, p50 / p99.9 / max",
          "result ms, p50 / p99.9 / max");
    constexpr const char* kNames[] = {"CHANGES", "BACK"};
    for (std::size_t list = 0; list < 2; ++list) {
      std::sort(in_force_[list].begin(), in_force_[list].end());
      std::sort(answered_[list].begin(), answered_[list].end());
      print(stdout, "{:<10} {:>8}  {:>32}  {:>32}\n", kNames[list], in_force_[list].size(),
            percentiles(in_force_[list]), percentiles(answered_[list]));
    }
  }

 private:
  static std::string percentiles(const std::vector<double>& sorted) {
    if (sorted.empty()) return "none";
    const auto at = [&](double share) {
      const auto count = static_cast<double>(sorted.size());
      return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(share * count))];
    };
    return fmt::format("{:.2f} / {:.2f} / {:.2f}", at(0.5), at(0.999), sorted.back());
  }

  client::Commands& commands_;
  client::Reports reports_;
  std::chrono::nanoseconds timeout_;
  std::array<std::vector<double>, 2> in_force_, answered_;  // ms
};

int no_result(const SendArguments& arguments, const Topics& topics,
              const client::Connection& connection, const client::Commands& commands) {
  if (commands.is_heard()) {
    print(stderr, "clearance-scene: no result came within {} s; the changes may be made or not\n",
          arguments.timeout_s);
  } else {
    print(stderr,
          "clearance-scene: no daemon takes commands on {} ({}); a cell allows them with "
          "'commands: {{from: [{}]}}', and clearanced with --commands {}\n",
          connection.where(), topics.commands, arguments.client, arguments.client);
  }
  return kDdsFailed;
}

}  // namespace

CommandLine send_line(SendArguments& arguments) {
  CommandLine line{.about = "Change the scene of a running daemon, and print its answer",
                   .footer = kSendFooter,
                   .name = "send"};
  line.add({
      {"CHANGES", &arguments.changes, "A file with changes (YAML); -: stdin"},
      {"--change", &arguments.change, "A change in YAML, after those of CHANGES; repeatable"},
      {"--as", &arguments.client,
       "Name of this client: one that the daemon's cell names under 'commands'", shown()},
      {"--file", &arguments.files,
       "Send this file along; changes name it as \"sent:NAME\"; repeatable", existing_file()},
      {"--timeout", &arguments.timeout_s, "Wait for each result for this time, s",
       positive_number(), shown()},
      {"--cell", &arguments.cell,
       "A cell file, which names domain, partition, interface and topics"},
      {"--dry-run", &arguments.dry_run, "Only ask whether the changes would be accepted"},
      {"--back", &arguments.back, "A file with changes that take those of CHANGES back"},
      {"--repeat", &arguments.repeats,
       "Send CHANGES and BACK in turns, this often, and print the time until the first report that "
       "holds them",
       whole_number(1, 10'000'000), needing("--back")},
  });
  arguments.dds.add_to(line);
  return line;
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
  for (const std::filesystem::path& file : arguments.files) {
    auto bytes = text_of(file.string());
    if (!bytes) return kFailed;
    options.files.push_back({file.filename().string(), *std::move(bytes)});
  }

  const auto timeout = std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(arguments.timeout_s));
  const auto cell = cell_of_topics(arguments.cell);
  if (!cell) return kBadCell;
  client::Connection connection(arguments.dds.resolve(*cell), cell->topics);
  client::Commands commands(connection, arguments.client);
  if (arguments.repeats == 0) {
    const auto result = commands.send(changes, options, timeout);
    return result ? print_result(*result, arguments.dry_run)
                  : no_result(arguments, cell->topics, connection, commands);
  }
  std::vector<CellChange> back;
  const auto text = text_of(arguments.back);
  if (!text) return kFailed;
  if (const int failed = add_changes(*text, arguments.back, back); failed != kOk) return failed;
  Latencies latencies(connection, commands, timeout);
  for (std::uint64_t i = 0; i < 2 * arguments.repeats; ++i) {
    // A command that follows a report at once would always meet the ticks at the same time.
    std::this_thread::sleep_for(kLongestWait *
                                std::fmod(static_cast<double>(i) * kGoldenRatio, 1.0));
    const auto result = latencies.send(i % 2 == 0 ? changes : back, options, i % 2);
    if (!result) return no_result(arguments, cell->topics, connection, commands);
    if (!result->done()) return print_result(*result, false);
  }
  latencies.print_table();
  return kOk;
}

}  // namespace clearance
