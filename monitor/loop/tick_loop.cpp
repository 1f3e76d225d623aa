// Sleeps until an absolute deadline, takes in the batches that have arrived, ticks, and hands over
// the report. Everything is allocated by the constructor.
#include "monitor/loop/tick_loop.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/input_owner.hpp"

#include "monitor/tick/self_test.hpp"

namespace clearance {
namespace {

// A loop whose ticks all overrun has no time to sleep. Under SCHED_FIFO it would then take its
// processor from all other threads, and the kernel would end it at a limit of real-time processor
// time (RLIMIT_RTTIME). Hence it sleeps this long after this time, in ns.
constexpr std::int64_t kLongestWithoutSleep = 50'000'000, kShortSleep = 10'000;
// Another thread asks so often whether its answer has come.
constexpr std::chrono::microseconds kAnswerPoll{50};
constexpr std::int64_t kNoStamp = std::numeric_limits<std::int64_t>::min();

}  // namespace

// All memory of the tick is sized here: the loop itself allocates nothing.
TickLoop::TickLoop(const Scene& scene, PoseSource& source, std::vector<ReportSink*> sinks,
                   Clock& clock, const TickLoopOptions& options)
    : state_(scene, {.room = options.max_samples, .frames = options.frames, .pace = options.pace}),
      source_(source),
      sinks_(std::move(sinks)),
      clock_(clock),
      options_(options),
      period_ns_(std::llround(1e9 / scene.rate_hz)),
      ticks_a_second_(std::max<std::uint64_t>(1, std::llround(scene.rate_hz))),
      phase_(period_ns_),
      statistics_(scene) {
  stamps_ns_.fill(kNoStamp);
  options_.ahead_ns = std::min(options_.ahead_ns, period_ns_ / 2);
}

// Measures the delay of the wake-up, and the time until the report was handed over.
void TickLoop::run(const std::atomic<bool>& stop) noexcept {
  std::int64_t deadline = clock_.monotonic_ns() + period_ns_;
  std::int64_t slept = deadline;  // the end of the last tick before a sleep
  std::uint64_t ticks = 0;
  while (!stop.load(std::memory_order_relaxed)) {
    deadline = wait(deadline);
    const std::int64_t started = clock_.monotonic_ns();
    if (!tick_once(deadline)) break;
    const std::int64_t ended = clock_.monotonic_ns();

    statistics_.wakeup.add(started - deadline);
    statistics_.tick.add(ended - started);
    statistics_.wakeup_second_max_ns =
        std::max(statistics_.wakeup_second_max_ns, started - deadline);
    statistics_.tick_second_max_ns = std::max(statistics_.tick_second_max_ns, ended - started);
    const std::int64_t correction = phase_.correction(deadline);
    deadline = options_.pace != nullptr && options_.pace->is_behind()
                   ? deadline + period_ns_
                   : next_deadline(deadline, ended) + correction;
    if (deadline - options_.ahead_ns > ended) slept = ended;
    if (ended - slept > kLongestWithoutSleep) {
      clock_.sleep_until(ended + kShortSleep);
      slept = ended;
    }
    ++ticks;
    if (options_.max_ticks != 0 && ticks == options_.max_ticks) break;
    if (ticks % ticks_a_second_ == 0) hand_over_statistics();
  }
  hand_over_statistics();
}

// With partners, what changes between two ticks does so before the inputs of the next one are
// decided on.
std::int64_t TickLoop::wait(std::int64_t deadline) noexcept {
  if (options_.pace == nullptr) {
    clock_.sleep_until(deadline - options_.ahead_ns);
    if (options_.ahead_ns > 0) get_ready(deadline);
    return deadline;
  }
  clock_.sleep_until(deadline - options_.pace->ahead_ns());
  between_ticks();
  note_delay();
  options_.pace->note_report_delay(delay_.longest_ns());
  return state_.decide(deadline);
}

// Waits for the deadline without sleeping, because a sleeping thread wakes some time after it.
// Tells the sinks first that a report is due.
void TickLoop::get_ready(std::int64_t deadline) noexcept {
  if (clock_.monotonic_ns() >= deadline) return;
  for (ReportSink* sink : sinks_) sink->expect(deadline);
  clock_.stay_awake_until(deadline);
}

// Deadlines stay on the grid of the first one. Missed ones are counted and skipped: a loop that
// tried to catch up would stay late.
std::int64_t TickLoop::next_deadline(std::int64_t deadline, std::int64_t ended) noexcept {
  const std::int64_t next = deadline + period_ns_;
  if (ended <= next) return next;
  ++statistics_.overruns;
  const std::int64_t missed = (ended - next) / period_ns_;
  statistics_.skipped_cycles += static_cast<std::uint64_t>(missed);
  return next + missed * period_ns_;
}

// Runs one tick and gives its report to every sink. The time of a tick with a pace is that of its
// deadline. False: the self-test has failed, so that no sink gets it.
bool TickLoop::tick_once(std::int64_t deadline) noexcept {
  TickPace* const pace = options_.pace;
  if (pace == nullptr) {
    between_ticks();
    note_delay();
  }
  take_in();
  note_stamps();
  const std::int64_t told_ns = pace == nullptr ? clock_.monotonic_ns() : deadline;
  const Report& report = state_.tick(tick_time());
  if (state_.monitor().self_test().failed()) return false;
  statistics_.late_responses += state_.monitor().response_is_late();
  start_report(told_ns, report);
  statistics_.cycle = report.cycle;
  statistics_.now_ns = report.now_ns;
  statistics_.clock_offset_ns = report.clock_offset_ns;
  statistics_.rejected_total = report.rejected;
  note_minimum(report);
  for (ReportSink* const sink : sinks_) {
    for (const ShownFrame& frame : state_.shown()) sink->frame(frame.sensor, frame.stamp_ns);
    if (pace != nullptr) sink->lineage(pace->lineage());
    sink->start(start_);
    sink->report(report, std::span(used_).first(used_count_));
  }
  state_.clear();
  return true;
}

TickTime TickLoop::tick_time() noexcept {
  if (options_.pace != nullptr) return options_.pace->time();
  TickTime time = options_.time == nullptr ? time_.read(clock_)
                                           : options_.time->tick_time(clock_.monotonic_ns());
  time.report_delay_ns = delay_.longest_ns();
  if (options_.time != nullptr && time.report_delay_ns != TickTime::kNotMeasured)
    time.report_delay_ns = options_.time->passes_in(time.report_delay_ns);
  return time;
}

void TickLoop::note_delay() noexcept {
  const std::int64_t now_ns = clock_.monotonic_ns();
  std::int64_t longest = TickTime::kNotMeasured;
  for (ReportSink* const sink : sinks_) longest = std::max(longest, sink->longest_delay(now_ns));
  delay_.add(now_ns, longest);
}

// The samples of a tick are those that came last: of each source, the oldest one counts until it
// sends again.
void TickLoop::note_stamps() noexcept {
  std::array<bool, kMaxSources> sends{};
  const auto note = [&](std::uint32_t source, std::int64_t stamp_ns) {
    if (source >= kMaxSources) return;
    const bool is_first = !std::exchange(sends[source], true);
    stamps_ns_[source] = is_first ? stamp_ns : std::min(stamps_ns_[source], stamp_ns);
  };
  for (const PoseSample& sample : state_.samples()) note(sample.source, sample.stamp_ns);
  for (const JointSample& sample : state_.joints()) note(sample.source, sample.stamp_ns);
}

// A source that is silent for long has no part in the report: what it sent is late.
void TickLoop::start_report(std::int64_t told_ns, const Report& report) noexcept {
  start_.told_ns = told_ns;
  start_.ages_ns.fill(-1);
  const std::int64_t now_ns = report.now_ns + report.clock_offset_ns;
  for (std::size_t i = 0; i < kMaxSources; ++i) {
    if (stamps_ns_[i] == kNoStamp) continue;
    const std::int64_t age_ns = elapsed(stamps_ns_[i], now_ns);
    if (age_ns <= kSourceSilentNs) start_.ages_ns[i] = age_ns;
  }
  const std::vector<Sensor>& sensors = state_.scene().sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const InputAge age = state_.monitor().input_age(sensors[i].object);
    if (age.age_ns <= kSourceSilentNs) start_.ages_ns[kMaxSources + i] = age.age_ns;
  }
}

bool TickLoop::offer(SceneOffer& offer) noexcept {
  SceneOffer* none = nullptr;
  return offered_.compare_exchange_strong(none, &offer, std::memory_order_acq_rel);
}

bool TickLoop::ask(LoopQuestion& question, const std::atomic<bool>& loop_ended) {
  LoopQuestion* none = nullptr;
  while (!asked_.compare_exchange_strong(none, &question, std::memory_order_acq_rel)) {
    none = nullptr;
    if (loop_ended) return false;
    std::this_thread::sleep_for(kAnswerPoll);
  }
  while (!question.is_answered() && !loop_ended) std::this_thread::sleep_for(kAnswerPoll);
  if (question.is_answered()) return true;
  LoopQuestion* asked = &question;
  asked_.compare_exchange_strong(asked, nullptr, std::memory_order_acq_rel);
  return false;
}

// The question's owner may delete it as soon as it is answered.
void TickLoop::answer_question() noexcept {
  LoopQuestion* const question = asked_.load(std::memory_order_acquire);
  if (question == nullptr) return;
  asked_.store(nullptr, std::memory_order_release);
  question->answer({state_.scene(), state_.monitor(), statistics_});
}

bool TickLoop::offer(JoinedState& joined) noexcept {
  JoinedState* none = nullptr;
  return joined_.compare_exchange_strong(none, &joined, std::memory_order_acq_rel);
}

void TickLoop::between_ticks() noexcept {
  answer_question();
  follow_offer();
  join();
}

// A state that cannot be joined now is let go.
void TickLoop::join() noexcept {
  JoinedState* const joined = joined_.load(std::memory_order_acquire);
  if (joined == nullptr || busy()) return;
  if (state_.may_join(*joined)) {
    state_.join(*joined);
    for (ReportSink* sink : sinks_) sink->joined(joined->lineage());
  }
  joined_.store(nullptr, std::memory_order_release);
}

// Between two ticks. An offer that has failed is dropped.
void TickLoop::follow_offer() noexcept {
  SceneOffer* const next = offered_.load(std::memory_order_acquire);
  if (next == nullptr) return;
  if (next->state() == Successor::State::kOffered) {
    state_.begin(*next);
  } else if (next->has_caught_up(state_.cycle())) {
    change_scene(*next);
  }
  if (next->failed()) state_.give_up();
  if (next->state() != Successor::State::kCatchingUp)
    offered_.store(nullptr, std::memory_order_release);
}

// The figures are exchanged first: another thread reads those of the former scene as soon as the
// successor has succeeded.
void TickLoop::change_scene(SceneOffer& offer) noexcept {
  offer.statistics_.continue_from(statistics_);
  std::swap(offer.statistics_, statistics_);
  std::swap(offer.sinks_, sinks_);
  state_.succeed();
}

// Batches are used whole: a batch that does not fit waits for the next tick.
void TickLoop::take_in() noexcept {
  used_count_ = 0;
  for (;;) {
    if (waiting_ == nullptr) waiting_ = source_.next();
    if (waiting_ == nullptr) return;
    const std::size_t taken = state_.samples().size() + state_.joints().size();
    if (taken + waiting_->size() > options_.max_samples) return;
    if (use(*waiting_)) {
      for (ReportSink* sink : sinks_) sink->input(*waiting_);
    }
    waiting_ = nullptr;
  }
}

// Poses for another scene have ids of other objects, so they are counted and not used. Joints have
// such ids only if they waited from before a change of the cell until a partner's state was joined.
// A recording has names instead, so a replay would use them. Returns false for these.
bool TickLoop::use(const PoseBatch& batch) noexcept {
  const bool is_used = state_.use(batch);
  if (!is_used && !batch.joints.empty()) return false;
  note_source(batch);
  note_phase(batch);
  if (is_used) return true;
  for (const PoseSample& sample : batch.samples)
    state_.monitor().refuse(sample.object, Reject::kWrongRevision);
  return true;
}

// The report names the last batch of each source; this makes a replay exact.
void TickLoop::note_source(const PoseBatch& batch) noexcept {
  const auto end = used_.begin() + static_cast<std::ptrdiff_t>(used_count_);
  const auto found = std::find_if(
      used_.begin(), end, [&batch](const SourceUse& use) { return use.source == batch.source; });
  if (found == used_.end()) return;  // the port admits at most kMaxSources
  if (found == end) ++used_count_;
  *found = {
      .source = batch.source, .sequence_number = batch.sequence_number, .content = batch.content};
}

// Of the robot that ticks follow: its joints, and not its base on tf, which has another clock.
void TickLoop::note_phase(const PoseBatch& batch) noexcept {
  const Scene& scene = state_.scene();
  if (scene.is_free_running() || batch.came_ns == 0 || !made_for(batch, scene.revision)) return;
  const auto is_followed = [&scene](std::uint32_t variable) {
    return variable < scene.variables.size() && scene.variables[variable].robot == scene.tick_on &&
           !scene.robots[scene.tick_on].is_of_base(variable);
  };
  const auto is_of_object = [&scene](const PoseSample& sample) {
    return sample.object < scene.objects.size() && sample.object == scene.tick_on_object;
  };
  if ((!batch.joints.empty() && is_followed(batch.joints.front().variable)) ||
      std::ranges::any_of(batch.samples, is_of_object))
    phase_.note(batch.came_ns);
}

// The smallest distance of the run, for the summary at its end.
void TickLoop::note_minimum(const Report& report) noexcept {
  const MinimumSeen found{.known = report.minimum_known,
                          .pair = report.minimum,
                          .cycle = report.cycle,
                          .now_ns = report.now_ns};
  if (is_less(found, statistics_.minimum)) statistics_.minimum = found;
}

// Called once per second. Figures that cover one second are reset afterwards.
void TickLoop::hand_over_statistics() noexcept {
  const Scene& scene = state_.scene();
  const Monitor& monitor = state_.monitor();
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    statistics_.rejected[object] = monitor.rejected(object);
    statistics_.ages[object] = monitor.input_age(object);
  }
  for (std::uint32_t variable = 0; variable < scene.variables.size(); ++variable) {
    statistics_.rejected_joints[variable] = monitor.rejected_joints(variable);
    statistics_.joint_ages[variable] = monitor.joint_age(variable);
  }
  std::ranges::copy(monitor.refused_poses(), statistics_.refused_poses.begin());
  std::ranges::copy(monitor.refused_positions(), statistics_.refused_positions.begin());
  for (std::uint32_t i = 0; i < kMaxSources; ++i)
    statistics_.sources[i] = state_.ids().sources().name(i);
  statistics_.clock_steps = time_.steps();
  for (ReportSink* sink : sinks_) sink->statistics(statistics_);
  statistics_.tick_second_max_ns = 0;
  statistics_.wakeup_second_max_ns = 0;
}

}  // namespace clearance
