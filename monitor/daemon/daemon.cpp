// Creates the ports, the queues and the loop in the order of their dependencies. Runs the loop in a
// thread of its own, and empties the queues after the last tick. Scheduling is set before the
// threads that inherit it are created.
#include "monitor/daemon/daemon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "monitor/app/log_lines.hpp"
#include "monitor/intake/tracked_frames.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/loop/summary.hpp"

namespace clearance {
namespace {

// 64 ms of reports at 1 kHz; DDS writes seldom take longer.
constexpr std::size_t kQueuedReports = 64;
// The largest delay with which the end after --ticks is noticed.
constexpr std::int64_t kSignalPollMs = 50;
// The number of such intervals between two looks at the files of the cell.
constexpr int kPollsALook = 10;
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
Participant join(const DaemonOptions& options) {
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
  return Participant(options.dds);
}

std::unique_ptr<Recording> open_recording(const std::shared_ptr<const Cell>& cell,
                                          const DaemonOptions& options, PoseReader& poses,
                                          RecordingHealth& health) {
  if (options.record_file.empty()) return nullptr;
  return std::make_unique<Recording>(options.record_file, options.recording, cell, poses, health);
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
      cell_file_(cell.file.string()),
      service_(fmt::format("cell '{}' at {} Hz", cell.scene.name, cell.scene.rate_hz)),
      participant_(join(options)),
      moveit_([this](SceneTask task) { return put(std::move(task)); }),
      poses_(cell, participant_,
             [this](moveit::RawScene message) { moveit_.take(std::move(message)); }),
      identity_(make_identity(options.partner)),
      partner_(options.partner.empty()
                   ? nullptr
                   : std::make_unique<OfPartner>(cell, participant_, poses_, clock_, identity_)),
      now_(parts_of(std::shared_ptr<const Cell>(std::shared_ptr<const Cell>(), &cell))),
      messages_(cell, participant_),
      reports_(cell, participant_, *now_.queue, poses_, recording_health_, options.on_health,
               &messages_, identity_, partner_ ? &partner_->port : nullptr),
      recording_(open_recording(now_.cell, options, poses_, recording_health_)),
      revision_(cell.scene.revision) {
  watch_files(cell.files);
  const TickLoopOptions loop{
      .max_ticks = options.max_ticks,
      .max_samples = kLargestBatchesATick *
                     (PoseReader::samples_a_batch(cell) + PoseReader::joints_a_batch(cell)),
      .ahead_ns = ahead_ns(),
      .pace = partner_ ? &partner_->ticks : nullptr,
      .frames = poses_.frames()};
  std::vector<ReportSink*> sinks{now_.queue.get()};
  if (recording_) sinks.insert(sinks.end(), {&recording_->frames(), &recording_->sink()});
  if (now_.ros) sinks.push_back(now_.ros.get());
  PoseSource& source = partner_ ? static_cast<PoseSource&>(partner_->ticks) : poses_;
  loop_ = std::make_unique<TickLoop>(cell.scene, source, std::move(sinks), clock_, loop);
  changer_ = std::make_unique<SceneChanger>(*loop_, now_.cell, static_cast<CellParts&>(*this));
  scene_thread_ =
      std::make_unique<SceneThread>(*changer_, *loop_, loop_ended_, std::move(options_.commander));
  const auto revision = [this] { return revision_.load(); };
  if (partner_) {
    partner_states_ = std::make_unique<PartnerStates>(
        partner_->port, partner_->ticks, *loop_, *changer_, *scene_thread_, loop_ended_,
        recording_.get(), [this](SceneTask task) { return put(std::move(task)); }, revision);
  }
  if (cell.ros.moveit.any()) share_moveit();
  if (!cell.commands.from.empty()) {
    commands_ = std::make_unique<CommandPort>(
        cell, cell.commands.from, participant_, reports_.daemon(),
        [this](GivenCommand given) {
          return put(partner_ ? partner_states_->for_both(std::move(given)) : std::move(given));
        },
        revision, partner_ ? share_commands() : CommandPort::Sharing());
  }
  const RosTrajectories& trajectories = cell.ros.trajectories;
  const auto put_question = [this](QueuedQuestion question) {
    return desk_->put(std::move(question));
  };
  if (!cell.questions.from.empty() || !trajectories.topics.empty()) {
    desk_ = std::make_unique<QuestionDesk>(
        now_.cell, *loop_, loop_ended_, trajectories.topics.size(),
        [this](std::uint64_t of_scene) { return poses_.seen(of_scene); });
  }
  if (!cell.questions.from.empty()) {
    QuestionPort::Sharing sharing;
    if (partner_) sharing.takes = [this] { return partner_states_->takes_requests(); };
    questions_ =
        std::make_unique<QuestionPort>(cell, cell.questions.from, participant_, reports_.daemon(),
                                       put_question, revision, std::move(sharing));
  }
  if (!trajectories.topics.empty()) {
    trajectories_ = std::make_unique<TrajectoryPort>(cell.scene.name, trajectories, participant_,
                                                     put_question, leads());
  }
}

Daemon::~Daemon() {
  stop_sharing();
  end_requests();
}

Daemon::OfCell Daemon::parts_of(std::shared_ptr<const Cell> cell) {
  OfCell parts{std::move(cell), nullptr, nullptr};
  parts.queue = std::make_unique<ReportQueue>(
      parts.cell->scene, ReportQueueOptions{.reports = kQueuedReports, .awaits = ahead_ns() > 0});
  if (writes_ros(*parts.cell)) {
    const auto health = [this, &scene = parts.cell->scene,
                         queue = parts.queue.get()](const LoopStatistics& statistics) {
      return make_health(scene, statistics, poses_, queue->dropped_reports(), recording_health_);
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
  log_line(lines::kHowToReach, participant_.how_to_reach());
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
  if (commands_) commands_->start();
  if (desk_) desk_->start();
  if (questions_) questions_->start();
  if (trajectories_) trajectories_->start();
  for (int polls = 0; !done && !gave_way() && !signal.wait(kSignalPollMs);) {
    ++polls;
    const bool looks = polls % kPollsALook == 0;
    if (signal.hung_up() || (looks && (files_changed() || wants_to_read_))) read_again();
    if (recording_) recording_->watch();
    service_.notice(reports_.published_cycle());
  }
  service_.stopping();
  stop_ = true;
  ticking.join();
  stop_sharing();
  end_requests();
  seconds_ = 1e-9 * static_cast<double>(clock_.monotonic_ns() - started);

  reports_.finish();
  if (now_.ros) now_.ros->finish();
  if (recording_) recording_->finish();
  log_line(lines::kStopped, counted(loop_->statistics().cycle, "tick"));
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
  if (desk_) desk_->end();
  questions_.reset();
  trajectories_.reset();
  if (!scene_thread_ || still_reads_) return;
  still_reads_ = !scene_thread_->end();
  if (!still_reads_) commands_.reset();
}

bool Daemon::put(SceneTask task) {
  if (AnswerCommand* const asked = answer_of(task)) {
    *asked = [this, answer = std::move(*asked)](const CommandResult& result) {
      note_change(result);
      if (recording_) recording_->note_command();
      if (answer) answer(result);
    };
  }
  return scene_thread_->put(std::move(task));
}

// Returns false if nothing has changed.
bool Daemon::note_change(const CommandResult& result) {
  if (!result.done() || result.in_force_from == 0) return false;
  const std::uint64_t before = revision_;
  if (before == result.scene_revision) return false;
  if (shares_) shares_->note_change();
  revision_ = result.scene_revision;
  log_line(lines::kSceneChanged, result.scene_revision, result.in_force_from, before);
  return true;
}

// The cell's own file counts even where another text is in force.
void Daemon::watch_files(const std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> all = files;
  all.emplace_back(cell_file_);
  files_.watch(all);
}

// A cell that was read again may name other files.
bool Daemon::files_changed() {
  std::optional<std::vector<std::filesystem::path>> read;
  {
    const std::lock_guard lock(read_mutex_);
    read = std::exchange(read_files_, std::nullopt);
  }
  if (read) watch_files(*read);
  return options_.reload && files_.changed();
}

// Only the daemon that others follow reads the file. The others get the cell from it.
void Daemon::read_again() {
  const auto standing = partner_ ? partner_->ticks.standing() : PartnerStanding::kLeading;
  wants_to_read_ = standing == PartnerStanding::kStarting;
  if (wants_to_read_) return;
  log_line(lines::kReading, cell_file_);
  service_.reloading();
  const std::string followed = standing != PartnerStanding::kLeading ? "the leading partner"
                               : shares_ && !shares_->is_first()
                                   ? fmt::format("the share '{}'", shares_->first())
                                   : "";
  if (!followed.empty()) {
    const std::string counts = fmt::format("the cell of {} counts", followed);
    log_line(lines::kSceneRefused, counts + ": have that one read it");
    return service_.reloaded(counts);
  }
  const auto answer = [this](const CommandResult& result) {
    if (result.done()) {
      {
        const std::lock_guard lock(read_mutex_);
        read_files_ = changer_->cell().files;
      }
      const bool is_new = note_change(result);
      if (!is_new) log_line(lines::kSceneUnchanged);
      service_.reloaded(is_new ? "the changed cell is in force" : "the cell has not changed");
      return;
    }
    const bool has_mistakes = result.status == CommandStatus::kRefused && options_.list_mistakes;
    if (has_mistakes) options_.list_mistakes();
    log_line(lines::kSceneRefused, has_mistakes ? "its mistakes are listed above" : result.reason);
    service_.reloaded("the changed cell was refused: see the log");
  };
  wants_to_read_ =
      !scene_thread_->put(GivenCommand{{.client = "", .changes = {ReadCellAgain{}}}, true, answer});
  if (!wants_to_read_) return;
  log_line(lines::kSceneRefused, "too many commands wait: it is tried again");
  service_.reloaded("the cell waits to be read again: see the log");
}

std::vector<ReportSink*> Daemon::prepare(const std::shared_ptr<const Cell>& cell) {
  moveit_.coming(cell->scene.revision);
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
  while (reports_.is_to_continue()) std::this_thread::sleep_for(kReportsPoll);
  if (now_.ros) now_.ros->finish();
  dropped_before_ += now_.queue->dropped_reports();
  now_ = std::move(next_);
  if (desk_) desk_->follow(now_.cell);
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
  return run_summary(figures, seconds_, dropped) +
         minimum_text(is_before ? least_before_ : figures.minimum,
                      is_before ? least_cell_->scene : now_.cell->scene) +
         (recording_ ? recording_->summary() : "");
}

bool Daemon::recording_complete() const noexcept { return !recording_ || recording_->complete(); }
bool Daemon::recording_hangs() const noexcept { return recording_ && recording_->hangs(); }

}  // namespace clearance
