// The messages of our topics in a recording, in file order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "monitor/files/reader.hpp"
#include "monitor/recording/layout_change.hpp"
#include "monitor/recording/topic_schema.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// The number that a key of metadata has; 0: there is none.
[[nodiscard]] std::uint64_t number_of(const McapMap& values, const std::string& key);

// One message of ours; not decoded yet, since most readers want some kinds only. Its bytes are of
// this build's types, whichever build recorded it.
struct RecordedMessage {
  TopicKind kind = TopicKind::kCatalogue;
  std::int64_t log_ns = 0, publish_ns = 0;
  // Valid until the next call. Empty: the bytes are not what their schema says.
  std::span<const std::byte> cdr;
  const McapChannel* channel = nullptr;  // valid as long as the reader
};

// Any MCAP file may be given: messages of other types are passed over, and damage is reported as
// McapReader does.
class RecordingReader {
 public:
  explicit RecordingReader(const std::filesystem::path& file, const McapWindow& window = {})
      : RecordingReader(std::vector{file}, window) {}
  // The files of one recording in their order, at least one. Damage in one of them ends the
  // reading.
  explicit RecordingReader(const std::vector<std::filesystem::path>& files,
                           const McapWindow& window = {});

  // Other topics are passed over.
  [[nodiscard]] bool next(RecordedMessage& message);

  // After next() returned false; see McapReader. Messages of a type that this build cannot read are
  // an error that names the build which recorded them.
  [[nodiscard]] const std::string& error() const noexcept {
    return refusal_.empty() ? open_.back()->error() : refusal_;
  }
  [[nodiscard]] bool readable() const noexcept {
    return refusal_.empty() && (open_.size() > 1 || open_.back()->readable());
  }
  // Fields of this build that messages so far do not have, since their build did not know them:
  // "Distances.queries". They read as 0, NaN or empty.
  [[nodiscard]] const std::set<std::string>& not_recorded() const noexcept { return not_recorded_; }
  // Share of the files that has been read, 0 to 1.
  [[nodiscard]] double progress() const noexcept;
  // The summary of the first file.
  [[nodiscard]] const std::optional<McapSummary>& summary() const noexcept {
    return open_.front()->summary();
  }
  // The value of a key in the metadata read so far; empty: there is none.
  [[nodiscard]] std::string about(const std::string& key) const;
  // The number of the last state of a partner so far (kJoinedMetadata). 0: there is none in this
  // file.
  [[nodiscard]] std::uint64_t joined() const;

 private:
  // One channel as examined.
  struct Channel {
    std::optional<TopicKind> kind;       // none: not of ours
    std::optional<LayoutChange> change;  // none: the layout is that of this build
  };

  [[nodiscard]] bool next_in_file(RecordedMessage& message);
  [[nodiscard]] Channel examine(const McapChannel& channel);

  std::vector<std::filesystem::path> files_;
  McapWindow window_;
  std::vector<std::unique_ptr<McapReader>> open_;  // one after the other: channels stay valid
  std::map<const McapChannel*, Channel> channels_;
  std::set<std::string> not_recorded_;
  std::string refusal_;
};

// The facts that a replay must know before it begins.
struct RecordingOutline {
  std::string error;  // not empty: the file cannot be read at all
  std::optional<Sample<clearance_msg_Catalogue>> catalogue;  // the first one
  bool has_reports = false;
  bool has_gradients = false;       // as far as its summary tells
  bool has_zones = true;            // false: its summary tells that it has none
  std::string build;                // of the reports; empty: the recording does not say
  std::string cell_file;            // where its cell stood; empty: it keeps no files of the cell
  bool some_without_pairs = false;  // of the reports: RecordingOptions::pairs_every
  std::int64_t first_ns = 0;        // log time of the first message
};

// Reads only as far as needed: a few messages of a file that our recorders wrote. If the recording
// has several files, it reads the first one.
[[nodiscard]] RecordingOutline outline(const std::filesystem::path& file);

}  // namespace clearance
