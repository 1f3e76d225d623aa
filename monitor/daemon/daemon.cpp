// Creates the ports, the queues and the loop in the order of their dependencies. Runs the loop in a
// thread of its own, and empties the queues after the last tick. Scheduling is set before the
// threads that inherit it are created.
#include "monitor/daemon/daemon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "monitor/app/log.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/daemon/intervention_notes.hpp"
#include "monitor/files/build_info.hpp"
#include "monitor/intake/tracked_frames.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/loop/summary.hpp"
#include "monitor/tick/self_test.hpp"

namespace clearance {
namespace {

// 64 ms of reports at 1 kHz; DDS writes seldom take longer.
constexpr std::size_t kQueuedReports = 64;
// The largest delay with which the end after --ticks is noticed.
constexpr std::int64_t kSignalPollMs = 50;
// The number of such intervals between two polls of the cell's files.
constexpr int kPollsAReload = 10;
// The interval at which a change of the cell checks that the last reports of the former cell are
// written.
constexpr std::chrono::milliseconds kReportsPoll{1};

// The text of a Refusal says how to get what was refused.
void log_refusal(const Refusal& refusal) {
  if (refusal) log_line(lines::kSystemRefuses, *refusal);
}

// The priority of the threads that read and publish for the tick thread; 0: ordinary.
int port_priority(const DaemonOptions& options) noexcept {
  return options.fifo_priority > 0 ? std::max(1, options.fifo_priority - 1) : 0;
}

// Cyclone's threads inherit the scheduling of the thread that joins. The calling thread has
// ordinary scheduling afterwards: reading and preparing a large cell may take longer than a limit
// of real-time processor time (RLIMIT_RTTIME) allows.
Participant join(const DaemonOptions& options, const Cell& cell) {
  struct Restore {
    bool raised;
    ~Restore() {
      if (raised) log_refusal(use_fifo_scheduling(0));
    }
  };
  use_precise_timers();
  const int priority = port_priority(options);
  if (priority > 0) log_refusal(use_fifo_scheduling(priority));
  const Restore restore{priority > 0};
  return Participant(options.dds,
                     ros_node_name({log_name(), std::string(cell.shares.name()), options.partner}));
}

std::unique_ptr<Recording> open_recording(const std::shared_ptr<const Cell>& cell,
                                          const DaemonOptions& options, PoseReader& poses,
                                          RecordingHealth& health, const ResponseTimes& responses) {
  if (options.record_file.empty()) return nullptr;
  return std::make_unique<Recording>(options.record_file, options.recording, cell, poses, health,
                                     &responses);
}

// ROS 2 knows the default partition only.
void warn_of_partition(const Cell& cell, const DaemonOptions& all) {
  const DdsOptions& options = all.dds;
  const bool wants_ros = !cell.ros.trajectories.topics.empty() || writes_ros(cell) ||
                         !cell.ros.outputs.messages.empty() || TrackedFrames(cell).any() ||
                         !cell.scene.sensors.empty();
  if (options.partition.empty() || !wants_ros) return;
  log_line(lines::kPartitionWithoutRos, options.partition);
}

}  // namespace

// Members are made in the order of their dependencies: ports before the loop that uses them. The
// caller keeps the first cell.
Daemon::Daemon(const Cell& cell, const DaemonOptions& options)
    : options_(options),
      service_(fmt::format("cell '{}' at {} Hz", cell.scene.name, cell.scene.rate_hz)),
      reload_(cell, options.reload, service_, reload_actions()),
      participant_(join(options, cell)),
      time_(cell.ros.use_sim_time ? std::make_unique<SimulatedTime>() : nullptr),
      moveit_([this](SceneTask task) { return put(std::move(task)); }),
      poses_(
          cell, participant_,
          [this](moveit::RawScene message) { moveit_.take(std::move(message)); }, time_.get()),
      identity_(make_identity(options.partner)),
      partner_(options.partner.empty()
                   ? nullptr
                   : std::make_unique<Partnership>(cell, participant_, poses_, clock_, identity_)),
      now_(parts_of(std::shared_ptr<const Cell>(std::shared_ptr<const Cell>(), &cell))),
      messages_(cell, participant_),
      reports_(cell, participant_, *now_.queue, poses_, recording_health_, options.on_health,
               &messages_, identity_, partner_ ? &partner_->port : nullptr),
      recording_(
          open_recording(now_.cell, options, poses_, recording_health_, reports_.responses())),
      revision_(cell.scene.revision) {
  const TickLoopOptions loop{
      .max_ticks = options.max_ticks,
      .max_samples = kLargestBatchesATick *
                     (PoseReader::samples_a_batch(cell) + PoseReader::joints_a_batch(cell)),
      .ahead_ns = ahead_ns(),
      .pace = partner_ ? &partner_->ticks : nullptr,
      .frames = poses_.frames(),
      .time = time_.get()};
  PoseSource& source = partner_ ? static_cast<PoseSource&>(partner_->ticks) : poses_;
  loop_ = std::make_unique<TickLoop>(cell.scene, source, first_sinks(), clock_, loop);
  changer_ = std::make_unique<SceneChanger>(*loop_, now_.cell, static_cast<CellParts&>(*this));
  scene_thread_ =
      std::make_unique<SceneThread>(*changer_, *loop_, loop_ended_, std::move(options_.commander));
  if (partner_) share_states();
  if (partner_ || cell.ros.moveit.any()) share_scenes();
  clients_ = std::make_unique<ClientPorts>(now_.cell, participant_, reports_.daemon(), *loop_,
                                           loop_ended_, client_actions());
}

std::vector<ReportSink*> Daemon::first_sinks() {
  std::vector<ReportSink*> sinks{now_.queue.get()};
  if (recording_) sinks.insert(sinks.end(), {&recording_->frames(), &recording_->sink()});
  if (now_.ros) sinks.push_back(now_.ros.get());
  return sinks;
}

// Results do not go through put(): the reload itself notes the change.
CellReload::Actions Daemon::reload_actions() {
  return {.followed = [this] { return followed(); },
          .put = [this](GivenCommand given) { return scene_thread_->put(std::move(given)); },
          .note_change =
              [this](const CommandResult& result) {
                return note_change(result, {{"by", "SIGHUP or --reload"}});
              },
          .files = [this] { return changer_->cell().files; },
          .list_mistakes = options_.list_mistakes};
}

Daemon::~Daemon() {
  stop_sharing();
  end_requests();
}

Daemon::CellOutputs Daemon::parts_of(std::shared_ptr<const Cell> cell) {
  CellOutputs parts{std::move(cell), nullptr, nullptr};
  parts.queue = std::make_unique<ReportQueue>(
      parts.cell->scene, ReportQueueOptions{.reports = kQueuedReports, .awaits = ahead_ns() > 0});
  if (writes_ros(*parts.cell)) {
    const auto health = [this, &scene = parts.cell->scene,
                         queue = parts.queue.get()](const LoopStatistics& statistics) {
      return make_health(scene, statistics, poses_, queue->dropped_reports(), recording_health_,
                         &reports_.responses());
    };
    parts.ros = std::make_unique<RosWriter>(*parts.cell, participant_, health, leads());
  }
  return parts;
}

// The loop ticks in its own thread; this one waits for signals and watches the recording.
// Afterwards the queues are emptied, so that the last report is published and recorded.
void Daemon::run(StopSignal& signal) {
  if (options_.fifo_priority > 0) log_refusal(lock_memory());
  const Scene& scene = now_.cell->scene;
  log_line(lines::kStarted, scene.name, scene.revision, scene.rate_hz, participant_.where());
  note_start();
  log_line(lines::kHowToReach, participant_.how_to_reach());
  const SelfTest& test = loop_->state().monitor().self_test();
  log_line(lines::kSelfTest, (test.bytes() + 999) / 1000, test.ticks());
  for (const Robot& robot : scene.robots) {
    for (const std::string& note : robot.notes) log_line(lines::kRobotNote, robot.name, note);
  }
  for (const Sensor& sensor : scene.sensors) {
    for (const std::string& note : notes_of(sensor))
      log_line(lines::kSensorNote, sensor.name, note);
  }
  warn_of_partition(*now_.cell, options_);

  std::atomic<bool> done{false};
  const std::int64_t started = clock_.monotonic_ns();
  poses_.start();
  if (partner_) partner_->port.start(partner_actions());
  if (shares_) shares_->start();
  raise_priorities();
  std::thread ticking([&] { tick_thread(done); });
  scene_thread_->start();
  clients_->start();
  for (int polls = 0; !done && !yielded() && !signal.wait(kSignalPollMs);) {
    ++polls;
    if (signal.hung_up()) {
      reload_.read_again();
    } else if (polls % kPollsAReload == 0) {
      reload_.poll();
    }
    if (recording_) recording_->watch();
    service_.notice(reports_.published_cycle());
  }
  service_.stopping();
  const bool ended_by_itself = done;
  stop_ = true;
  ticking.join();
  stop_sharing();
  end_requests();
  seconds_ = 1e-9 * static_cast<double>(clock_.monotonic_ns() - started);

  reports_.finish();
  if (now_.ros) now_.ros->finish();
  if (recording_) recording_->finish();
  if (damaged())
    log_line(lines::kSelfTestFailed, loop_->state().monitor().self_test().fault(),
             loop_->state().cycle());
  log_line(lines::kStopped, counted(loop_->statistics().cycle, "tick"));
  if (options_.interventions == nullptr) return;
  options_.interventions->finish("stop", {{"ticks", loop_->statistics().cycle},
                                          {"cause", damaged()         ? "self-test"
                                                    : yielded()       ? "another daemon"
                                                    : ended_by_itself ? "--ticks"
                                                                      : "signal"}});
}

// Both threads are prepared and wait for work. join() has logged a refusal of this priority.
void Daemon::raise_priorities() {
  const int priority = port_priority(options_);
  if (priority == 0) return;
  (void)use_fifo_scheduling(priority, poses_.thread());
  (void)use_fifo_scheduling(priority, reports_.thread());
  if (!partner_) return;
  for (const auto thread : partner_->port.threads()) (void)use_fifo_scheduling(priority, thread);
}

// A refusal (no privilege) is logged and the daemon runs without it.
void Daemon::tick_thread(std::atomic<bool>& done) {
  name_thread("tick");
  if (options_.fifo_priority > 0) log_refusal(use_fifo_scheduling(options_.fifo_priority));
  if (options_.cpu) log_refusal(pin_to_cpu(*options_.cpu));
  loop_->run(stop_);
  done = true;
}

// The threads that answer do so through their port, so that the port ends last.
void Daemon::end_requests() {
  moveit_.close();
  loop_ended_ = true;
  if (clients_) clients_->end_questions();
  if (!scene_thread_ || still_reads_) return;
  still_reads_ = !scene_thread_->end();
  if (clients_ && !still_reads_) clients_->end_commands();
}

bool Daemon::put(SceneTask task) {
  if (AnswerCommand* const asked = answer_of(task)) {
    const auto note = options_.interventions != nullptr ? note_of(task) : nlohmann::ordered_json();
    *asked = [this, note, notes = notes_of(task),
              answer = std::move(*asked)](const CommandResult& result) {
      note_change(result, note);
      if (recording_) recording_->note_command();
      if (result.done())
        for (const std::string& text : notes)
          log_line(lines::kNoted, result.client, result.request, text);
      if (answer) answer(result);
    };
  }
  return scene_thread_->put(std::move(task));
}

// Returns false if nothing has changed.
bool Daemon::note_change(const CommandResult& result, const nlohmann::ordered_json& asked) {
  if (!result.done() || result.in_force_from == 0) return false;
  const std::uint64_t before = revision_;
  if (before == result.scene_revision) return false;
  if (shares_) shares_->note_change();
  revision_ = result.scene_revision;
  log_line(lines::kSceneChanged, result.scene_revision, result.in_force_from, before);
  if (options_.interventions == nullptr) return true;
  nlohmann::ordered_json note = asked;
  note["in_force_from"] = result.in_force_from;
  note.update(note_of(changer_->cell()));
  options_.interventions->note("scene-changed", note);
  return true;
}

void Daemon::note_start() const {
  if (options_.interventions == nullptr) return;
  nlohmann::ordered_json note = {{"build", kBuild},
                                 {"command_line", options_.command_line},
                                 {"daemon", fmt::format("{:016x}", identity_.id)},
                                 {"cell", now_.cell->scene.name}};
  note.update(note_of(*now_.cell));
  options_.interventions->note("start", note);
}

std::vector<ReportSink*> Daemon::prepare(const std::shared_ptr<const Cell>& cell) {
  moveit_.coming(cell->scene.revision, scene_thread_->in_hand());
  next_ = parts_of(cell);
  std::vector<ReportSink*> sinks{next_.queue.get()};
  if (ReportSink* const sink = recording_ ? recording_->prepare(cell) : nullptr)
    sinks.insert(sinks.end(), {&recording_->frames(), sink});
  if (next_.ros) sinks.push_back(next_.ros.get());
  return sinks;
}

// Returns when no other thread uses the cell before, except a recording, whose disk may be slow,
// and questions. Both keep it until they have ended.
void Daemon::follow(const SceneInForce& since) noexcept {
  reports_.continue_with(*next_.cell, since, *next_.queue);
  if (recording_) recording_->follow(since);
  poses_.change(*next_.cell);
  heard_cell_ = next_.cell;
  while (reports_.is_to_continue()) std::this_thread::sleep_for(kReportsPoll);
  if (now_.ros) now_.ros->finish();
  dropped_before_ += now_.queue->dropped_reports();
  now_ = std::move(next_);
  clients_->follow(now_.cell);
}

void Daemon::end(const LoopStatistics& figures) noexcept {
  if (!is_less(figures.minimum, least_before_)) return;
  least_before_ = figures.minimum;
  least_cell_ = now_.cell;
}

void Daemon::abandon() {
  if (recording_) recording_->abandon();
  next_ = {};
}

// Reports that DDS refused count as dropped, too.
std::string Daemon::summary() const {
  const std::uint64_t dropped =
      dropped_before_ + now_.queue->dropped_reports() + reports_.failed_writes();
  const LoopStatistics& figures = loop_->statistics();
  const bool is_before = is_less(least_before_, figures.minimum);
  return run_summary(figures, reports_.responses(), seconds_, dropped) +
         minimum_text(is_before ? least_before_ : figures.minimum,
                      is_before ? least_cell_->scene : now_.cell->scene) +
         (recording_ ? recording_->summary() : "");
}

std::string Daemon::histograms() const {
  const LoopStatistics& figures = loop_->statistics();
  return histograms_json({{"wakeup", figures.wakeup},
                          {"tick", figures.tick},
                          {"report", reports_.responses().delays()},
                          {"response", reports_.responses().slowest()}});
}

bool Daemon::damaged() const noexcept { return loop_->state().monitor().self_test().failed(); }
bool Daemon::recording_complete() const noexcept { return !recording_ || recording_->complete(); }
bool Daemon::recording_hangs() const noexcept { return recording_ && recording_->hangs(); }

}  // namespace clearance
