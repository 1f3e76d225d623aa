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
#include <set>
#include <span>
#include <string>
#include <vector>

#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/tick_time.hpp"
#include "monitor/intake/own_batches.hpp"
#include "monitor/recording/input_log.hpp"
#include "monitor/replay/object_map.hpp"
#include "monitor/replay/recorded_run.hpp"
#include "monitor/replay/scene_history.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// The input of Monitor::tick, and the report that the daemon made of it.
struct TickInput {
  TickTime time;
  std::vector<PoseBatch> batches;  // in the order of use, with the ids of the scene that they state
  std::vector<SourceUse> sources;
  // Messages of MoveIt in a log, up to this tick.
  std::vector<std::shared_ptr<const moveit::RawScene>> scenes;
  // Likewise, messages of sensors.
  std::vector<std::shared_ptr<const RawSensorMessage>> sensors;
  std::vector<RecordedFrame> frames;                  // in a recording: those up to this tick
  const clearance_msg_Distances* recorded = nullptr;  // null: the recording holds no reports
  // Messages of the same tick. Null if the scene asks for none, or if the recording has none of
  // this tick.
  const clearance_msg_Separation* separation = nullptr;
  const clearance_msg_Gradients* gradients = nullptr;
  std::uint64_t joined = 0;                           // RecordedRun::joined()
  const clearance_msg_PartnerState* state = nullptr;  // that one; null: it cannot be read
  bool restart = false;  // the daemon had been started anew, so its monitor had no history
  bool complete = true;  // false: a source's last batch is not in the file, so older poses replace
                         // it
};

class TickFeed {
 public:
  // Reads one of Clearance's own recordings, in one file or several. If it was made with the first
  // cell of the history, joints get the ids of the scene that was in force. Otherwise everything
  // gets the ids of that cell. `tick_hz` is used only if the recording holds no reports. 0: a tick
  // at each log time. The history must outlive this.
  TickFeed(const std::vector<std::filesystem::path>& files, SceneHistory& history,
           const RecordingOutline& outline, double tick_hz = 0.0);
  // Reads a log of another program. `also_at`: times of further ticks, ns, in ascending order.
  TickFeed(std::unique_ptr<InputLog> log, const Scene& scene, double tick_hz,
           std::span<const std::int64_t> also_at = {});
  TickFeed(const TickFeed&) = delete;
  TickFeed& operator=(const TickFeed&) = delete;

  // The next tick; its content is valid until the next call. False at the end or the damage.
  [[nodiscard]] bool next(TickInput& tick);

  // A message of the log has changed the scene, and the next tick is of this cell, which must
  // outlive this.
  void change(const Scene& before, const Cell& now);

  [[nodiscard]] const ObjectMap& objects() const noexcept { return objects_; }
  // The recording's ticks, and what was read of them; null: a log of another program.
  [[nodiscard]] const RecordedRun* run() const noexcept { return run_.get(); }
  [[nodiscard]] const std::string& damage() const noexcept {
    return log_ ? log_->error() : run_->reader().error();
  }
  [[nodiscard]] double progress() const noexcept {
    return log_ ? log_->progress() : run_->reader().progress();
  }
  // Null if this reads one of Clearance's own recordings.
  [[nodiscard]] const InputLog* log() const noexcept { return log_.get(); }

  // The number of batches that ticks used.
  [[nodiscard]] std::uint64_t batches() const noexcept { return batches_; }
  // Sentences about what could not be used so far. `compared`: also about what was not compared.
  [[nodiscard]] std::vector<std::string> notes(bool compared) const;

 private:
  [[nodiscard]] bool read_one();
  [[nodiscard]] std::int64_t read_to_ns() const noexcept {
    return log_ ? read_to_ns_ : run_->read_to_ns();
  }
  void read_message(const RecordedMessage& message);
  void read_inputs(const RecordedMessage& message);
  void read_catalogue(const RecordedMessage& message);
  [[nodiscard]] bool next_by_report(TickInput& tick);
  [[nodiscard]] bool next_by_time(TickInput& tick);
  [[nodiscard]] bool next_by_rate(TickInput& tick);
  void use_until_now(TickInput& tick);
  [[nodiscard]] bool all_there(std::span<const SourceUse> sources) const;
  [[nodiscard]] std::size_t place_of(const SourceUse& use) const;
  [[nodiscard]] bool consumed(const SourceUse& use) const;
  void use_up_to(TickInput& tick);
  void add(PoseBatch& batch, TickInput& tick);
  void forget_unused(std::int64_t log_ns);

  std::unique_ptr<InputLog> log_;     // or
  std::unique_ptr<RecordedRun> run_;  // this
  SceneHistory* history_ = nullptr;   // null: a log of another program
  ObjectMap objects_;
  std::unique_ptr<OwnBatches> own_;  // null: a log of another program
  std::uint64_t own_revision_ = 0;   // of the scene whose ids it gives to joints
  bool by_report_;
  double tick_hz_;                     // 0: at log times
  std::vector<std::int64_t> also_at_;  // those that are left, the last one first
  std::int64_t began_ns_ = 0;          // the first tick at that rate
  std::int64_t last_batch_ns_ = 0;
  std::uint64_t at_rate_ = 0;  // ticks since then
  CdrDecoder decoder_;

  std::deque<LoggedBatch> waiting_;                // in file order
  std::map<std::string, std::uint64_t> consumed_;  // by source: the last sequence number
  std::set<std::string> missing_;                  // sources whose last batch is not in the file
  std::int64_t read_to_ns_ = 0;                    // of the log
  std::uint64_t batches_ = 0, of_other_scenes_ = 0, not_in_the_file_ = 0, undecodable_ = 0;
  std::uint64_t silences_ = 0;
};

}  // namespace clearance
