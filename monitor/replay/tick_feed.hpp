// Reads a recording, or a log of another program, tick by tick: the poses that each tick of the
// daemon took in, and its time.
//
// If the recording holds reports, each report is a tick. The tick gets the report's time and the
// batches that the report names as used, wherever they stand in the file. The names are source and
// sequence number. If it holds none, ticks are at a fixed rate, as the daemon's are, from the first
// batch on. Each gets the batches that came since the tick before. Without a rate, each distinct
// log time is a tick and gets the batches of that time in file order.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "monitor/bags/input_log.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/tick_time.hpp"
#include "monitor/intake/own_batches.hpp"
#include "monitor/recording/reader.hpp"
#include "monitor/replay/object_map.hpp"
#include "monitor/replay/scene_history.hpp"
#include "monitor/replay/side_feed.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// A frame that the daemon built, and the cycle of the tick that was shown it; 0: none was.
struct RecordedFrame {
  std::uint64_t cycle = 0;
  BuiltFrame frame;
};

// The input of Monitor::tick, and the report that the daemon made of it.
struct TickInput {
  TickTime time;
  std::vector<PoseBatch> batches;  // in the order of use, with the ids of the scene that they state
  std::vector<SourceUse> sources;
  // Messages of MoveIt in a log, up to this tick.
  std::vector<std::shared_ptr<const moveit::RawScene>> scenes;
  // Likewise, messages of sensors.
  std::vector<std::shared_ptr<const RawSensorMessage>> sensors;
  // In a recording: frames of sensors up to this tick, each with the cycle of the tick that was
  // shown it.
  std::vector<RecordedFrame> frames;
  const clearance_msg_Distances* recorded = nullptr;  // null: the recording holds no reports
  // Messages of the same tick. Null if the scene asks for none, or if the recording has none of
  // this tick.
  const clearance_msg_Separation* separation = nullptr;
  const clearance_msg_Gradients* gradients = nullptr;
  // The daemon went on from a state of its partner, and this is the number of that state in the
  // recording. 0: it went on from its own.
  std::uint64_t joined = 0;
  const clearance_msg_PartnerState* state = nullptr;  // that one; null: it cannot be read
  bool restart = false;  // the daemon had been started anew, so its monitor had no history
  bool complete = true;  // false: a source's last batch is not in the file, so older poses replace
                         // it
};

// The messages of one topic that a daemon writes every tick beside its report, in file order. A
// tick's time is its own, so that it tells which tick they belong to.
template <class Message>
class TickMessages {
 public:
  explicit TickMessages(bool wanted) : wanted_(wanted) {}
  void add(std::span<const std::byte> cdr, CdrDecoder& decoder);
  // The message of the tick at `now_ns`; null: there is none. In a recording over DDS it may stand
  // behind the report: `read_ahead` reads one message more and returns false at the limit. After
  // one search in vain nothing is read ahead until a message comes, since most recordings have all
  // or none.
  template <class ReadAhead>
  [[nodiscard]] const Message* of_tick(std::int64_t now_ns, const ReadAhead& read_ahead);
  // The number of messages that came although the scene asks for none.
  [[nodiscard]] std::uint64_t unwanted() const noexcept { return unwanted_; }
  // The number of messages that belong to no report. Those from before the first report do not
  // count.
  [[nodiscard]] std::uint64_t unmatched() const noexcept { return unmatched_; }

 private:
  bool wanted_;  // by the scene
  bool expected_ = true;
  std::uint64_t unwanted_ = 0, unmatched_ = 0;
  std::optional<std::int64_t> matched_ns_;  // of the last tick that was asked for
  std::deque<Sample<Message>> waiting_;
};

// Reads ahead by at most two seconds of log time.
class TickFeed {
 public:
  // Reads one of Clearance's own recordings, in one file or several. If it was made with the first
  // cell of the history, joints get the ids of the scene that was in force. Otherwise everything
  // gets the ids of that cell. `tick_hz` is used only if the recording holds no reports. 0: a tick
  // at each log time. The history must outlive this.
  TickFeed(const std::vector<std::filesystem::path>& files, SceneHistory& history,
           const RecordingOutline& outline, double tick_hz = 0.0);
  // Reads a log of another program.
  TickFeed(std::unique_ptr<InputLog> log, const Scene& scene, double tick_hz);

  // The next tick; its content is valid until the next call. False at the end or the damage.
  [[nodiscard]] bool next(TickInput& tick);

  [[nodiscard]] const ObjectMap& objects() const noexcept { return objects_; }
  // The states of zones in the recording so far, in file order.
  [[nodiscard]] const std::vector<clearance_msg_ZoneState>& zones() const noexcept {
    return zones_;
  }
  [[nodiscard]] const std::string& damage() const noexcept {
    return log_ ? log_->error() : reader_->error();
  }
  [[nodiscard]] double progress() const noexcept {
    return log_ ? log_->progress() : reader_->progress();
  }
  // Null if this reads one of Clearance's own recordings.
  [[nodiscard]] const InputLog* log() const noexcept { return log_.get(); }

  // The number of batches that ticks used.
  [[nodiscard]] std::uint64_t batches() const noexcept { return batches_; }
  // Sentences about what could not be used so far. `compared`: also about what was not compared.
  [[nodiscard]] std::vector<std::string> notes(bool compared) const;
  // Fields that the recording's build did not have: RecordingReader::not_recorded().
  [[nodiscard]] const std::set<std::string>& not_recorded() const noexcept { return not_recorded_; }

 private:
  using Waiting = LoggedBatch;
  struct WaitingReport {
    Sample<clearance_msg_Distances> report;
    std::int64_t log_ns = 0;
    std::uint64_t joined = 0;  // RecordingReader::joined()
  };

  [[nodiscard]] bool read_one();
  void read_message(const RecordedMessage& message);
  void read_inputs(const RecordedMessage& message);
  void read_catalogue(const RecordedMessage& message);
  [[nodiscard]] bool next_by_report(TickInput& tick);
  [[nodiscard]] bool read_ahead();
  [[nodiscard]] bool next_by_time(TickInput& tick);
  [[nodiscard]] bool next_by_rate(TickInput& tick);
  void take_until_now(TickInput& tick);
  [[nodiscard]] bool all_there(std::span<const SourceUse> sources) const;
  [[nodiscard]] std::size_t place_of(const SourceUse& use) const;
  [[nodiscard]] bool consumed(const SourceUse& use) const;
  void take_used(TickInput& tick);
  void take_state(TickInput& tick);
  void take_frames(std::uint64_t cycle, TickInput& tick);
  void add(PoseBatch& batch, TickInput& tick);
  void forget_unused(std::int64_t log_ns);

  std::unique_ptr<InputLog> log_;          // or
  std::optional<RecordingReader> reader_;  // this
  std::optional<FrameFeed> frames_;        // and this, if the cell has sensors
  std::optional<StateFeed> states_;        // and this
  Sample<clearance_msg_PartnerState> state_;
  std::uint64_t joined_ = 0;         // the number of the last state
  SceneHistory* history_ = nullptr;  // null: a log of another program
  ObjectMap objects_;
  std::unique_ptr<OwnBatches> own_;  // null: a log of another program
  std::uint64_t own_revision_ = 0;   // of the scene whose ids it gives to joints
  bool by_report_;
  double tick_hz_;             // 0: at log times
  std::int64_t began_ns_ = 0;  // the first tick at that rate
  std::int64_t last_batch_ns_ = 0;
  std::uint64_t at_rate_ = 0;  // ticks since then
  CdrDecoder decoder_;

  std::deque<Waiting> batches_waiting_;        // in file order
  std::deque<WaitingReport> reports_waiting_;  // in file order
  WaitingReport current_;
  TickMessages<clearance_msg_Separation> separations_;
  TickMessages<clearance_msg_Gradients> gradients_;
  std::set<std::string> not_recorded_;
  std::map<std::string, std::uint64_t> consumed_;  // by source: the last sequence number
  std::set<std::string> missing_;                  // sources whose last batch is not in the file
  std::vector<clearance_msg_ZoneState> zones_;
  std::int64_t read_to_ns_ = 0;
  std::uint64_t last_cycle_ = 0;
  std::uint64_t batches_ = 0, of_other_scenes_ = 0, not_in_the_file_ = 0, undecodable_ = 0;
  std::uint64_t silences_ = 0;
};

}  // namespace clearance
