// A thread empties a queue of batches and reports into the recorder. The queue is bounded: when a
// slow disk has filled it, further messages are counted as missing.
#include "monitor/daemon/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include "monitor/app/log_line.hpp"
#include "monitor/files/build_info.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/publish/health.hpp"
#include "monitor/recording/event_files.hpp"

namespace clearance {
namespace {

// The queue covers a stalled disk for a second at 1 kHz with a cell of usual size, and less with a
// huge one.
constexpr std::size_t kMostSlots = 1024, kFewestSlots = 64;
constexpr std::size_t kQueueBytes = std::size_t{64} << 20;

// The time for which the disk may take nothing at the end.
constexpr int kDiskPatienceMs = 2000;
// The time between two log lines about a slow disk.
constexpr std::int64_t kLogEveryNs = 1'000'000'000;

// The number of slots that fit into the memory for a queue.
std::size_t slots(std::size_t bytes_a_slot) {
  return std::clamp(kQueueBytes / std::max<std::size_t>(bytes_a_slot, 1), kFewestSlots, kMostSlots);
}

// Reports of every tick, and a pose or position of everything that moves, before compression.
double bytes_a_second(const Scene& scene, const RecordingOptions& options) {
  const auto published = std::ranges::count_if(scene.pairs, &ObjectPair::publish);
  const auto moving =
      std::ranges::count_if(scene.objects, [](const Object& object) { return !object.fixed; });
  const double reports = static_cast<double>(sizeof(clearance_msg_Distances)) +
                         static_cast<double>(sizeof(clearance_msg_PairDistance)) *
                             static_cast<double>(published) /
                             static_cast<double>(options.pairs_every);
  const double inputs =
      static_cast<double>(sizeof(clearance_msg_ObjectPose)) * static_cast<double>(moving);
  return (reports + inputs) * scene.rate_hz;
}

// A slot of a report holds at most all pairs, a slot of a batch as many poses as the reader takes.
ReportQueueOptions queue_options(const Cell& cell) {
  const Scene& scene = cell.scene;
  const std::size_t samples = PoseReader::samples_a_batch(cell);
  const std::size_t joints = PoseReader::joints_a_batch(cell);
  return {.reports = slots(sizeof(PairReport) * scene.pairs.size() +
                           sizeof(PairSeparation) * separated_count(scene).pairs),
          .inputs = slots(sizeof(PoseSample) * samples + sizeof(JointSample) * joints),
          .samples_a_batch = samples,
          .joints_a_batch = joints};
}

// The cap is known from here on, so that the log and the files have the same one.
RecordingOptions capped(RecordingOptions options, const std::filesystem::path& file,
                        const Cell& cell) {
  EventOptions& events = options.events;
  if (!events.any()) return options;
  const bool is_stated = events.keep_bytes.has_value();
  events.keep_bytes = event_cap(file, events);
  const std::string most =
      *events.keep_bytes == 0
          ? "any size, as stated,"
          : fmt::format("{:.0f} MB{}", std::ceil(1e-6 * static_cast<double>(*events.keep_bytes)),
                        is_stated ? "" : ", a tenth of the free disk,");
  log_line(lines::kEventsCapped, (file.parent_path() / file.stem()).string(), most,
           1e-6 * bytes_a_second(cell.scene, options));
  return options;
}

}  // namespace

Recording::Part::Part(std::shared_ptr<const Cell> the_cell)
    : cell(std::move(the_cell)), queue(cell->scene, queue_options(*cell)) {}

// The file and its catalogue are written before the first tick, so that errors show at the start.
Recording::Recording(const std::filesystem::path& file, const RecordingOptions& options,
                     std::shared_ptr<const Cell> cell, PoseReader& poses, RecordingHealth& health,
                     const ResponseTimes* responses)
    : file_(file.string()),
      by_event_(options.events.any()),
      files_(by_event_ ? 0 : 1),
      clouds_every_(options.clouds_every),
      poses_(poses),
      built_(poses.keep_frames()),
      health_(health),
      responses_(responses),
      recorder_(file, *cell, cell->ros.use_sim_time ? 0 : SystemClock().realtime_ns(),
                capped(options, file, *cell)) {
  if (!recorder_.ok()) throw RecordError(fmt::format("recording: {}", recorder_.error()));
  tell_of_missing_files();
  health_.begin(file_);
  parts_.push_back(std::make_unique<Part>(std::move(cell)));
  thread_ = std::thread([this] { run(); });
}

Recording::~Recording() { finish(); }

// Ends the thread when the queue is empty. A second call does nothing.
void Recording::finish() {
  if (!thread_.joinable()) return;
  {
    const Lock lock(mutex_);
    parts_.back()->queue.close();
  }
  wait_for_the_disk();
  hangs_ = !ended_;
  if (hangs_) {
    thread_.detach();
    log_line(lines::kDiskHangs, file_);
  } else {
    thread_.join();
  }
  watch();
  complete_ = !hangs_ && !health_.failed() && missing() == 0;
}

// Waits until the thread has ended, or has given nothing to the disk for kDiskPatienceMs.
void Recording::wait_for_the_disk() const {
  std::uint64_t steps = steps_;
  for (int waited_ms = 0; !ended_ && waited_ms < kDiskPatienceMs; ++waited_ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (steps_ != steps) waited_ms = 0;
    steps = steps_;
  }
}

ReportSink* Recording::prepare(std::shared_ptr<const Cell> cell) {
  {
    const Lock lock(mutex_);
    if (parts_.size() >= kMostWaiting) {
      fail(fmt::format("the disk is too slow: {} changes of the cell wait for it", kMostWaiting));
    }
  }
  if (health_.failed()) return nullptr;
  prepared_ = std::make_unique<Part>(std::move(cell));
  return &prepared_->queue;
}

void Recording::follow(const SceneInForce& since) {
  const Lock lock(mutex_);
  parts_.back()->queue.close();
  if (!prepared_) return;
  prepared_->since = since;
  parts_.push_back(std::move(prepared_));
  parts_[parts_.size() - 2]->queue.wake();
}

// Empties one queue after the other, each until it is closed.
void Recording::run() {
  name_thread("record");
  // A file can wait: this thread needs no priority.
  if (const Refusal refusal = use_fifo_scheduling(0)) log_line(lines::kSystemRefuses, *refusal);
  do {
    Part* part = nullptr;
    {
      const Lock lock(mutex_);
      part = parts_.front().get();
    }
    for (bool closed = false; !closed;) {
      part->queue.wait();
      closed = part->queue.closed();  // read before the queue, so that nothing remains in it
      record_all(*part);
    }
  } while (next_part());
  recorder_.close();
  count(0);
  ended_ = true;
}

// Returns false if no other cell follows. The recorder uses the cell before until it has changed.
bool Recording::next_part() {
  Part* next = nullptr;
  {
    const Lock lock(mutex_);
    if (parts_.size() == 1) return false;
    next = parts_[1].get();
  }
  recorder_.change(*next->cell, next->since);
  tell_of_missing_files();
  count(0);
  const Lock lock(mutex_);
  reports_dropped_before_ += parts_.front()->queue.dropped_reports();
  inputs_dropped_before_ += parts_.front()->queue.dropped_inputs();
  parts_.pop_front();
  return true;
}

// The batches that a report used are in the queue before it; batches for later reports may be there
// as well.
void Recording::record_all(Part& part) {
  ReportQueue& queue = part.queue;
  while (const QueuedReport* queued = queue.reports().front()) {
    while (const PoseBatch* batch = queue.inputs().front()) {
      recorder_.poses(*batch);
      queue.inputs().pop();
      count(1);
    }
    if (queued->joined != 0) record_state(queued->joined);
    if (built_ != nullptr) record_frames(queued->report.cycle);
    if (command_came_.exchange(false))
      recorder_.ask_for_file({RecordedEvent::Cause::kCommand, "a command was answered"});
    recorder_.report(queued->report, queued->sources(), queued->handed_over_ns, queued->lineage);
    queue.reports().pop();
    count(1);
    tell_of_new_files();
  }
  while (const LoopStatistics* statistics = queue.statistics().front()) {
    recorder_.health(
        *make_health(part.cell->scene, *statistics, poses_, dropped().first, health_, responses_));
    queue.statistics().pop();
    recorder_.check();
    count(0);
  }
}

// A frame that a tick was shown is built already. Those before it, which no tick was shown, have
// changed what later ones hide.
void Recording::record_frames(std::uint64_t cycle) {
  const auto record = [this](const BuiltFrame& frame, std::uint64_t of_cycle, bool is_kept) {
    recorder_.frame(frame.stamp_ns, encoder_.encode(*to_wire(frame, of_cycle, is_kept)));
  };
  for (; const FrameUses::Use* const use = uses_.uses().front(); uses_.uses().pop()) {
    if (use->cycle > cycle) return;
    bool is_there = false;
    for (const BuiltFrame& frame : built_->take(use->sensor, use->stamp_ns)) {
      const bool is_shown = frame.stamp_ns == use->stamp_ns;
      is_there |= is_shown;
      record(frame, is_shown ? use->cycle : 0, clouds_every_ > 0 && frames_++ % clouds_every_ == 0);
    }
    if (!is_there) {
      BuiltFrame lost;
      lost.sensor = use->sensor;
      lost.stamp_ns = use->stamp_ns;
      record(lost, use->cycle, false);
    }
    count(1);
  }
}

void Recording::note_state(const PartnerStateView& state) {
  CdrEncoder encoder;
  const auto cdr = encoder.encode(*to_wire(state, kBuild));
  const Lock lock(mutex_);
  states_.emplace_back(state.lineage, std::vector(cdr.begin(), cdr.end()));
  if (states_.size() > kMostStates) states_.pop_front();
}

// States before it were not taken over. One that is missing here, since the disk is too slow for
// the reports between, is missing for a replay as well.
void Recording::record_state(std::uint64_t lineage) {
  const Lock lock(mutex_);
  const auto state = std::ranges::find(states_, lineage, [](const auto& one) { return one.first; });
  const bool is_there = state != states_.end();
  recorder_.joined(is_there ? std::span<const std::byte>(state->second)
                            : std::span<const std::byte>());
  if (is_there) states_.erase(states_.begin(), state + 1);
}

void Recording::tell_of_missing_files() const {
  if (recorder_.without_files().empty()) return;
  log_line(lines::kRecordingWithoutFiles, recorder_.without_files());
}

void Recording::tell_of_new_files() {
  if (recorder_.files() == files_) return;
  files_ = recorder_.files();
  const bool is_event = std::exchange(events_, recorder_.events()) != recorder_.events();
  log_line(is_event ? lines::kEventRecorded : lines::kRecordingContinues,
           recorder_.file().string());
}

// Called after the recorder was given so many reports or batches. If it has failed by then, they
// count as missing.
void Recording::count(std::uint64_t messages) {
  ++steps_;
  if (recorder_.ok()) return;
  fail(recorder_.error());
  unwritten_ += messages;
}

void Recording::fail(const std::string& why) {
  if (!failing_.exchange(true)) health_.fail(why);
}

// Reports and batches that found a queue full.
std::pair<std::uint64_t, std::uint64_t> Recording::dropped() const {
  const Lock lock(mutex_);
  std::pair sum(reports_dropped_before_, inputs_dropped_before_);
  for (const auto& part : parts_) {
    sum.first += part->queue.dropped_reports();
    sum.second += part->queue.dropped_inputs();
  }
  return sum;
}

// Messages that found the queue full, and messages after the file had failed.
std::uint64_t Recording::missing() const {
  const auto [reports, inputs] = dropped();
  return reports + inputs + unwritten_;
}

// Logs a failure once, and a slow disk once per second while messages are lost.
void Recording::watch() {
  health_.set_missing(missing());
  if (health_.failed()) {
    if (!std::exchange(failure_logged_, true)) log_line(lines::kRecordingStopped, health_.state());
    return;
  }
  const auto [reports, inputs] = dropped();
  const std::int64_t now_ns = SystemClock().monotonic_ns();
  if (reports + inputs == dropped_logged_ || now_ns - logged_ns_ < kLogEveryNs) return;
  log_line(lines::kDiskTooSlow, counted(reports, "report"), counted(inputs, "batch", "batches"));
  dropped_logged_ = reports + inputs;
  logged_ns_ = now_ns;
}

std::string Recording::files_text() const {
  const std::string last = recorder_.file().string();
  if (by_event_) {
    return files_ == 0
               ? fmt::format("no file: there was no event for {}", file_)
               : fmt::format("{} of events, the last one {}", counted(files_, "file"), last);
  }
  return files_ == 1 ? file_ : fmt::format("{} and {} more, to {}", file_, files_ - 1, last);
}

// Returns the lines for stdout at the end of a run. If the thread still waits for the disk, the
// recorder's state is not known.
std::string Recording::summary() const {
  if (complete_) {
    return fmt::format("recorded {}, {:.1f} MB, in {}\n", counted(recorder_.messages(), "message"),
                       1e-6 * static_cast<double>(recorder_.bytes()), files_text());
  }
  const std::string why = hangs_             ? "the disk takes nothing"
                          : health_.failed() ? health_.state()
                                             : "the disk was too slow";
  return fmt::format("recording INCOMPLETE in {}: {}; {} reports and batches are missing\n", file_,
                     why, missing());
}

}  // namespace clearance
