// Walks through one of Clearance's own recordings, tick by tick. A tick is a report, with the
// messages of the same tick on other topics.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "monitor/recording/bag.hpp"
#include "monitor/recording/reader.hpp"
#include "monitor/replay/side_feed.hpp"
#include "monitor/replay/tick_messages.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// A frame that the daemon built, and the cycle of the tick that was shown it; 0: none was.
struct RecordedFrame {
  std::uint64_t cycle = 0;
  BuiltFrame frame;
};

struct RecordedRunOptions {
  bool separations = true, gradients = true;  // they are wanted
  bool frames = false, states = false;        // of sensors, and of partners: their files are read
};

// A recorder over DDS writes its topics only nearly in order. So what belongs to a tick may stand
// behind its report, by up to kLogDisorderNs of log time. It is read when it is asked for.
class RecordedRun {
 public:
  // Receives batches and catalogues, in file order, when they are read.
  using Use = std::function<void(const RecordedMessage& message)>;
  RecordedRun(const std::vector<std::filesystem::path>& files, const RecordedRunOptions& options,
              Use use);
  RecordedRun(const RecordedRun&) = delete;
  RecordedRun& operator=(const RecordedRun&) = delete;

  // Goes on to the next report; false at the end or the damage. Where several daemons published at
  // once, as partners do, the reports are those of one, as long as it publishes. Everything that is
  // returned by a pointer or reference is valid until the next call.
  [[nodiscard]] bool next();
  // Reads one message behind the report. False: there is none that could belong to its tick.
  bool read_ahead() { return read_to_ns_ < tick_.log_ns + kLogDisorderNs && read_one(); }
  // Reads one message, wherever it stands. False at the end or the damage.
  bool read_one();

  [[nodiscard]] const clearance_msg_Distances& report() const noexcept { return *tick_.report; }
  [[nodiscard]] std::int64_t log_ns() const noexcept { return tick_.log_ns; }
  // The daemon had been started anew, or another one goes on, so that its monitor has no history.
  [[nodiscard]] bool is_restart() const noexcept { return is_restart_; }
  // The daemon went on from a state of its partner, and this is the number of that state in the
  // recording. 0: it went on from its own.
  [[nodiscard]] std::uint64_t joined() const noexcept { return joins_ ? joined_ : 0; }
  // Returns that state; null: it cannot be read.
  [[nodiscard]] const clearance_msg_PartnerState* state();
  // Frames that the daemon built up to this tick and after the one before. One that no tick was
  // shown stands before another one that was.
  [[nodiscard]] std::vector<RecordedFrame> frames();
  // Null: not wanted, or not in the recording.
  [[nodiscard]] const clearance_msg_Separation* separation();
  [[nodiscard]] const clearance_msg_Gradients* gradients();

  // The states of zones so far, in file order.
  [[nodiscard]] const std::vector<clearance_msg_ZoneState>& zones() const noexcept {
    return zones_;
  }
  [[nodiscard]] const TickMessages<clearance_msg_Separation>& separations() const noexcept {
    return separations_;
  }
  [[nodiscard]] const TickMessages<clearance_msg_Gradients>& all_gradients() const noexcept {
    return gradients_;
  }
  // The number of reports of daemons that ran beside the one that is replayed.
  [[nodiscard]] std::uint64_t of_others() const noexcept { return of_others_; }
  // The number of reports that do not decode.
  [[nodiscard]] std::uint64_t undecodable() const noexcept { return undecodable_; }
  [[nodiscard]] std::int64_t read_to_ns() const noexcept { return read_to_ns_; }
  [[nodiscard]] const RecordingReader& reader() const noexcept { return reader_; }

 private:
  [[nodiscard]] bool goes_on(std::uint64_t daemon);

  struct Tick {
    Sample<clearance_msg_Distances> report;
    std::int64_t log_ns = 0;
    std::uint64_t joined = 0;  // RecordingReader::joined()
  };

  RecordingReader reader_;
  std::optional<FrameFeed> frames_;
  std::optional<StateFeed> states_;
  Use use_;
  CdrDecoder decoder_;
  std::deque<Tick> waiting_;  // in file order
  Tick tick_;
  TickMessages<clearance_msg_Separation> separations_;
  TickMessages<clearance_msg_Gradients> gradients_;
  std::vector<clearance_msg_ZoneState> zones_;
  Sample<clearance_msg_PartnerState> state_;
  bool is_restart_ = false, joins_ = false;
  std::uint64_t joined_ = 0;  // the number of the last state
  std::uint64_t last_cycle_ = 0, undecodable_ = 0, of_others_ = 0;
  std::int64_t read_to_ns_ = 0;
  std::int64_t own_ns_ = 0;  // log time of the last report that was replayed
};

}  // namespace clearance
