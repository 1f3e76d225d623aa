// A recording: an MCAP file of our six topics, with the cell that it was made with.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "config/scene.hpp"
#include "monitor/mcap/writer.hpp"
#include "monitor/recording/topic_schema.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// Name of the metadata record with version, scene, scene_revision and cell (the YAML text), and
// build, the one that made the reports (monitor/build_info/build_info.hpp), where that is known.
inline constexpr std::string_view kRecordingMetadata = "clearance.recording";

// Errors are kept, as McapWriter does. Not for several threads at once.
class RecordingWriter {
 public:
  RecordingWriter(const std::filesystem::path& file, const Topics& topics,
                  const McapWriterOptions& options = {});

  // Ids to names; also kept as metadata. Belongs in front of what uses the ids. `build`: the one
  // that makes the reports; empty: not known.
  void catalogue(const clearance_msg_Catalogue& catalogue, std::int64_t log_ns,
                 const std::string& build = {});
  // Only the metadata.
  void describe(const clearance_msg_Catalogue& catalogue, const std::string& build = {});

  // `publish_ns`: the source's stamp where there is one.
  void write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns,
             std::span<const std::byte> cdr);
  template <class T>
  void write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns, const T& sample) {
    write(kind, log_ns, publish_ns, encoder_.encode(sample));
  }

  // A channel beside those of our topics, with CDR messages; returns its id.
  [[nodiscard]] std::uint16_t add_channel(const McapSchema& schema, std::string_view topic) {
    return mcap_.add_channel(schema, topic, kCdrEncoding);
  }
  void write(std::uint16_t channel, std::int64_t log_ns, std::span<const std::byte> cdr) {
    const auto time_ns = static_cast<std::uint64_t>(log_ns);
    mcap_.write(channel, time_ns, time_ns, cdr);
  }

  // What was written so far survives a crash.
  void flush() { mcap_.flush(); }
  // As McapWriter::check.
  bool check() { return mcap_.check(); }
  bool close() { return mcap_.close(); }
  [[nodiscard]] bool ok() const noexcept { return mcap_.ok(); }
  [[nodiscard]] const std::string& error() const noexcept { return mcap_.error(); }
  [[nodiscard]] std::uint64_t messages() const noexcept { return mcap_.messages(); }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return mcap_.bytes(); }

 private:
  McapWriter mcap_;
  std::array<std::uint16_t, kTopics.size()> channels_{};
  CdrEncoder encoder_;
};

}  // namespace clearance
