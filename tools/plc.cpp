// clearance-plc: tells programmable logic controllers what the daemon reports, as registers of
// Modbus TCP and as topics of MQTT.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "monitor/app/cell_arguments.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/interface/plc_log_lines.hpp"
#include "monitor/loop/realtime.hpp"
#include "tools/plc/modbus_server.hpp"
#include "tools/plc/mqtt_publisher.hpp"
#include "tools/plc/register_table.hpp"
#include "tools/plc/report_figures.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter =
    R"(Every figure that is not known is fail-safe: 0 of all but signed lengths. So are all of them in the first
period without a good, fresh report, and the heartbeat stands still.

Exit status:
  0  stopped by SIGINT, SIGTERM, SIGHUP or --seconds
  1  the port cannot be used, a file of the section `mqtt` cannot be read, or something else failed
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined

Examples:
  clearance-plc cell.yaml --describe
  clearance-plc cell.yaml)";

struct Arguments {
  CellArguments cell;
  bool describe = false;
  std::optional<unsigned> port;
  double seconds = 0.0;
  int fifo_priority = 0;
  std::string log_level = "info";
  DdsArguments dds;
};

void add_options(CommandLine& line, Arguments& arguments) {
  line.add({
      {"CELL", &arguments.cell.cell, "The cell file (YAML), whose section `plc` maps the registers",
       required()},
      {"--describe", &arguments.describe, "Print the table of registers, and end"},
      {"--port", &arguments.port,
       "Serve Modbus TCP on this port instead of the cell's; 0: a free one",
       whole_number_in(0, 65535)},
      {"--seconds", &arguments.seconds, "Stop after this time; 0: run until Ctrl-C",
       number_from_zero()},
      {"--priority", &arguments.fifo_priority, "Run under SCHED_FIFO with this priority",
       whole_number_in(1, 99)},
  });
  arguments.dds.add_to(line);
  line.add({log_level_option(arguments.log_level)});
}

// Logs what becomes of the figures, at most once per second. Each fail-safe phase is told, however
// short it was.
class FigureLog {
 public:
  void note(plc::Cause cause, std::int64_t now_ns) {
    constexpr std::int64_t kEveryNs = 1'000'000'000;
    if (cause != plc::Cause::kNone && last_ == plc::Cause::kNone) due_ = cause;
    last_ = cause;
    const plc::Cause next = cause == plc::Cause::kNone ? due_.value_or(cause) : cause;
    const bool is_news = due_ || next != told_;
    if (!is_news || (told_ && now_ns - told_ns_ < kEveryNs)) return;
    due_.reset();
    told_ = next;
    told_ns_ = now_ns;
    if (next == plc::Cause::kNone)
      log_line(lines::kPlcGood);
    else
      log_line(lines::kPlcFailSafe, plc::kCauses[static_cast<std::size_t>(next)]);
  }
  void note_misfits(const PlcSettings& settings, plc::RegisterTable& table) {
    for (const std::size_t row : table.new_misfits()) {
      if (std::ranges::find(misfits_, row) != misfits_.end()) continue;
      misfits_.push_back(row);
      log_line(lines::kPlcMisfit, plc::name(settings.rows[row]), settings.rows[row].width().key);
    }
  }

 private:
  std::optional<plc::Cause> last_, told_;
  std::optional<plc::Cause> due_;  // of a phase that was not told yet
  std::int64_t told_ns_ = 0;
  std::vector<std::size_t> misfits_;  // rows that were told
};

int run_plc(const Cell& cell, const Arguments& arguments, StopSignal& signal) {
  constexpr std::int64_t kLongestStepNs = 5'000'000;
  use_precise_timers();
  route_dds_log();
  if (arguments.fifo_priority > 0) {
    if (const Refusal refusal = use_fifo_scheduling(arguments.fifo_priority))
      log_line(lines::kSystemRefuses, *refusal);
  }
  plc::RegisterTable table(cell.plc);
  plc::ModbusServer modbus(cell.plc.modbus, table.words().size());
  client::Connection connection(arguments.dds.resolve(cell), cell.topics);
  plc::ReportFigures figures(connection, cell);
  std::optional<plc::MqttPublisher> mqtt;
  if (!cell.plc.mqtt.host.empty()) mqtt.emplace(cell.plc);
  log_line(lines::kPlcStarted, cell.scene.name, connection.where(), modbus.address(),
           1e-6 * static_cast<double>(cell.plc.period_ns));
  FigureLog log;
  const std::int64_t step_ns = std::min(cell.plc.period_ns / 4, kLongestStepNs);
  const std::int64_t started_ns = client::monotonic_ns();
  std::int64_t now_ns = started_ns;
  while (!signal.wait(0) && (arguments.seconds == 0.0 ||
                             1e-9 * static_cast<double>(now_ns - started_ns) < arguments.seconds)) {
    figures.update(now_ns);
    table.update(figures.held(), modbus.counts().refused_writes);
    modbus.set(table.words());
    if (mqtt) mqtt->publish(figures.held(), table, now_ns);
    log.note(figures.held().cause(), now_ns);
    log.note_misfits(cell.plc, table);
    modbus.serve_until(now_ns + step_ns);
    now_ns = client::monotonic_ns();
  }
  const plc::ModbusCounts& counts = modbus.counts();
  print(stdout,
        "{} requests answered, {} writes refused, {} clients dropped, {} turned away\n"
        "heartbeat {}, {}\n",
        counts.requests, counts.refused_writes, counts.dropped, counts.turned_away,
        figures.held().heartbeat(), plc::kCauses[static_cast<std::size_t>(figures.held().cause())]);
  return kOk;
}

int run(int argc, char** argv, StopSignal& signal) {
  CommandLine line{
      "Tells programmable logic controllers what clearanced reports, by Modbus TCP and MQTT.",
      kFooter};
  Arguments arguments;
  add_options(line, arguments);
  if (const auto done = parse(line, argc, argv)) return *done;
  start_log("clearance-plc", arguments.log_level);
  auto cell = cell_or_errors(arguments.cell.read());
  if (!cell) return kBadCell;
  if (arguments.describe) {
    print(stdout, "{}", plc::describe(cell->plc));
    return kOk;
  }
  if (arguments.port) cell->plc.modbus.port = static_cast<std::uint16_t>(*arguments.port);
  return run_plc(*cell, arguments, signal);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearance-plc", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::dds_exit_code);
}
