// clearanced: reads a cell, then publishes its distances at a fixed rate until it is told to stop.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "config/cell/error_reader.hpp"
#include "config/cell/partner_reader.hpp"
#include "config/scene/refresh_share.hpp"
#include "config/text/sentences.hpp"
#include "monitor/app/cell_arguments.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/ros_outputs.hpp"
#include "monitor/daemon/daemon.hpp"
#include "monitor/daemon/recording_arguments.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/dds/robot_description.hpp"
#include "monitor/publish/metrics_server.hpp"
#include "monitor/publish/metrics_text.hpp"
#include "monitor/requests/kept_scene.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  stopped by SIGINT, SIGTERM or --ticks; or --check found nothing wrong. SIGHUP reads the cell again
  1  something else failed, or --check was stopped before its end
  2  wrong usage
  3  the cell file is wrong, or it has changed since the scene of --keep-scene was kept
  4  DDS could not be joined, or another daemon publishes this cell already
  5  the recording or the log of interventions could not be begun (no folder, no permission, no regular file), or is
     incomplete at the end (deleted, moved or changed by another program, or a disk that is full or too slow); the ticks
     continue
  7  a bit of the memory that no tick changes has flipped: the log names the table

Example:
  clearanced config/cells/two_arms.yaml --partition lab --priority 80
  clearanced config/cells/two_arms.yaml --record run.mcap --record-around 10 --record-keep-mb 2000
  clearanced config/cells/two_arms.yaml --commands planner --keep-scene scene.yaml
  clearanced config/cells/two_arms.yaml --partner left
  clearanced hall.yaml --share north
  clearanced --urdf panda.urdf --srdf panda.srdf --interface default --ros2 markers)";

// The command line, with its defaults.
struct Arguments {
  CellArguments cell;
  bool check = false;
  std::string log_level = "info";
  DdsArguments dds;
  bool record_over = false;  // replace existing files
  RecordingArguments recording;
  bool gradients = false;
  bool use_sim_time = false;
  std::vector<std::string> ros;        // ROS 2 outputs in addition to the cell's
  std::vector<std::string> commands;   // clients in addition to the cell's
  std::vector<std::string> questions;  // likewise
  RosTrajectories trajectories{.topics = {}, .margins = {}};
  std::filesystem::path metrics;     // a socket; empty: none
  std::filesystem::path histograms;  // a file; empty: none
  std::int64_t ahead_us = 0;
  std::filesystem::path interventions;  // a file; empty: none
  DaemonOptions daemon;
};

// A source of commands or questions.
Check client_name() {
  return expecting(
      fmt::format("the name of a client with 1 to {} bytes", kMaxSourceLength),
      [](const std::string& text) { return !text.empty() && text.size() <= kMaxSourceLength; });
}

Check ros_topic() {
  return expecting("a topic like /arm/joint_trajectory", [](const std::string& text) {
    return text.size() > 1 && text.front() == '/' && text.back() != '/';
  });
}

void add_inputs(CommandLine& line, Arguments& arguments) {
  line.add({
      {"--commands", &arguments.commands,
       "Take commands of this client too, which change the scene (idl/COMMANDS.md); repeatable",
       client_name()},
      {"--questions", &arguments.questions,
       "Answer questions of this client too, about motions before they are made "
       "(idl/QUESTIONS.md); repeatable",
       client_name(), excluding("--share")},
      {"--ros2-trajectories", &arguments.trajectories.topics,
       "Ask about each trajectory_msgs/JointTrajectory on this ROS 2 topic too, and answer on "
       "/diagnostics and TOPIC/clearance (idl/ROS.md); repeatable",
       ros_topic(), excluding("--share")},
      {"--trajectory-margin", &arguments.trajectories.margins,
       "Margin for these in place of the cell's, m; 0 asks for contact; repeatable",
       number_from_zero()},
      {"--keep-scene", &arguments.daemon.commander.keep_scene,
       "Keep the changed scene in this file, and begin with it after a crash"},
      {"--partner", &arguments.daemon.partner,
       "Publish side by side with a second daemon of this cell, under this name "
       "(monitor/loop/PARTNERS.md); in place of the cell's 'partner'",
       expecting(
           fmt::format("a name of 1 to {} printable characters without blanks", kMaxSourceLength),
           is_partner_name)},
      {"--reload", &arguments.daemon.reload,
       "Read the cell again, as after SIGHUP, when its file or one that it names has changed"},
  });
}

void add_options(CommandLine& line, Arguments& arguments) {
  DaemonOptions& daemon = arguments.daemon;
  arguments.cell.add_to(line, true);
  line.add({{"--check", &arguments.check, "Only check the cell: print every error, or a summary"}});
  arguments.dds.add_to(line);
  line.add({{"--record", &daemon.record_file,
             "Record inputs and reports to this MCAP file; if it exists, to NAME-2.mcap and so "
             "on"},
            force_option(arguments.record_over)});
  arguments.recording.add_to(line, "--record-");
  arguments.recording.add_events_to(line, "--record-");
  line.add({
      {"--share", &arguments.cell.share,
       "Watch only this share of a cell that names its shares; clearance-merge joins them"},
      {"--gradients", &arguments.gradients,
       "Publish how the distances of published pairs change with joint positions, as "
       "'gradients: true' in the cell does"},
      ros_outputs_option(arguments.ros, {"--share"}),
      {"--use-sim-time", &arguments.use_sim_time,
       "The time is that of a simulation, by /clock of ROS 2, as 'use_sim_time: true' of 'ros2' in "
       "the cell says (idl/SIMULATED_TIME.md)",
       excluding("--share")},
  });
  add_inputs(line, arguments);
  line.add({
      {"--interventions", &arguments.interventions,
       "Append to this file what people and programs do to the daemon, in lines of JSON that have "
       "the hash of the line before: starts, ends, changes of the scene and of sources "
       "('clearance-replay log' verifies them)"},
      {"--metrics", &arguments.metrics,
       "Answer GET /metrics on this Unix socket, in the text format of Prometheus"},
      {"--histograms", &arguments.histograms,
       "At the end, write how long wake-ups, ticks, reports and responses took to this JSON file"},
      {"--ticks", &daemon.max_ticks, "Stop after this many ticks; 0: never",
       whole_number(0, 1'000'000'000'000)},
      {"--priority", &daemon.fifo_priority,
       "Run the tick thread under SCHED_FIFO with this priority, and lock memory",
       whole_number_in(1, 99)},
      {"--ahead", &arguments.ahead_us,
       "Wake this many us (1 to 500) before each tick and stay awake until it, and so does the "
       "thread that publishes: reports come earlier, for the processor time "
       "(monitor/loop/README.md)",
       whole_number(1, 500), needing("--priority")},
      {"--cpu", &daemon.cpu, "Pin the tick thread to this processor", whole_number(0, 1023)},
      log_level_option(arguments.log_level),
  });
}

// A run logs the same notes.
void print_summary(const Scene& scene) {
  for (const Robot& robot : scene.robots) {
    for (const std::string& note : robot.notes) {
      print(stderr, "robot '{}': {}\n", robot.name, note);
    }
  }
  for (const Sensor& sensor : scene.sensors) {
    for (const std::string& note : notes_of(sensor))
      print(stderr, "sensor '{}': {}\n", sensor.name, note);
  }
  if (const std::string left = unstated_errors(scene); !left.empty()) print(stderr, "{}\n", left);
  print(stdout, "{}\n", summary(scene));
}

// --check reads the cell like a run does: a cell that passes here starts.
int check_only(const CellArguments& cell) {
  const auto read = cell_or_errors(cell.read());
  if (!read) return kBadCell;
  print_summary(read->scene);
  return kOk;
}

void add_names(const std::vector<std::string>& asked, std::vector<std::string>& names) {
  for (const std::string& name : asked) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
}

// Adds to a cell, and to every changed one, what the command line asks for.
void finish(const Arguments& arguments, Cell& cell) {
  cell.scene.gradients = cell.scene.gradients || arguments.gradients;
  cell.ros.use_sim_time = cell.ros.use_sim_time || arguments.use_sim_time;
  add_asked(arguments.ros, cell.ros.outputs);
  add_names(arguments.commands, cell.commands.from);
  add_names(arguments.questions, cell.questions.from);
  add_names(arguments.trajectories.topics, cell.ros.trajectories.topics);
  if (!arguments.trajectories.margins.empty())
    cell.ros.trajectories.margins = arguments.trajectories.margins;
}

// The summary goes to stdout at the end; the log goes to stderr during the run.
std::optional<Cell> read_cell(const Arguments& arguments) {
  auto cell = cell_or_errors(arguments.cell.read());
  if (cell) finish(arguments, *cell);
  return cell;
}

// The budget of a cell in shares is only known to cover each of them.
bool fits_into_one(const Cell& cell) {
  if (cell.shares.all.empty() || cell.shares.is_one()) return true;
  const std::uint64_t needed = refresh_share(cell.scene).queries();
  if (needed <= cell.scene.budget) return true;
  print(stderr,
        "clearanced: the budget of {} queries a tick covers each share of the cell, and one daemon "
        "for the whole cell needs {}. Start a daemon for each share: --share '{}'\n",
        cell.scene.budget, needed, cell.shares.all.front().name);
  return false;
}

// Begins with the scene that was kept, if there is one of this cell file. Returns an exit code if
// the kept scene cannot be used.
std::optional<int> resume(Arguments& arguments, Cell& cell) {
  CommanderOptions& commander = arguments.daemon.commander;
  commander.began_with = cell.scene.revision;
  if (commander.keep_scene.empty()) return std::nullopt;
  const std::string file = commander.keep_scene.string();
  auto read = read_kept_scene(commander.keep_scene);
  if (const auto* reason = std::get_if<std::string>(&read)) {
    print(stderr, "clearanced: --keep-scene: {}\n", *reason);
    return kBadCell;
  }
  const auto& kept = std::get<std::optional<KeptScene>>(read);
  if (!kept) return std::nullopt;
  if (kept->began_with != cell.scene.revision) {
    print(stderr,
          "clearanced: --keep-scene: the changes in {} began with revision {:016x} of the cell, "
          "which has the revision {:016x} now. Remove that file to begin with the cell, or bring "
          "the cell back\n",
          file, kept->began_with, cell.scene.revision);
    return kBadCell;
  }
  auto resumed = cell_or_errors(parse_cell(kept->yaml, cell.file, arguments.cell.reading()));
  if (!resumed) return kBadCell;
  finish(arguments, *resumed);
  cell = *std::move(resumed);
  log_line(lines::kSceneResumed, file, kept->began_with);
  return std::nullopt;
}

int run_daemon(const Cell& cell, Arguments& arguments, StopSignal& signal) {
  arguments.daemon.dds = arguments.dds.resolve(cell);
  CommanderOptions& commander = arguments.daemon.commander;
  commander.reading = arguments.cell.reading();
  commander.finish = [arguments](Cell& changed) { finish(arguments, changed); };
  if (arguments.cell.cell.empty())
    commander.own_text = [of = arguments.cell] { return of.robot_text(); };
  arguments.daemon.list_mistakes = [of = arguments.cell] { (void)cell_or_errors(of.read()); };
  std::optional<MetricsServer> metrics;
  if (!arguments.metrics.empty()) {
    metrics.emplace(arguments.metrics);
    arguments.daemon.on_health = [&metrics](const MetricsSource& source) {
      metrics->publish(metrics_text(source));
    };
  }
  route_dds_log();
  std::optional<InterventionLog> interventions;
  if (!arguments.interventions.empty())
    arguments.daemon.interventions = &interventions.emplace(arguments.interventions);
  Daemon daemon(cell, arguments.daemon);
  daemon.run(signal);
  write_text(stdout, daemon.summary(), Patience::kBrief);
  const bool is_written = arguments.histograms.empty() ||
                          write_file("clearanced", arguments.histograms, daemon.histograms());
  if (daemon.recording_hangs() || (interventions && interventions->hangs())) {
    drain_log();
    std::_Exit(kIncomplete);
  }
  const bool is_complete =
      daemon.recording_complete() && is_written && (!interventions || interventions->complete());
  const int status = daemon.damaged()   ? kDamaged
                     : daemon.yielded() ? kDdsFailed
                     : is_complete      ? kOk
                                        : kIncomplete;
  if (daemon.still_reads()) {
    drain_log();
    std::_Exit(status);
  }
  return status;
}

// Keeps the URDF from ROS 2 as a file. Returns false when it was stopped before the URDF came.
bool take_robot_description(Arguments& arguments, StopSignal& signal) {
  route_dds_log();
  Participant participant(arguments.dds.resolve());
  const auto urdf =
      wait_for_robot_description(participant, arguments.cell.description_topic, signal);
  if (!urdf) return false;
  arguments.cell.robot.urdf = keep_robot_description(*urdf);
  log_line(lines::kDescriptionKept, arguments.cell.description_topic,
           arguments.cell.robot.urdf.string());
  return true;
}

// All mistakes in the input are reported before the program joins DDS. The exception is a robot
// description that has to come over DDS.
int run(int argc, char** argv, StopSignal& signal) {
  CommandLine line{
      "Publishes how far apart the objects of a robot cell are, with bounds, at a fixed rate.",
      kFooter};
  Arguments arguments;
  add_options(line, arguments);
  if (const auto done = parse(line, argc, argv)) return *done;
  arguments.daemon.ahead_ns = 1000 * arguments.ahead_us;
  arguments.daemon.command_line.assign(argv, argv + argc);
  start_log("clearanced", arguments.log_level);

  if (arguments.check && arguments.cell.description_topic.empty()) {
    signal.end_with(kFailed, "clearanced: stopped before the cell was checked\n");
    return check_only(arguments.cell);
  }
  signal.keep_running_on_hangup();
  if (!arguments.cell.description_topic.empty()) {
    if (!take_robot_description(arguments, signal)) return kOk;
  }
  auto cell = read_cell(arguments);
  if (!cell || !fits_into_one(*cell)) return kBadCell;
  if (arguments.check) {
    print_summary(cell->scene);
    return kOk;
  }
  if (arguments.daemon.partner.empty()) arguments.daemon.partner = cell->partner;
  if (!arguments.daemon.partner.empty() && cell->scene.rate_hz < kLeastPartnersHz) {
    print(
        stderr,
        "clearanced: --partner: found a cell of {:g} Hz; expected at least {:g} Hz, since partners "
        "hear from each other once a tick, and a silence of 20 ms counts as an end\n",
        cell->scene.rate_hz, kLeastPartnersHz);
    return kUsage;
  }
  if (cell->ros.use_sim_time && (!arguments.daemon.partner.empty() || cell->shares.is_one())) {
    print(stderr,
          "clearanced: found 'use_sim_time' with a partner or a share; expected one daemon for the "
          "cell, since each of several would have a simulated time of its own\n");
    return kUsage;
  }
  for (const std::filesystem::path& file : arguments.cell.files()) {
    for (const auto& output : {arguments.daemon.record_file, arguments.interventions})
      if (!output_is_not_an_input("clearanced", output, {file})) return kUsage;
  }
  // The names of files by event have their time.
  const auto record_file =
      arguments.recording.by_event()
          ? arguments.daemon.record_file
          : free_name("clearanced", arguments.daemon.record_file, arguments.record_over);
  if (!record_file) return kIncomplete;
  if (*record_file != arguments.daemon.record_file) {
    log_line(lines::kRecordingRenamed, arguments.daemon.record_file.string(),
             record_file->string());
    arguments.daemon.record_file = *record_file;
  }
  arguments.daemon.recording = arguments.recording.options(arguments.record_over);
  if (const auto status = resume(arguments, *cell)) return *status;
  return run_daemon(*cell, arguments, signal);
}

// Maps an exception to its exit code in kFooter, the text of --help.
ExitCode exit_code_of(const std::exception& error) {
  const bool is_of_file = dynamic_cast<const RecordError*>(&error) != nullptr ||
                          dynamic_cast<const InterventionError*>(&error) != nullptr;
  return is_of_file ? kIncomplete : dds_exit_code(error);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearanced", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::exit_code_of);
}
