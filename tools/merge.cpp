// clearance-merge: joins the shares of a cell, and publishes the whole cell on its own topics for
// readers that know nothing of shares.
#include <chrono>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "monitor/app/cell_arguments.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/ros_outputs.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/client/shared_cell.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/interface/merge_log_lines.hpp"
#include "monitor/loop/realtime.hpp"
#include "tools/merge/command_relay.hpp"
#include "tools/merge/joined_writer.hpp"
#include "tools/merge/ros_relay.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter =
    R"(Whatever hangs on a share that is not heard is unknown, and its zones are active.

Exit status:
  0  stopped by SIGINT, SIGTERM, SIGHUP or --seconds
  1  something else failed
  2  wrong usage
  3  the cell file is wrong, or has no shares
  4  DDS could not be joined, or another program publishes this cell already

Example:
  clearanced hall.yaml --share north &
  clearanced hall.yaml --share south &
  clearance-merge hall.yaml)";

struct Arguments {
  CellArguments cell;
  std::optional<double> late_ms;
  double seconds = 0.0;
  int fifo_priority = 0;
  std::vector<std::string> ros;  // ROS 2 outputs in addition to the cell's
  std::string log_level = "info";
  DdsArguments dds;
};

void add_options(CommandLine& line, Arguments& arguments) {
  line.add({
      {"CELL", &arguments.cell.cell, "The cell file (YAML), which names the shares", required()},
      {"--late-ms", &arguments.late_ms,
       "What hangs on a share whose last report is older than this is unknown (default: three "
       "periods of the cell, and at least 20)",
       number_in(1.0, 10'000.0)},
      {"--seconds", &arguments.seconds, "Stop after this time; 0: run until Ctrl-C",
       number_from_zero()},
      {"--priority", &arguments.fifo_priority, "Run under SCHED_FIFO with this priority",
       whole_number_in(1, 99)},
      ros_outputs_option(arguments.ros),
  });
  arguments.dds.add_to(line);
  line.add({log_level_option(arguments.log_level)});
}

// Logs what becomes of each share, once per change.
class ShareLog {
 public:
  void note(const client::SharedCell& whole) {
    for (const client::ShareCheck& check : whole.shares()) {
      const auto [at, is_new] = states_.emplace(check.name, check.state);
      if (!is_new && at->second == check.state) continue;
      at->second = check.state;
      tell(check, whole->scene_revision);
    }
  }

 private:
  static void tell(const client::ShareCheck& check, std::uint64_t revision) {
    switch (check.state) {
      case client::ShareState::kWhole:
        return log_line(lines::kShareHeard, check.name, check.scene_revision);
      case client::ShareState::kMissing:
        return log_line(lines::kShareMissing, check.name);
      case client::ShareState::kLate:
        return log_line(lines::kShareLate, check.name, 1e-6 * static_cast<double>(check.age_ns));
      case client::ShareState::kOtherRevision:
        return log_line(lines::kShareOtherRevision, check.name, check.scene_revision, revision);
      case client::ShareState::kOtherDivision:
        return log_line(lines::kShareOtherDivision, check.name);
      case client::ShareState::kHeld:
        return log_line(lines::kShareHeld, check.name);
    }
  }

  std::map<std::string, client::ShareState> states_;
};

int run_merge(Cell cell, const Arguments& arguments, StopSignal& signal) {
  use_precise_timers();
  route_dds_log();
  if (arguments.fifo_priority > 0) {
    if (const Refusal refusal = use_fifo_scheduling(arguments.fifo_priority))
      log_line(lines::kSystemRefuses, *refusal);
  }
  add_asked(arguments.ros, cell.ros.outputs);
  const DdsOptions dds = arguments.dds.resolve(cell);
  if (!dds.partition.empty() && (writes_ros(cell) || !cell.ros.outputs.messages.empty()))
    log_line(lines::kPartitionWithoutRos, dds.partition);
  client::Connection connection(dds, cell.topics);
  client::SharedCellOptions options{.gradients = true};
  if (arguments.late_ms)
    options.late_after = std::chrono::nanoseconds(std::llround(1e6 * *arguments.late_ms));
  for (const Share& share : cell.shares.all) options.names.push_back(share.name);
  client::SharedCell whole(connection, options);
  merge::RosRelay ros(connection.participant(), cell, arguments.cell.reading(), arguments.ros);
  merge::JoinedWriter writer(
      connection.participant(), cell, whole.daemon(),
      [&ros](Sample<clearance_msg_Health> health) { ros.tell(std::move(health)); });
  merge::CommandRelay commands(connection, cell, whole.daemon());
  log_line(lines::kMergeStarted, cell.scene.name, cell.shares.all.size(), connection.where());
  ShareLog log;
  const std::int64_t started = client::monotonic_ns();
  const auto is_over = [&] {
    return arguments.seconds > 0.0 &&
           1e-9 * static_cast<double>(client::monotonic_ns() - started) >= arguments.seconds;
  };
  while (!signal.wait(0) && !is_over()) {
    if (!whole.next(std::chrono::milliseconds(20))) continue;
    writer.write(whole);
    commands.note(whole);
    log.note(whole);
    if (writer.yields()) return kDdsFailed;
    ros.write(whole);
  }
  print(stdout, "{}\n", writer.summary(whole));
  return kOk;
}

int run(int argc, char** argv, StopSignal& signal) {
  CommandLine line{
      "Joins the shares of a cell that several daemons watch, and publishes the whole cell.",
      kFooter};
  Arguments arguments;
  add_options(line, arguments);
  if (const auto done = parse(line, argc, argv)) return *done;
  start_log("clearance-merge", arguments.log_level);
  auto cell = cell_or_errors(arguments.cell.read());
  if (!cell) return kBadCell;
  if (cell->shares.all.empty()) {
    print(stderr, "clearance-merge: {} has no 'shares': a daemon of its own watches it whole\n",
          arguments.cell.name());
    return kBadCell;
  }
  return run_merge(*std::move(cell), arguments, signal);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearance-merge", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::dds_exit_code);
}
