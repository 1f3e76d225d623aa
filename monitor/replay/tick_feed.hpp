// Reads a recording, or a log of somebody else's, tick by tick: the poses that each tick of the
// daemon took in, and its time.
//
// Where the recording holds reports, a tick is a report: it gets its time, and the batches that the
// report names as used (by source and sequence number), wherever they stand in the file. Where it
// holds none, ticks are at a fixed rate, as the daemon's are, from the first batch on, and each
// gets the batches that came since the one before; or, without a rate, a tick is a distinct log
// time and gets the batches of that time in file order.
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

#include "config/scene/scene.hpp"
#include "monitor/bags/input_log.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/source_numbers.hpp"
#include "monitor/inputs/tick_time.hpp"
#include "monitor/intake/own_batches.hpp"
#include "monitor/recording/reader.hpp"
#include "monitor/replay/object_map.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// What Monitor::tick gets, and the report that the daemon made of it.
struct TickInput {
  TickTime time;
  std::vector<PoseSample> samples;
  std::vector<JointSample> joints;
  std::vector<SourceUse> sources;
  const clearance_msg_Distances* recorded = nullptr;  // null: the recording holds no reports
  // Of the same tick; null: the cell has no zone with `separation`, or it is not in the recording.
  const clearance_msg_Separation* separation = nullptr;
  bool restart = false;  // the daemon had been started anew: its monitor knew nothing
  bool complete = true;  // false: a source's last batch is not in the file, older poses stand in
};

// Reads ahead by at most two seconds of log time.
class TickFeed {
 public:
  // A recording of ours, in one file or several. `tick_hz`: unless it holds reports; 0: ticks at
  // log times.
  TickFeed(const std::vector<std::filesystem::path>& files, const Scene& scene,
           const RecordingOutline& outline, double tick_hz = 0.0);
  // Somebody else's.
  TickFeed(std::unique_ptr<InputLog> log, const Scene& scene, double tick_hz);

  // The next tick; its content is valid until the next call. False at the end or the damage.
  [[nodiscard]] bool next(TickInput& tick);

  [[nodiscard]] const ObjectMap& objects() const noexcept { return objects_; }
  // What the recording said of its zones so far, in file order.
  [[nodiscard]] const std::vector<clearance_msg_ZoneState>& zones() const noexcept {
    return zones_;
  }
  [[nodiscard]] const std::string& damage() const noexcept {
    return log_ ? log_->error() : reader_->error();
  }
  [[nodiscard]] double progress() const noexcept {
    return log_ ? log_->progress() : reader_->progress();
  }
  // Null: a recording of ours.
  [[nodiscard]] const InputLog* log() const noexcept { return log_.get(); }

  // Counts of what could not be used.
  [[nodiscard]] std::uint64_t batches() const noexcept { return batches_; }
  [[nodiscard]] std::uint64_t of_other_scenes() const noexcept { return of_other_scenes_; }
  [[nodiscard]] std::uint64_t not_in_the_file() const noexcept { return not_in_the_file_; }
  [[nodiscard]] std::uint64_t undecodable() const noexcept { return undecodable_; }
  // How often nothing came for so long that ticks at a fixed rate were left out.
  [[nodiscard]] std::uint64_t silences() const noexcept { return silences_; }

 private:
  struct Waiting {
    PoseBatch batch;
    std::int64_t log_ns = 0;
  };
  struct WaitingReport {
    Sample<clearance_msg_Distances> report;
    std::int64_t log_ns = 0;
  };

  [[nodiscard]] bool read_one();
  void read_message(const RecordedMessage& message);
  void read_inputs(const RecordedMessage& message);
  [[nodiscard]] bool next_by_report(TickInput& tick);
  [[nodiscard]] const clearance_msg_Separation* separation_of(std::int64_t now_ns);
  [[nodiscard]] bool next_by_time(TickInput& tick);
  [[nodiscard]] bool next_by_rate(TickInput& tick);
  void take_until_now(TickInput& tick);
  [[nodiscard]] bool all_there(std::span<const SourceUse> sources) const;
  [[nodiscard]] std::size_t place_of(const SourceUse& use) const;
  [[nodiscard]] bool consumed(const SourceUse& use) const;
  void take_used(TickInput& tick);
  void add(const PoseBatch& batch, TickInput& tick);
  void forget_unused(std::int64_t log_ns);

  std::unique_ptr<InputLog> log_;          // or
  std::optional<RecordingReader> reader_;  // this
  ObjectMap objects_;
  std::unique_ptr<OwnBatches> own_;  // null: somebody else's log
  SourceNumbers sources_;
  bool by_report_;
  double tick_hz_;             // 0: at log times
  std::int64_t began_ns_ = 0;  // the first tick at that rate
  std::int64_t last_batch_ns_ = 0;
  std::uint64_t at_rate_ = 0;  // ticks since then
  CdrDecoder decoder_;

  std::deque<Waiting> batches_waiting_;        // in file order
  std::deque<WaitingReport> reports_waiting_;  // in file order
  WaitingReport current_;
  bool separated_;                                                    // zones of the scene
  bool any_separation_ = false;                                       // has been read
  std::deque<Sample<clearance_msg_Separation>> separations_waiting_;  // in file order
  std::map<std::string, std::uint64_t> consumed_;  // by source: the last sequence number
  std::set<std::string> missing_;                  // sources whose last batch is not in the file
  std::vector<clearance_msg_ZoneState> zones_;
  std::int64_t read_to_ns_ = 0;
  std::uint64_t last_cycle_ = 0;
  std::uint64_t batches_ = 0, of_other_scenes_ = 0, not_in_the_file_ = 0, undecodable_ = 0;
  std::uint64_t silences_ = 0;
};

}  // namespace clearance
