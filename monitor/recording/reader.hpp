// The messages of our six topics in a recording, in file order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "monitor/mcap/reader.hpp"
#include "monitor/recording/topic_schema.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// One message of ours; not decoded yet, since most readers want some kinds only.
struct RecordedMessage {
  TopicKind kind = TopicKind::kCatalogue;
  std::int64_t log_ns = 0, publish_ns = 0;
  std::span<const std::byte> cdr;        // valid until the next call
  const McapChannel* channel = nullptr;  // valid as long as the reader
};

// Any MCAP file may be given: messages of other types are passed over, and damage is reported as
// McapReader does.
class RecordingReader {
 public:
  explicit RecordingReader(const std::filesystem::path& file, const McapWindow& window = {});

  // Other topics are passed over.
  [[nodiscard]] bool next(RecordedMessage& message);

  // After next() returned false; see McapReader.
  [[nodiscard]] const std::string& error() const noexcept { return mcap_.error(); }
  [[nodiscard]] bool readable() const noexcept { return mcap_.readable(); }
  [[nodiscard]] double progress() const noexcept { return mcap_.progress(); }
  [[nodiscard]] const std::optional<McapSummary>& summary() const noexcept {
    return mcap_.summary();
  }
  // Of the reports, as the metadata seen so far tell it; empty: they do not.
  [[nodiscard]] std::string build() const;

 private:
  McapReader mcap_;
  std::map<const McapChannel*, std::optional<TopicKind>> kinds_;
};

// What a replay must know before it begins.
struct RecordingOutline {
  std::string error;  // not empty: the file cannot be read at all
  std::optional<Sample<clearance_msg_Catalogue>> catalogue;  // the first one
  bool has_reports = false;
  std::string build;          // of the reports; empty: the recording does not say
  std::int64_t first_ns = 0;  // log time of the first message
};

// Reads as far as it takes to know: a few messages of what our recorders write.
[[nodiscard]] RecordingOutline outline(const std::filesystem::path& file);

}  // namespace clearance
