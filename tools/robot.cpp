// clearance-robot: a simulated robot. At a fixed rate it publishes the poses of a cell's
// `simulation:` section, the joints of its robots, and what its cameras see. The joints move
// through their ranges or along a log. On request it measures the latency of the daemon's answer,
// or compares the distances to what cameras see with the truth.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "config/text/sentences.hpp"
#include "monitor/app/cell_arguments.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/output_file.hpp"
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
#include "monitor/recording/given_joints.hpp"
#include "tools/rendering/person.hpp"
#include "tools/robot/camera_truth.hpp"
#include "tools/robot/joint_log_motion.hpp"
#include "tools/robot/latency_meter.hpp"
#include "tools/robot/simulated_cameras.hpp"
#include "tools/robot/simulated_robot.hpp"
#include "tools/robot/simulation_time.hpp"
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

A person walks up to the robot, seen by the cameras of a cell, and the distances are judged:
  clearance-robot config/cells/camera.yaml --partition lab --swing 0.3 --person 3.2,-0.6:1.45,-0.15 --truth

Latency at every phase between the robot's cycle and the daemon's (997 Hz drifts against 1000 Hz):
  clearance-robot config/cells/two_arms.yaml --partition lab --seconds 60 --rate 997 --latency)";

constexpr std::uint64_t kFollowEvery = 64;  // batches between two looks at the clocks

struct Arguments {
  CellArguments cell;
  std::string joints;            // a log; empty: sweep
  std::vector<std::string> off;  // NAME=OFFSET
  double swing = JointSweep::kUsualShare;
  double rate_hz = 1000.0;
  double seconds = 0.0;
  SimulatedRobotOptions robot;
  bool latency = false;
  std::filesystem::path histograms;  // empty: none
  SimulatedCameraOptions cameras;
  std::string camera_size = "320x240";
  std::vector<std::string> people;  // their paths
  double person_speed = 0.6;
  bool truth = false;
  int priority = 0;
  std::string log_level = "info";
  DdsArguments dds;
};

// "320x240"; nothing for another text.
std::optional<std::pair<std::uint32_t, std::uint32_t>> size_of(const std::string& text) {
  unsigned columns = 0, rows = 0;
  int read = 0;
  const int found = std::sscanf(text.c_str(), "%5ux%5u%n", &columns, &rows, &read);
  if (found != 2 || static_cast<std::size_t>(read) != text.size() || columns == 0 || rows == 0)
    return std::nullopt;
  return std::pair(columns, rows);
}

std::string fault_of_path(const std::string& text) {
  const auto path = read_walking_path(text);
  const auto* const fault = std::get_if<std::string>(&path);
  return fault != nullptr ? *fault : std::string();
}

// ROS 2 permits no other characters: the path of a cell has a dot.
bool is_ros_topic(const std::string& topic) {
  const auto is_allowed = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/';
  };
  return topic.starts_with('/') && topic.size() > 1 && std::ranges::all_of(topic, is_allowed);
}

void add_camera_options(CommandLine& line, Arguments& arguments) {
  SimulatedCameraOptions& cameras = arguments.cameras;
  const OptionRule rule{.group = "Cameras (the cell's `sensors`)"};
  const OptionRule with_default{.shows_default = true, .group = rule.group};
  line.add({
      {"--camera-rate", &cameras.rate_hz, "Frames per second; 0: no camera is simulated",
       number_in(0.0, 1000.0), with_default},
      {"--camera-size", &arguments.camera_size, "Columns and rows of their pictures",
       expecting("COLUMNSxROWS: 640x480",
                 [](const std::string& text) { return size_of(text).has_value(); }),
       with_default},
      {"--camera-noise", &cameras.noise_share,
       "Noise as a share of the depth_error that the cell states", number_in(0.0, 1.0),
       with_default},
      {"--camera-missing", &cameras.missing_share, "Share of the pixels that are missing",
       number_in(0.0, 1.0), with_default},
      {"--person", &arguments.people,
       "A person whom the cell does not know walks along these points in the world, m, reaches out "
       "a hand at the last one, and walks back: X,Y:X,Y or X,Y,Z:X,Y,Z with the height Z of the "
       "floor; repeatable",
       Check{fault_of_path}, rule},
      {"--person-speed", &arguments.person_speed, "Of walking, m/s", number_in(0.05, 5.0),
       with_default},
      {"--truth", &arguments.truth,
       "Read the reports too, and compare the bounds of published pairs with the truth: with a "
       "camera, the distance of the surface that it truly saw",
       rule},
  });
}

void add_options(CommandLine& line, Arguments& arguments) {
  arguments.cell.add_to(line);
  line.add({
      {"--joints", &arguments.joints,
       "Robots follow this CSV: t_ns, and a column a joint, rad or m; plain or gzip. Otherwise "
       "every joint swings through its range"},
      {"--off", &arguments.off,
       "NAME=OFFSET, rad or m: a joint whose true position, which cameras and --truth see, is "
       "this much more than the one that is sent; repeatable"},
      {"--swing", &arguments.swing,
       "Share of its range through which every joint swings, without --joints", number_in(0.0, 1.0),
       shown()},
      {"--ros",
       &arguments.robot.ros_topic,
       "Send joints as ROS 2 does, on this topic; --ros alone: /joint_states",
       expecting("a topic with its namespace: /joint_states; or, for that one, nothing: the cell "
                 "stands before --ros",
                 is_ros_topic),
       {.value_name = "[TOPIC]", .value_alone = "/joint_states"}},
      {"--rate", &arguments.rate_hz, "Batches per second", number_in(0.1, 10000.0), shown()},
      {"--seconds", &arguments.seconds,
       "Stop after this time; 0: run until a signal comes, or the log of --joints ends",
       number_from_zero()},
      {"--source", &arguments.robot.source, "Name of this source, 1 to 32 bytes",
       expecting(fmt::format("a name of 1 to {} bytes", kMaxSourceLength),
                 [](const std::string& name) {
                   return !name.empty() && name.size() <= kMaxSourceLength;
                 }),
       shown()},
      {"--latency", &arguments.latency,
       "Read the reports too, and print the delay from a batch to the first report that uses it"},
      {"--histograms", &arguments.histograms, "Write these delays to this JSON file",
       needing("--latency")},
  });
  add_camera_options(line, arguments);
  line.add({{"--priority", &arguments.priority, "Run under SCHED_FIFO", whole_number_in(1, 99)}});
  arguments.dds.add_to(line);
  line.add({log_level_option(arguments.log_level)});
}

// Sends at absolute deadlines until it is stopped; returns the delays of its wake-ups.
Histogram send_all(SimulatedRobot& robot, const Arguments& arguments, SimulationTime& time,
                   const std::atomic<bool>& stop) {
  name_thread("send");
  SystemClock clock;
  Histogram lateness;
  const std::int64_t period_ns = std::llround(1e9 / arguments.rate_hz);
  const auto batches = static_cast<std::uint64_t>(arguments.seconds * arguments.rate_hz);
  std::int64_t deadline = clock.monotonic_ns();
  while (!stop && (arguments.seconds == 0.0 || robot.sent() < batches)) {
    clock.sleep_until(deadline);
    const std::int64_t now = clock.monotonic_ns();
    lateness.add(now - deadline);
    robot.send(time.seconds(now), time.stamp(now));
    if (robot.sent() % kFollowEvery == 0) time.follow();
    deadline += period_ns * std::max<std::int64_t>(1, (now - deadline) / period_ns);
  }
  return lateness;
}

// "3 poses and 7 joint states", and neither without any.
std::string inputs_of(const SimulatedRobot& robot) {
  std::string all;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) all += (all.empty() ? "" : " and ") + counted(count, what);
  };
  add(robot.objects(), "pose");
  add(robot.joints(), "joint state");
  add(robot.frames(), "transform");
  add(robot.people() ? robot.people()->size() : 0, "person");
  return all;
}

// Cameras that are simulated, or none.
class Cameras {
 public:
  Cameras(const Cell& cell, client::Connection& connection, const Arguments& arguments,
          const JointMotion& motion, const SimulationTime& time) {
    if (cell.scene.sensors.empty() || arguments.cameras.rate_hz == 0.0) {
      if (arguments.truth || !arguments.people.empty())
        log_text(LogLevel::kWarn,
                 "--truth and --person do nothing: no camera of the cell is simulated");
      return;
    }
    if (const std::string fault = fault_of(cell, arguments.cameras); !fault.empty()) {
      log_text(LogLevel::kWarn, fmt::format("no camera is simulated: {}", fault));
      return;
    }
    const SimulatedWorld world(cell, motion, people_of(cell, arguments));
    if (arguments.truth) truth_.emplace(cell, connection, world, time, arguments.rate_hz);
    cameras_.emplace(cell, connection.participant(), world, time, arguments.cameras,
                     [this](const SentFrame& frame) {
                       if (truth_) truth_->sent(frame);
                     });
    log_text(
        LogLevel::kInfo,
        fmt::format("{} of {} x {} pixels at {} Hz", counted(cell.scene.sensors.size(), "camera"),
                    arguments.cameras.columns, arguments.cameras.rows, arguments.cameras.rate_hz));
  }

  void tell() {
    if (!cameras_) return;
    cameras_->stop();
    print(stdout, "{} sent, {} failed\n", counted(cameras_->sent(), "frame"), cameras_->failed());
    print(stdout, "frame    {}  exposure to rendered\n", percentiles(cameras_->rendered()));
    print(stdout, "         {}  exposure to written\n", percentiles(cameras_->written()));
    if (truth_) truth_->tell();
  }

 private:
  static std::vector<WalkingPerson> people_of(const Cell& cell, const Arguments& arguments) {
    std::vector<WalkingPerson> people;
    for (const std::string& text : arguments.people) {
      people.emplace_back(std::get<WalkingPath>(read_walking_path(text)), arguments.person_speed);
      const double fastest = people.back().max_speed();
      log_text(LogLevel::kInfo,
               fmt::format("a person walks; no point of it is faster than {:.2f} m/s", fastest));
      for (const Sensor& sensor : cell.scene.sensors) {
        const double stated = cell.scene.objects[sensor.object].max_speed;
        if (stated < fastest)
          log_text(LogLevel::kWarn,
                   fmt::format("{} states a max_speed of {} m/s, which this person exceeds",
                               sensor.name, stated));
      }
    }
    return people;
  }

  std::optional<CameraTruth> truth_;
  std::optional<SimulatedCameras> cameras_;  // calls the above
};

// The joints as they are, which is not as they are sent.
JointMotion true_motion(const Cell& cell, const Arguments& arguments, const JointMotion& sent) {
  std::map<std::string, double> off;
  static_cast<void>(read_joint_positions(arguments.off, off));  // run() has refused others
  std::vector<double> by_variable;
  for (const JointVariable& variable : cell.scene.variables)
    by_variable.push_back(off.contains(variable.name) ? off[variable.name] : 0.0);
  return [sent, by_variable](double t_s, std::vector<JointSample>& joints) {
    sent(t_s, joints);
    for (JointSample& joint : joints) joint.position += by_variable[joint.variable];
  };
}

// Says what is wrong with the offsets of joints, or nothing.
std::string fault_of_offsets(const Cell& cell, const Arguments& arguments) {
  std::map<std::string, double> off;
  if (std::string fault = read_joint_positions(arguments.off, off); !fault.empty()) return fault;
  return GivenJoints(cell.scene, off).error();
}

int run_robot(const Cell& cell, const Arguments& arguments, JointMotion motion,
              StopSignal& signal) {
  use_precise_timers();
  // Every later thread inherits this, Cyclone's as well.
  if (arguments.priority > 0) {
    if (const Refusal refusal = use_fifo_scheduling(arguments.priority)) {
      log_text(LogLevel::kWarn, *refusal);
    }
  }
  route_dds_log();
  const auto dds = arguments.dds.resolve(cell);
  if (!arguments.robot.ros_topic.empty() && !dds.partition.empty())
    log_line(lines::kPartitionWithoutRos, dds.partition);
  client::Connection connection(dds, cell.topics);
  SimulationTime time;
  SimulatedRobot robot(cell, connection, arguments.robot, motion);
  std::optional<LatencyMeter> latency;
  if (arguments.latency) latency.emplace(connection, arguments.priority);
  log_text(LogLevel::kInfo,
           fmt::format("source '{}' sends {} at {} Hz on {}", arguments.robot.source,
                       inputs_of(robot), arguments.rate_hz, connection.where()));
  if (robot.people() && !robot.people()->left_out().empty()) {
    log_text(LogLevel::kWarn,
             fmt::format("nothing is sent of {}: no mover of the simulation has the frame body_ID "
                         "(idl/PEOPLE.md); `example_arm people` plays a motion",
                         one_of(robot.people()->left_out())));
  }
  Cameras cameras(cell, connection, arguments, true_motion(cell, arguments, motion), time);

  std::atomic<bool> stop{false}, done{false};
  Histogram lateness;
  std::thread sending([&] {
    lateness = send_all(robot, arguments, time, stop);
    done = true;
  });
  while (!done && !signal.wait(50)) {
  }
  stop = true;
  sending.join();
  print(stdout, "{} of {} sent, {} failed\n", counted(robot.sent(), "batch", "batches"),
        inputs_of(robot), robot.failed());
  print(stdout, "wake-up  {}\n", percentiles(lateness));
  cameras.tell();
  if (latency) latency->tell(connection.where());
  const bool is_written =
      arguments.histograms.empty() ||
      write_file("clearance-robot", arguments.histograms, latency->histograms());
  return is_written ? kOk : kFailed;
}

int run(int argc, char** argv, StopSignal& signal) {
  CommandLine line{"Simulates a robot: moves a cell's objects and joints over DDS.", kFooter};
  Arguments arguments;
  add_options(line, arguments);
  if (const auto done = parse(line, argc, argv)) return *done;
  std::tie(arguments.cameras.columns, arguments.cameras.rows) = *size_of(arguments.camera_size);
  start_log("clearance-robot", arguments.log_level);
  const auto cell = cell_or_errors(arguments.cell.read());
  if (!cell) return kBadCell;
  if (cell->simulation.empty() && cell->scene.variables.empty() && cell->scene.sensors.empty()) {
    print(
        stderr,
        "{} has no `simulation:` section, no robot with joints and no camera: nothing says how its "
        "objects move\n",
        arguments.cell.name());
    return kBadCell;
  }
  if (const std::string fault = fault_of_offsets(*cell, arguments); !fault.empty()) {
    print(stderr, "clearance-robot: --off: {}\n", fault);
    return kUsage;
  }
  if (arguments.joints.empty()) {
    return run_robot(
        *cell, arguments,
        [sweep = JointSweep(cell->scene, arguments.swing)](double t_s, auto& joints) {
          sweep.at(t_s, joints);
        },
        signal);
  }
  JointLogMotion log(arguments.joints, cell->scene);
  if (!log.error().empty()) {
    print(stderr, "clearance-robot: {}\n", log.error());
    return kBadCell;
  }
  if (!log.note().empty())
    log_text(LogLevel::kWarn, fmt::format("{}: {}", arguments.joints, log.note()));
  if (arguments.seconds == 0.0) {
    arguments.seconds = log.seconds();
    log_text(LogLevel::kInfo, fmt::format("{} lasts {:.3f} s; after that this ends",
                                          arguments.joints, arguments.seconds));
  }
  return run_robot(
      *cell, arguments, [log](double t_s, auto& joints) mutable { log.at(t_s, joints); }, signal);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearance-robot", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::dds_exit_code);
}
