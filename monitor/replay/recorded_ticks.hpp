// The ticks of one recording in order, each with the messages that follow from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/recording/reader.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// A tick, by its time and cycle.
struct RecordedTick {
  std::optional<Sample<clearance_msg_Distances>> report;
  std::optional<Sample<clearance_msg_Separation>> separation;
  std::optional<Sample<clearance_msg_Gradients>> gradients;
  std::vector<clearance_msg_ZoneState> zones;  // that were written with this cycle
  std::int64_t log_ns = 0;                     // of the report
};

class RecordedTicks {
 public:
  // Source and sequence number. One source name belongs to one writer of poses or joint states.
  using BatchKey = std::pair<std::string, std::uint64_t>;
  struct Batch {
    std::int64_t log_ns;
    std::vector<std::byte> cdr;
  };

  explicit RecordedTicks(const std::filesystem::path& file) : reader_(file) {}

  // The first tick with a report, once all that belongs to it was read; null at the end.
  // Valid until pop().
  [[nodiscard]] const RecordedTick* front();
  // Removes that tick, and the batches that it and earlier ticks used.
  void pop();

  // Batches of ticks that were not removed.
  [[nodiscard]] const std::map<BatchKey, Batch>& batches() const noexcept { return batches_; }
  // False: the recording was made without this source's batches, as far as it was read.
  [[nodiscard]] bool has_batches_of(const std::string& source) const {
    return sources_.contains(source);
  }
  // The state of a zone after the front's tick; null: not known.
  [[nodiscard]] const clearance_msg_ZoneState* zone(std::uint32_t zone) const;
  [[nodiscard]] const std::map<std::uint32_t, clearance_msg_ZoneState>& zones() const noexcept {
    return zones_;
  }
  // The names of a scene revision's objects, pairs, zones and contacts, from its catalogue. A scene
  // without any if there was no catalogue.
  [[nodiscard]] const Scene& names(std::uint64_t revision);

  // Not empty: more than one daemon is in the file, or it cannot be read at all.
  [[nodiscard]] std::string error() const;
  // Not empty: the file is damaged; ticks before the damage were read.
  [[nodiscard]] std::string damage() const;
  [[nodiscard]] const std::set<std::string>& not_recorded() const noexcept {
    return reader_.not_recorded();
  }
  [[nodiscard]] std::string about(const std::string& key) const { return reader_.about(key); }

 private:
  bool read_one();
  void add_report(const RecordedMessage& message);
  template <class Message>
  [[nodiscard]] RecordedTick& tick_of(const Message& message) {
    return ticks_[{message.now_ns, message.cycle}];
  }
  template <class Message>
  void add_batch(const RecordedMessage& message);

  RecordingReader reader_;
  CdrDecoder decoder_;
  // Partners that join go on with the cycles of the other one, so that numbers may come again.
  std::map<std::pair<std::int64_t, std::uint64_t>, RecordedTick> ticks_;
  std::map<BatchKey, Batch> batches_;
  std::set<std::string> sources_;
  std::map<std::uint32_t, clearance_msg_ZoneState> zones_;
  std::map<std::uint64_t, Scene> names_;
  std::optional<std::uint64_t> daemon_;
  std::string refusal_;
  std::int64_t read_to_ns_ = 0;
  std::uint64_t removed_ = 0;
  bool ended_ = false;
};

}  // namespace clearance
