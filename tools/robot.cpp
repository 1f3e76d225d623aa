// clearance-robot: a simulated robot. At a fixed rate it publishes the poses of a cell's
// `simulation:` section and the joints of its robots. The joints move through their ranges or along
// a log. On request it measures the latency of the daemon's answer.
#include <fmt/format.h>

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <thread>
#include <utility>

#include "monitor/app/cell_arguments.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/client/client.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/loop/histogram.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/loop/summary.hpp"
#include "tools/robot/joint_log_motion.hpp"
#include "tools/robot/latency_meter.hpp"
#include "tools/robot/simulated_robot.hpp"
#include "tools/shared/joint_sweep.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  stopped by SIGINT, SIGTERM, SIGHUP or --seconds
  1  something else failed
  2  wrong usage
  3  the cell file or the log of joints is wrong, or nothing says how anything moves
  4  DDS could not be joined

Example:
  clearance-robot config/cells/two_arms.yaml --partition lab --seconds 60
  clearance-robot --urdf panda.urdf --srdf panda.srdf --ros --interface default
  clearance-robot cell.yaml --joints joints.csv.gz

Latency at every phase between the robot's cycle and the daemon's (997 Hz drifts against 1000 Hz):
  clearance-robot config/cells/two_arms.yaml --partition lab --seconds 60 --rate 997 --latency)";

constexpr const char* kRosJointStates = "/joint_states";

struct Arguments {
  CellArguments cell;
  std::string joints;  // a log; empty: sweep
  double rate_hz = 1000.0;
  double seconds = 0.0;
  SimulatedRobotOptions robot;
  bool latency = false;
  int priority = 0;
  std::string log_level = "info";
  DdsArguments dds;
};

void add_options(CLI::App& app, Arguments& arguments) {
  arguments.cell.add_to(app);
  app.add_option("--joints", arguments.joints,
                 "Robots follow this CSV: t_ns, and a column a joint, rad or m; plain or gzip. "
                 "Otherwise every joint swings through its range");
  app.add_option("--ros", arguments.robot.ros_topic,
                 "Send joints as ROS 2 does, on this topic; --ros alone: /joint_states")
      ->expected(0, 1)
      ->default_str(kRosJointStates)
      ->option_text("[TOPIC]")
      ->check([](const std::string& topic) {
        // ROS 2 permits no other characters: the path of a cell has a dot.
        const auto is_allowed = [](char c) {
          return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/';
        };
        return topic.starts_with('/') && topic.size() > 1 && std::ranges::all_of(topic, is_allowed)
                   ? std::string()
                   : fmt::format(
                         "found '{}'; expected a topic with its namespace: "
                         "/joint_states; or, for that one, nothing: the cell stands "
                         "before --ros",
                         topic);
      });
  app.add_option("--rate", arguments.rate_hz, "Batches per second")
      ->check(finite_number())
      ->check(CLI::Range(0.1, 10000.0))
      ->capture_default_str();
  app.add_option("--seconds", arguments.seconds,
                 "Stop after this time; 0: run until a signal comes, or the log of --joints ends")
      ->check(number_from_zero());
  app.add_option("--source", arguments.robot.source, "Name of this source, 1 to 32 bytes")
      ->check([](const std::string& name) {
        return !name.empty() && name.size() <= kMaxSourceLength
                   ? std::string()
                   : fmt::format("found '{}', {} bytes; expected a name of 1 to {}", name,
                                 name.size(), kMaxSourceLength);
      })
      ->capture_default_str();
  app.add_flag(
      "--latency", arguments.latency,
      "Read the reports too, and print the delay from a batch to the first report that uses it");
  app.add_option("--priority", arguments.priority, "Run under SCHED_FIFO")
      ->check(CLI::Range(1, 99));
  arguments.dds.add_to(app);
  add_log_level(app, arguments.log_level);
  app.footer(kFooter);
}

// Sends at absolute deadlines until it is stopped; returns the delays of its wake-ups.
Histogram send_all(SimulatedRobot& robot, const Arguments& arguments,
                   const std::atomic<bool>& stop) {
  name_thread("send");
  SystemClock clock;
  Histogram lateness;
  const std::int64_t period_ns = std::llround(1e9 / arguments.rate_hz);
  const auto batches = static_cast<std::uint64_t>(arguments.seconds * arguments.rate_hz);
  const std::int64_t start = clock.monotonic_ns();
  std::int64_t deadline = start;
  while (!stop && (arguments.seconds == 0.0 || robot.sent() < batches)) {
    clock.sleep_until(deadline);
    const std::int64_t now = clock.monotonic_ns();
    lateness.add(now - deadline);
    robot.send(1e-9 * static_cast<double>(now - start));
    deadline += period_ns * std::max<std::int64_t>(1, (now - deadline) / period_ns);
  }
  return lateness;
}

// "3 poses and 7 joint states", and neither without any.
std::string inputs_of(const SimulatedRobot& robot) {
  const std::string poses = robot.objects() > 0 ? counted(robot.objects(), "pose") : "";
  const std::string joints = robot.joints() > 0 ? counted(robot.joints(), "joint state") : "";
  return poses + (poses.empty() || joints.empty() ? "" : " and ") + joints;
}

int run_robot(const Cell& cell, const Arguments& arguments, JointMotion motion,
              StopSignal& signal) {
  use_precise_timers();
  // Every later thread inherits this, Cyclone's as well.
  if (arguments.priority > 0) {
    if (const Refusal refusal = use_fifo_scheduling(arguments.priority)) {
      spdlog::warn("{}", *refusal);
    }
  }
  route_dds_log();
  client::Connection connection(arguments.dds.resolve(cell), cell.topics);
  SimulatedRobot robot(cell, connection, arguments.robot, std::move(motion));
  std::optional<LatencyMeter> latency;
  if (arguments.latency) latency.emplace(connection);
  spdlog::info("source '{}' sends {} at {} Hz on {}", arguments.robot.source, inputs_of(robot),
               arguments.rate_hz, connection.where());

  std::atomic<bool> stop{false}, done{false};
  Histogram lateness;
  std::thread sending([&] {
    lateness = send_all(robot, arguments, stop);
    done = true;
  });
  while (!done && !signal.wait(50)) {
  }
  stop = true;
  sending.join();
  print(stdout, "{} of {} sent, {} failed\n", counted(robot.sent(), "batch", "batches"),
        inputs_of(robot), robot.failed());
  print(stdout, "wake-up  {}\n", percentiles(lateness));
  if (latency) latency->tell(connection.where());
  return kOk;
}

int run(int argc, char** argv, StopSignal& signal) {
  CLI::App app("Simulates a robot: moves a cell's objects and joints over DDS.");
  Arguments arguments;
  add_options(app, arguments);
  if (const auto done = parse(app, argc, argv)) return *done;
  start_log("clearance-robot", arguments.log_level);
  const auto cell = cell_or_errors(arguments.cell.read());
  if (!cell) return kBadCell;
  if (cell->simulation.empty() && cell->scene.variables.empty()) {
    print(stderr,
          "{} has no `simulation:` section and no robot with joints: nothing says how its objects "
          "move\n",
          arguments.cell.name());
    return kBadCell;
  }
  if (arguments.joints.empty()) {
    return run_robot(
        *cell, arguments,
        [sweep = JointSweep(cell->scene)](double t_s, auto& joints) { sweep.at(t_s, joints); },
        signal);
  }
  JointLogMotion log(arguments.joints, cell->scene);
  if (!log.error().empty()) {
    print(stderr, "clearance-robot: {}\n", log.error());
    return kBadCell;
  }
  if (arguments.seconds == 0.0) {
    arguments.seconds = log.seconds();
    spdlog::info("{} lasts {:.3f} s; after that this ends", arguments.joints, arguments.seconds);
  }
  return run_robot(
      *cell, arguments, [&log](double t_s, auto& joints) { log.at(t_s, joints); }, signal);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearance-robot", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::dds_exit_code);
}
