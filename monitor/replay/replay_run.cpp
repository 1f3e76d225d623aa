#include "monitor/replay/replay_run.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "monitor/interface/log_line.hpp"
#include "monitor/interface/pair_name.hpp"
#include "monitor/replay/sensor_notes.hpp"

namespace clearance {
namespace {

// Seconds of an option, which may be infinite, as ns.
std::int64_t whole_ns(double seconds) {
  constexpr double kCentury = 3.2e9;  // s: fits
  return std::llround(std::min(seconds, kCentury) * 1e9);
}

Expected expected(const OfflineReplayOptions& options) {
  Expected all{options.expect_between, options.expect_no_zone, options.allow_unknown};
  if (options.expect_min_distance) all.distances.push_back({*options.expect_min_distance});
  return all;
}

// Nothing unless a reference was given.
std::optional<ReferenceCheck> reference_of(const Scene& scene,
                                           const OfflineReplayOptions& options) {
  if (options.reference.empty()) return std::nullopt;
  return ReferenceCheck(scene, options.reference, options.tolerance, options.mesh_errors);
}

}  // namespace

ReplayRun::ReplayRun(SceneHistory& history, TickFeed& feed, const OfflineReplayOptions& options,
                     const RecordingOutline& outline, MoveItChanges* moveit)
    : scene_(&history.first().scene),
      options_(options),
      has_reports_(outline.has_reports),
      has_zones_(outline.has_zones),
      some_without_pairs_(outline.some_without_pairs),
      other_build_(other_build(outline.build)),
      changes_left_out_(history.changes_left_out()),
      feed_(feed),
      loop_(history, moveit),
      moveit_(moveit),
      expectations_(*scene_, expected(options)),
      reference_(reference_of(*scene_, options)),
      zones_(*scene_) {
  follow(*scene_);
}

// The reason why the replay cannot be run at all; empty: it can.
std::string ReplayRun::refusal() const {
  if (feed_.log() != nullptr && !feed_.damage().empty()) return feed_.damage();
  if (!expectations_.error().empty()) return expectations_.error();
  if (reference_ && !reference_->error().empty()) return reference_->error();
  if (!feed_.objects().any()) {
    std::string text =
        "the recording has no object that moves in this cell; expected the cell that "
        "it was made for, or one with the same names";
    for (const std::string& note : feed_.objects().notes()) text += fmt::format("\n{}", note);
    return text;
  }
  if (has_reports_ && options_.tick_hz) {
    return "the recording holds the reports of the daemon's ticks, which are replayed as they "
           "were: no other rate of ticks can be asked for";
  }
  if (!options_.compare) return {};
  if (!has_reports_) return "nothing to compare with: the recording holds no reports";
  if (*options_.compare == Comparison::kBits && !feed_.objects().same_scene()) {
    return "nothing to compare with: the recording was made with another cell, or another state of "
           "this one (its scene revision differs)";
  }
  return {};
}

OfflineReplay ReplayRun::run(const std::function<void(const ReplayedTick&)>& on_tick) {
  result_.error = refusal();
  if (!result_.error.empty()) return std::move(result_);
  result_.notes = feed_.objects().notes();
  run_ticks(on_tick);
  if (feed_.log() != nullptr)
    std::ranges::copy(feed_.log()->notes(), std::back_inserter(result_.notes));
  if (moveit_ != nullptr) std::ranges::copy(moveit_->notes(), std::back_inserter(result_.notes));
  result_.damage = feed_.damage();
  result_.batches = feed_.batches();
  if (!result_.stopped && result_.error.empty()) judge_the_whole();
  note_counts();
  return std::move(result_);
}

// A stop is asked for before each tick, so that the ticks counted are whole.
void ReplayRun::run_ticks(const std::function<void(const ReplayedTick&)>& on_tick) {
  TickInput input;
  while (feed_.next(input)) {
    result_.stopped = options_.stop && options_.stop();
    if (result_.stopped) return;
    begin_tick(input);
    const Report* const report = loop_.tick(input);
    if (report == nullptr) {
      result_.error = loop_.error();
      return;
    }
    if (input.recorded != nullptr) cycle_offset_ = input.recorded->cycle - report->cycle;
    if (&loop_.cell().scene != scene_) change_scene(input, *report);
    end_tick(input, *report, on_tick);
    show_progress();
  }
  if (options_.progress) options_.progress(1.0);
}

// Judgements that are possible only after the last tick.
void ReplayRun::judge_the_whole() {
  compare_zones();
  if (result_.ticks == 0) {
    result_.error = nothing_in_window();
    return;
  }
  if (options_.compare && result_.compared == 0) {
    fail(0, last_ns_, "no report could be compared");
  }
  finish_reference();
  for (const std::string& what : unheard_sensors(loop_.sensors(), *scene_, feed_.log())) {
    if (feed_.log() == nullptr || !feed_.log()->has_topics()) {
      result_.notes.push_back(what);
    } else {
      fail(0, last_ns_, what);
    }
  }
  for (const Expectations::Broken& broken : expectations_.finish(loop_.monitor(), last_ns_))
    fail(broken.cycle, broken.now_ns, broken.what, broken.expectation);
  for (Expectations::Outcome& outcome : expectations_.outcomes()) {
    result_.expectations.push_back({std::move(outcome.expectation), std::move(outcome.least),
                                    number(outcome.cycle), seconds(outcome.now_ns)});
  }
  std::ranges::copy(expectations_.notes(), std::back_inserter(result_.notes));
  result_.not_judged = expectations_.not_judged();
}

// Replaces everything that belongs to one scene.
void ReplayRun::follow(const Scene& scene) {
  scene_ = &scene;
  if (!options_.compare) return;
  difference_ = std::make_unique<ReportDifference>(scene, *options_.compare, some_without_pairs_);
}

// Checks by name continue in the new scene.
void ReplayRun::change_scene(const TickInput& input, const Report& report) {
  has_changed_ = true;
  feed_.change(*scene_, loop_.cell());
  follow(loop_.cell().scene);
  expectations_.change(*scene_);
  if (reference_) reference_->change(*scene_);
  const std::uint64_t cycle = input.recorded != nullptr ? input.recorded->cycle : report.cycle;
  zones_.change(*scene_, cycle);
  const TickNumber tick{report.cycle, cycle};
  note("the cell {:016x} is in force from {} on ({:f} s)", scene_->revision, tick.text(),
       seconds(report.now_ns));
}

// A daemon that was started anew begins with a new monitor: its bounds and zones have no history.
// Cycle numbers of the daemon and of the replay differ by the number of ticks that the recording
// lacks.
void ReplayRun::begin_tick(const TickInput& input) {
  const std::int64_t now_ns = input.time.now_ns;
  if (ran_++ == 0) {
    first_ns_ = now_ns;
  } else if (now_ns < last_ns_) {
    note("the time goes back by {:f} s, {:f} s after the first tick: it is counted on from there",
         static_cast<double>(last_ns_ - now_ns) * 1e-9, seconds(last_ns_));
    first_ns_ -= last_ns_ - now_ns;
    result_.first_ns -= last_ns_ - now_ns;
  }
  last_ns_ = now_ns;
  if (input.restart) {
    restarted_ = true;
    note("the daemon was started anew, or another one goes on, {:f} s after the first tick",
         seconds(now_ns));
  }
  if (input.recorded == nullptr) return;
  const std::uint64_t cycle = input.recorded->cycle;
  const bool first = ran_ == 1 || input.restart;
  if (input.joined != 0) {
    if (result_.joins++ == 0) {
      note("the daemon took over the state of its partner, first before tick {} ({:f} s)", cycle,
           seconds(input.time.now_ns));
    }
  } else if (first) {
    if (cycle > 1) {
      note(
          "the recording begins at tick {} of the daemon: what the monitor knew by then is not in "
          "it, so only bounds can be compared",
          cycle);
    }
  } else if (cycle != last_recorded_cycle_ + 1) {
    if (!std::exchange(gap_noted_, true)) {
      note("reports are missing in the recording, the first between ticks {} and {}",
           last_recorded_cycle_, cycle);
    }
  }
  last_recorded_cycle_ = cycle;
}

// Expectations see every tick, since they begin when all objects are known; everything else
// only the ticks of the window.
void ReplayRun::end_tick(const TickInput& input, const Report& report,
                         const std::function<void(const ReplayedTick&)>& on_tick) {
  const std::int64_t after_ns = input.time.now_ns - first_ns_;
  const bool in_window =
      after_ns >= whole_ns(options_.start_s) && after_ns <= whole_ns(options_.end_s);
  for (const Expectations::Broken& broken :
       expectations_.check(report, loop_.monitor(), in_window)) {
    fail(broken.cycle, broken.now_ns, broken.what, broken.expectation);
  }
  if (options_.compare) {
    // Bounds for other poses say nothing about these.
    const char* const missing = input.complete ? loop_.missing() : RecordedLoop::kPosesMissing;
    const bool comparable = missing == nullptr || *options_.compare == Comparison::kBits;
    if (in_window && !comparable) ++not_comparable_;
    if (in_window && comparable && !differs_) compare(input, report, missing);
    zones_.replayed(report, cycle_offset_);
  }
  if (!in_window) return;
  if (result_.ticks++ == 0) result_.first_ns = input.time.now_ns;
  result_.last_ns = input.time.now_ns;
  if (reference_) {
    for (const std::string& what : reference_->check(report, loop_.monitor())) {
      fail(report.cycle, report.now_ns, what);
    }
  }
  const bool closer = report.minimum_known &&
                      (!result_.closest || report.minimum.distance < result_.closest->distance);
  if (closer) {
    result_.closest = report.minimum;
    result_.closest_pair = pair_name(*scene_, report.minimum);
    result_.closest_tick = {report.cycle, report.cycle + cycle_offset_};
  }
  result_.rejected = report.rejected;
  if (on_tick) on_tick({report, input.sources, loop_.monitor(), loop_.cell(), loop_.since()});
}

// Only the first difference is reported: later ones are its consequences.
void ReplayRun::compare(const TickInput& input, const Report& report, const char* missing) {
  const std::optional<std::string> found =
      difference_->first(input, report, cycle_offset_, feed_.run()->reader().not_recorded());
  ++result_.compared;
  if (!found) return;
  differs_ = true;
  const std::string what = fmt::format("the replay differs in {}", *found);
  fail(report.cycle, report.now_ns,
       missing == nullptr ? what + other_build_
                          : fmt::format("{}: it cannot be compared ({})", missing, what));
}

// Zone changes come on a topic of their own and are compared when all are known. The recording must
// be whole, since a change can depend on any tick before.
void ReplayRun::compare_zones() {
  if (!options_.compare || *options_.compare != Comparison::kBits || differs_ || !has_zones_)
    return;
  if (!result_.damage.empty() || cycle_offset_ != 0 || restarted_ || gap_noted_) return;
  // Cycles do not tell the scene of a zone then. The reports list the active zones, too.
  if (result_.joins > 0 && has_changed_) return;
  if (const auto found = zones_.first(feed_.run()->zones(), feed_.run()->reader().not_recorded())) {
    fail(found->cycle, found->now_ns,
         fmt::format("the replay differs in {}{}", found->what, other_build_));
  }
}

// The reason why no tick was judged.
std::string ReplayRun::nothing_in_window() {
  if (ran_ == 0 && feed_.log() != nullptr) return std::exchange(result_.damage, {});
  if (ran_ == 0) {
    return result_.damage.empty() ? "the recording holds neither reports nor poses"
                                  : "nothing can be replayed: no tick is whole before the damage";
  }
  return fmt::format("no tick lies between the start and the end given: the recording lasts {:f} s",
                     seconds(last_ns_));
}

// Reference values without a tick become notes. If no value has a tick, the check fails.
void ReplayRun::finish_reference() {
  if (!reference_) return;
  result_.reference = reference_->totals();
  for (const std::string& note : reference_->notes()) result_.notes.push_back(note);
  if (result_.reference->compared == 0) {
    fail(0, last_ns_, "no reference value could be compared");
  }
}

// A cycle of 0 stands for the replay as a whole.
TickNumber ReplayRun::number(std::uint64_t cycle) const {
  return {cycle, cycle > 0 ? cycle + cycle_offset_ : 0};
}

void ReplayRun::fail(std::uint64_t cycle, std::int64_t now_ns, const std::string& what,
                     const std::string& expectation) {
  result_.failures.push_back({number(cycle), now_ns, seconds(now_ns), what, expectation});
}

// Notes the totals of all that was left out, after the last tick.
void ReplayRun::note_counts() {
  std::ranges::copy(feed_.notes(options_.compare.has_value()), std::back_inserter(result_.notes));
  const auto note_count = [this](std::uint64_t count, std::string_view one, std::string_view more,
                                 std::string_view what) {
    if (count > 0) note("{} {}", counted(count, one, more), what);
  };
  note_count(changes_left_out_, "change of the recorded cell was",
             "changes of the recorded cell were",
             "not followed: this is another cell, and its bodies stay as it has them");
  note_count(loop_.of_other_scenes(), "batch was", "batches were",
             "made for another scene and left out");
  note_count(not_comparable_, "tick was", "ticks were",
             "not compared: this replay cannot have the poses, frames or partner's state in use");
  if (const Sensors* const sensors = loop_.sensors())
    std::ranges::copy(sensor_notes(*sensors, loop_.cell().scene),
                      std::back_inserter(result_.notes));
  for (std::size_t cause = 0; cause < kRejects; ++cause) {
    note_count(result_.rejected[cause], "pose or position of a joint was",
               "poses or positions of joints were",
               std::string("refused: ") + name(static_cast<Reject>(cause)));
  }
  const bool is_ahead = result_.rejected[static_cast<std::size_t>(Reject::kFuture)] > 0;
  if (is_ahead && feed_.log() != nullptr && !loop_.cell().ros.use_sim_time)
    note(
        "stamps are ahead of the times of recording: if those are of a simulation, say "
        "--use-sim-time");
}

// Calls `progress` about a hundred times, whatever the length of the recording.
void ReplayRun::show_progress() {
  const double share = feed_.progress();
  if (!options_.progress || share < shown_ + 0.01) return;
  shown_ = share;
  options_.progress(share);
}

}  // namespace clearance
