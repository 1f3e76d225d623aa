// clearance-robot: a simulated robot. Publishes the poses of everything that moves in a cell, as
// its `simulation:` section says, at a fixed rate; on request it measures how soon the daemon's
// answer is back.
#include <fmt/format.h>

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <thread>

#include "config/simulation.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/dds/participant.hpp"
#include "monitor/loop/histogram.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/loop/summary.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  stopped by SIGINT, SIGTERM or --seconds
  1  something else failed
  2  wrong usage
  3  the cell file is wrong, or has no simulation
  4  DDS could not be joined

Example:
  clearance-robot config/cells/two_arms.yaml --partition lab --seconds 60

Latency at every phase between the robot's cycle and the daemon's (997 Hz drifts against 1000 Hz):
  clearance-robot config/cells/two_arms.yaml --partition lab --seconds 60 --rate 997 --latency)";

struct Arguments {
  std::string cell;
  double rate_hz = 1000.0;
  double seconds = 0.0;
  std::string source = "robot";
  bool latency = false;
  int priority = 0;
  std::string log_level = "info";
  DdsArguments dds;
};

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("CELL", arguments.cell, "The cell file (YAML)")->required();
  app.add_option("--rate", arguments.rate_hz, "Batches per second")
      ->check(finite_number())
      ->check(CLI::Range(0.1, 10000.0))
      ->capture_default_str();
  app.add_option("--seconds", arguments.seconds,
                 "Stop after this time; 0: run until a signal comes")
      ->check(number_from_zero());
  app.add_option("--source", arguments.source, "Name of this source, 1 to 32 bytes")
      ->check([](const std::string& name) {
        return !name.empty() && name.size() <= kMaxSourceLength
                   ? std::string()
                   : fmt::format("found '{}', {} bytes; expected a name of 1 to {}", name,
                                 name.size(), kMaxSourceLength);
      })
      ->capture_default_str();
  app.add_flag(
      "--latency", arguments.latency,
      "Read the reports too, and print the delay from a pose to the first report that uses it");
  app.add_option("--priority", arguments.priority, "Run under SCHED_FIFO")
      ->check(CLI::Range(1, 99));
  arguments.dds.add_to(app);
  add_log_level(app, arguments.log_level);
  app.footer(kFooter);
}

// Measures the age of the newest pose when the first report that used it arrived here.
class LatencyMeter {
 public:
  LatencyMeter(Participant& participant, const std::string& topic)
      : reader_(participant.reader(TopicKind::kDistances, topic)),
        wait_(participant, {reader_}),
        thread_([this] { run(); }) {}
  ~LatencyMeter() {
    stop_ = true;
    wait_.wake();
    thread_.join();
  }

  // `where`: the domain in which reports were awaited.
  void tell(const std::string& where) {
    const std::lock_guard lock(mutex_);
    if (all_.count() == 0) {
      print(stdout, "latency  not known: no report came on {}; does clearanced run there?\n",
            where);
      return;
    }
    print(stdout, "latency  {}  pose sent to report received, {} poses\n", percentiles(all_),
          all_.count());
    print(stdout, "         {}  of which: pose sent to tick\n", percentiles(to_tick_));
    print(stdout, "         {}  of which: tick to report received\n", percentiles(from_tick_));
  }

 private:
  void run() {
    name_thread("latency");
    while (!stop_) {
      if (wait_.wait(DDS_INFINITY)) take_all();
    }
  }

  void take_all() {
    dds_sample_info_t info;
    void* sample = &*sample_;
    while (dds_take(reader_, &sample, &info, 1, 1) > 0) {
      const std::int64_t now = clock_.realtime_ns();
      if (!info.valid_data || sample_->newest_pose_ns <= newest_) continue;
      newest_ = sample_->newest_pose_ns;
      const std::lock_guard lock(mutex_);
      all_.add(now - newest_);
      to_tick_.add(sample_->now_ns - newest_);
      from_tick_.add(now - sample_->now_ns);
    }
  }

  SystemClock clock_;
  dds_entity_t reader_;
  DataWait wait_;
  Sample<clearance_msg_Distances> sample_;
  std::int64_t newest_ = 0;
  std::mutex mutex_;
  Histogram all_, to_tick_, from_tick_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

class Robot {
 public:
  Robot(const Scene& scene, Participant& participant, const std::string& source)
      : scene_(scene), writer_(participant.writer(TopicKind::kPoses, scene.topics.poses)) {
    poses_at(scene_, 0.0, poses_);
    batch_.source = SourceName(source);
    batch_.scene_revision = scene.revision;
    batch_.samples.resize(poses_.size());
    sample_ = make_batch(poses_.size());
  }

  [[nodiscard]] std::size_t objects() const noexcept { return poses_.size(); }

  // The poses `t_s` seconds after the start, stamped with the time of sending.
  void send(double t_s) {
    poses_at(scene_, t_s, poses_);
    const std::int64_t stamp = clock_.realtime_ns();
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      batch_.samples[i] = {.object = poses_[i].object,
                           .stamp_ns = stamp,
                           .world_from_object = poses_[i].world_from_object,
                           .twist = poses_[i].twist,
                           .has_twist = true};
    }
    ++batch_.sequence_number;
    to_wire(batch_, *sample_);
    if (dds_write(writer_, &*sample_) != DDS_RETCODE_OK) ++failed_;
  }

  [[nodiscard]] std::uint64_t sent() const noexcept { return batch_.sequence_number; }
  [[nodiscard]] std::uint64_t failed() const noexcept { return failed_; }

 private:
  const Scene& scene_;
  dds_entity_t writer_;
  SystemClock clock_;
  std::vector<PoseAt> poses_;
  PoseBatch batch_;
  Sample<clearance_msg_PoseBatch> sample_;
  std::uint64_t failed_ = 0;
};

// Sends at absolute deadlines until it is stopped; returns the delays of its wake-ups.
Histogram send_all(Robot& robot, const Arguments& arguments, const std::atomic<bool>& stop) {
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

int run_robot(const Scene& scene, const Arguments& arguments, StopSignal& signal) {
  use_precise_timers();
  // Inherited by every thread made from here on, Cyclone's as well.
  if (arguments.priority > 0) {
    if (const Refusal refusal = use_fifo_scheduling(arguments.priority)) {
      spdlog::warn("{}", *refusal);
    }
  }
  route_dds_log();
  Participant participant(arguments.dds.resolve(scene.domain, scene.partition));
  Robot robot(scene, participant, arguments.source);
  std::optional<LatencyMeter> latency;
  if (arguments.latency) latency.emplace(participant, scene.topics.distances);
  spdlog::info("source '{}' moves {} objects at {} Hz on {}", arguments.source, robot.objects(),
               arguments.rate_hz, participant.where());

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
  print(stdout, "{} batches of {} poses sent, {} failed\n", robot.sent(), robot.objects(),
        robot.failed());
  print(stdout, "wake-up  {}\n", percentiles(lateness));
  if (latency) latency->tell(participant.where());
  return kOk;
}

int run(int argc, char** argv, StopSignal& signal) {
  CLI::App app("Publishes simulated poses of a cell over DDS.");
  Arguments arguments;
  add_options(app, arguments);
  if (const auto done = parse(app, argc, argv)) return *done;
  start_log("clearance-robot", arguments.log_level);
  const auto scene = scene_or_errors(read_cell(arguments.cell));
  if (!scene) return kBadCell;
  if (scene->simulation.empty()) {
    print(stderr, "{} has no `simulation:` section: nothing says how its objects move\n",
          arguments.cell);
    return kBadCell;
  }
  return run_robot(*scene, arguments, signal);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearance-robot", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::dds_exit_code);
}
