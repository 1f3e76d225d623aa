// Reads the file ahead until the batches of the next tick are known, and keeps what belongs to
// later ticks. Batches are identified by source and sequence number.
#include "monitor/replay/tick_feed.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/intake/scene_keeper.hpp"
#include "monitor/interface/log_line.hpp"

namespace clearance {
namespace {

// After this time without a batch every pose is late, and more ticks show nothing new. A log may
// have pauses of hours.
constexpr std::int64_t kSilenceNs = 10'000'000'000;

}  // namespace

TickFeed::TickFeed(const std::vector<std::filesystem::path>& files, SceneHistory& history,
                   const RecordingOutline& outline, double tick_hz)
    : history_(&history),
      objects_(history.first().scene, outline.catalogue ? &**outline.catalogue : nullptr),
      own_(std::make_unique<OwnBatches>(history.first().scene)),
      own_revision_(history.first().scene.revision),
      by_report_(outline.has_reports),
      tick_hz_(tick_hz) {
  const Scene& scene = history.first().scene;
  const RecordedRunOptions options{
      .separations = history.has_changes() || separated_count(scene).any(),
      .gradients = history.has_changes() || scene.gradients,
      .frames = by_report_ && !scene.sensors.empty(),
      .states = by_report_};
  run_ = std::make_unique<RecordedRun>(
      files, options, [this](const RecordedMessage& message) { read_message(message); });
}

TickFeed::TickFeed(std::unique_ptr<InputLog> log, const Scene& scene, double tick_hz,
                   std::span<const std::int64_t> also_at)
    : log_(std::move(log)),
      objects_(scene, nullptr),
      by_report_(false),
      tick_hz_(tick_hz),
      also_at_(also_at.rbegin(), also_at.rend()) {}

// Recordings with reports are replayed tick by tick as the daemon ran.
bool TickFeed::next(TickInput& tick) {
  tick.batches.clear();
  tick.sources.clear();
  tick.scenes.clear();
  tick.sensors.clear();
  tick.frames.clear();
  tick.recorded = nullptr;
  tick.separation = nullptr;
  tick.gradients = nullptr;
  tick.joined = 0;
  tick.state = nullptr;
  tick.restart = false;
  tick.complete = true;
  if (by_report_) return next_by_report(tick);
  return tick_hz_ > 0.0 ? next_by_rate(tick) : next_by_time(tick);
}

// The cells of a recording are known beforehand (read_catalogue).
void TickFeed::change(const Scene& before, const Cell& now) {
  if (!log_) return;
  const SceneMap map = scene_map(before, now.scene);
  for (LoggedBatch& waiting : waiting_) pass_on(map, before, now.scene, waiting.batch);
  log_->change(now);
}

bool TickFeed::read_one() {
  if (!log_) return run_->read_one();
  LoggedBatch logged;
  if (!log_->next(logged)) return false;
  read_to_ns_ = logged.log_ns;
  waiting_.push_back(std::move(logged));
  return true;
}

void TickFeed::read_message(const RecordedMessage& message) {
  const bool is_input =
      message.kind == TopicKind::kPoses || message.kind == TopicKind::kJointStates;
  if (is_input) read_inputs(message);
  if (message.kind == TopicKind::kCatalogue) read_catalogue(message);
}

// Poses that a daemon used get the ids of the cell of the replay, if that is another one. Joints
// are matched by name in any cell.
void TickFeed::read_inputs(const RecordedMessage& message) {
  PoseBatch* const batch = own_->decode(message.kind, message.cdr);
  if (batch == nullptr) {
    ++undecodable_;
    return;
  }
  if (message.kind == TopicKind::kJointStates) {
    batch->scene_revision = own_revision_;
  } else if (!objects_.translate(*batch)) {
    // This is a batch of another scene. The daemon counted it as used too, but used none of its
    // poses.
    batch->samples.clear();
    ++of_other_scenes_;
  }
  waiting_.push_back({.batch = std::move(*batch), .log_ns = message.log_ns});
}

// The messages after a catalogue were used by its scene.
void TickFeed::read_catalogue(const RecordedMessage& message) {
  if (objects_.same_scene() && !history_->has_changes()) return;
  Sample<clearance_msg_Catalogue> catalogue;
  if (!decoder_.decode(message.cdr, catalogue)) return;
  if (!objects_.same_scene()) return objects_.add(*catalogue);
  const Cell* const cell = history_->cell(catalogue->scene_revision);
  if (cell == nullptr || cell->scene.revision == own_revision_) return;
  own_ = std::make_unique<OwnBatches>(cell->scene);
  own_revision_ = cell->scene.revision;
}

// A report names the last batch of each source that its tick used. In a recording over DDS that
// batch may stand behind the report, so reading goes on for a while.
bool TickFeed::next_by_report(TickInput& tick) {
  if (!run_->next()) return false;
  const clearance_msg_Distances& report = run_->report();
  tick.recorded = &report;
  tick.time = {report.now_ns, report.clock_offset_ns, report.report_delay_ns};
  tick.joined = run_->joined();
  tick.state = run_->state();
  tick.restart = run_->is_restart();
  if (tick.restart) consumed_.clear();
  if (tick.restart || tick.joined != 0) missing_.clear();
  for (std::uint32_t i = 0; i < report.sources._length; ++i) {
    const clearance_msg_SourceUse& use = report.sources._buffer[i];
    tick.sources.push_back({SourceName(use.source), use.sequence_number});
  }
  while (!all_there(tick.sources) && run_->read_ahead()) {
  }
  use_up_to(tick);
  tick.frames = run_->frames();
  tick.separation = run_->separation();
  tick.gradients = run_->gradients();
  tick.complete = missing_.empty();
  forget_unused(run_->log_ns());
  return true;
}

// Returns the batch's index among the waiting batches, or their number if it is not there.
std::size_t TickFeed::place_of(const SourceUse& use) const {
  const auto found = std::ranges::find_if(waiting_, [&use](const LoggedBatch& waiting) {
    return waiting.batch.sequence_number == use.sequence_number &&
           waiting.batch.source == use.source;
  });
  return static_cast<std::size_t>(found - waiting_.begin());
}

// A report may name the batch that an earlier tick used already: then this tick had no new one.
bool TickFeed::consumed(const SourceUse& use) const {
  const auto last = consumed_.find(use.source.c_str());
  return last != consumed_.end() && last->second == use.sequence_number;
}

// Returns true when the batches that a report names have been read or were used before.
bool TickFeed::all_there(std::span<const SourceUse> sources) const {
  return std::ranges::all_of(sources, [this](const SourceUse& use) {
    return place_of(use) < waiting_.size() || consumed(use);
  });
}

// Uses everything of each source up to the batch that is named, all sources in file order.
void TickFeed::use_up_to(TickInput& tick) {
  const std::vector<SourceUse>& sources = tick.sources;
  std::vector<std::size_t> until;  // by source: one past the place of its last batch
  for (const SourceUse& use : sources) {
    const std::size_t place = place_of(use);
    const bool found = place < waiting_.size();
    if (found) {
      missing_.erase(use.source.c_str());
    } else if (!consumed(use)) {
      ++not_in_the_file_;
      missing_.insert(use.source.c_str());
    }
    until.push_back(found ? place + 1 : 0);
    consumed_[use.source.c_str()] = use.sequence_number;
  }
  // One pass keeps the order of the file among all sources, which the tick depends on.
  std::size_t place = 0;
  std::erase_if(waiting_, [&](LoggedBatch& waiting) {
    const std::size_t here = place++;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (here >= until[i] || !(waiting.batch.source == sources[i].source)) continue;
      add(waiting.batch, tick);
      return true;
    }
    return false;
  });
}

void TickFeed::add(PoseBatch& batch, TickInput& tick) {
  ++batches_;
  if (!batch.empty()) tick.batches.push_back(std::move(batch));
}

// Drops batches that have waited longer than the feed reads ahead. No report has named them, so the
// daemon did not use them.
void TickFeed::forget_unused(std::int64_t log_ns) {
  while (!waiting_.empty() && waiting_.front().log_ns < less(log_ns, kLogDisorderNs)) {
    waiting_.pop_front();
  }
}

std::vector<std::string> TickFeed::notes(bool compared) const {
  std::vector<std::string> notes;
  const auto note = [&notes](std::uint64_t count, std::string_view one, std::string_view more,
                             std::string_view what) {
    if (count > 0) notes.push_back(fmt::format("{} {}", counted(count, one, more), what));
  };
  note(not_in_the_file_, "batch that a tick used is", "batches that a tick used are",
       "not in the recording");
  note(run_ ? run_->of_others() : 0, "report is", "reports are",
       "of a daemon that ran beside the one that is replayed: left out");
  note(of_other_scenes_, "batch was", "batches were",
       "made for a scene that the recording does not name");
  note(silences_, "pause was", "pauses were",
       "longer than 20 s: after 10 s, ticks were left out until something came");
  note(undecodable_ + (run_ ? run_->undecodable() : 0), "message is", "messages are",
       "not what the channel says: left out");
  if (!compared || !run_) return notes;
  note(run_->all_gradients().unwanted(), "message of gradients was", "messages of gradients were",
       "not compared: the cell asks for none");
  note(run_->separations().unmatched() + run_->all_gradients().unmatched(),
       "message of gradients or separation belongs", "messages of gradients or separation belong",
       "to no report");
  if (const auto& fields = run_->reader().not_recorded(); !fields.empty()) {
    notes.push_back(
        fmt::format("the recording does not have these fields, which were not compared: {}",
                    fmt::join(fields, ", ")));
  }
  return notes;
}

// Makes one tick of all batches with the same log time.
bool TickFeed::next_by_time(TickInput& tick) {
  while (waiting_.empty()) {
    if (!read_one()) return false;
  }
  tick.time.now_ns = waiting_.front().log_ns;
  while (read_to_ns() == tick.time.now_ns && read_one()) {
  }
  use_until_now(tick);
  return true;
}

// A tick without a batch is made only while a further batch is known: after the last batch there
// are no more ticks but those of also_at_.
bool TickFeed::next_by_rate(TickInput& tick) {
  while (waiting_.empty() && read_one()) {
  }
  if (waiting_.empty() && also_at_.empty()) return false;
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  const std::int64_t next_ns = waiting_.empty() ? kNever : waiting_.front().log_ns;
  const auto now_at = [this](std::uint64_t number) {
    return began_ns_ + std::llround(static_cast<double>(number) * 1e9 / tick_hz_);
  };
  const bool silent = at_rate_ > 0 && next_ns - last_batch_ns_ > 2 * kSilenceNs &&
                      now_at(at_rate_) - last_batch_ns_ > kSilenceNs;
  const bool begins = at_rate_ == 0 || silent;
  const std::int64_t at_rate_ns = waiting_.empty() ? kNever : begins ? next_ns : now_at(at_rate_);
  if (!also_at_.empty() && also_at_.back() < at_rate_ns) {
    tick.time.now_ns = also_at_.back();
  } else {
    if (begins) {
      began_ns_ = next_ns;
      at_rate_ = 0;
      if (silent) ++silences_;
    }
    ++at_rate_;
    tick.time.now_ns = at_rate_ns;
  }
  while (!also_at_.empty() && also_at_.back() <= tick.time.now_ns) also_at_.pop_back();
  while (read_to_ns() <= tick.time.now_ns && read_one()) {
  }
  use_until_now(tick);
  return true;
}

// Moves all batches up to the tick's time into the tick, in the order in which they came.
void TickFeed::use_until_now(TickInput& tick) {
  while (!waiting_.empty() && waiting_.front().log_ns <= tick.time.now_ns) {
    auto& scene = waiting_.front().scene;
    const bool is_silence = scene && scene->cdr.empty();
    if (!is_silence) last_batch_ns_ = waiting_.front().log_ns;
    if (scene) {
      tick.scenes.push_back(std::move(scene));
      waiting_.pop_front();
      continue;
    }
    if (auto& sensor = waiting_.front().sensor) {
      tick.sensors.push_back(std::move(sensor));
      waiting_.pop_front();
      continue;
    }
    PoseBatch& batch = waiting_.front().batch;
    if (batch.empty()) {
      waiting_.pop_front();
      continue;
    }
    const SourceUse last{batch.source, batch.sequence_number};
    add(batch, tick);
    const auto use = std::ranges::find(tick.sources, last.source, &SourceUse::source);
    if (use != tick.sources.end()) {
      *use = last;
    } else if (tick.sources.size() < kMaxSources) {
      tick.sources.push_back(last);
    }
    waiting_.pop_front();
  }
}

}  // namespace clearance
