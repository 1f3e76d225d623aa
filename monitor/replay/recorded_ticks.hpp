// One recording as a comparison of two reads it: its ticks, each once all that belongs to it was
// read, with the batches and the states of zones.
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
#include "monitor/replay/recorded_run.hpp"

namespace clearance {

struct RecordedTick {
  const clearance_msg_Distances& report;
  const clearance_msg_Separation* separation;  // null: it has none
  const clearance_msg_Gradients* gradients;
};

class RecordedTicks {
 public:
  // Source and sequence number. One source name belongs to one writer of poses or joint states.
  using BatchKey = std::pair<std::string, std::uint64_t>;
  struct Batch {
    std::int64_t log_ns;
    std::vector<std::byte> cdr;
  };

  explicit RecordedTicks(const std::filesystem::path& file);

  // The first tick; null at the end. Valid until pop().
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
  [[nodiscard]] const Scene& names(std::uint64_t revision) { return names_[revision]; }

  // Says why there are no ticks: more than one daemon is in the file, or it cannot be read at all.
  [[nodiscard]] std::string error() const;
  // Says where the file is damaged, or nothing; ticks before the damage were read.
  [[nodiscard]] std::string damage() const;
  [[nodiscard]] const std::set<std::string>& not_recorded() const noexcept {
    return run_.reader().not_recorded();
  }
  [[nodiscard]] std::string about(const std::string& key) const { return run_.reader().about(key); }

 private:
  void use(const RecordedMessage& message);
  template <class Message>
  void add_batch(const RecordedMessage& message);

  RecordedRun run_;
  CdrDecoder decoder_;
  std::optional<RecordedTick> front_;
  std::map<BatchKey, Batch> batches_;
  std::set<std::string> sources_;
  std::map<std::uint32_t, clearance_msg_ZoneState> zones_;
  std::size_t zones_taken_ = 0;
  std::map<std::uint64_t, Scene> names_;
  std::optional<std::uint64_t> daemon_;
  std::string refusal_;
  std::uint64_t removed_ = 0;
};

}  // namespace clearance
