// A recording: an MCAP file of our topics, with the cell that it was made with; or several
// files, one after the other.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/files/writer.hpp"
#include "monitor/inputs/former_scenes.hpp"
#include "monitor/recording/attached_files.hpp"
#include "monitor/recording/options.hpp"
#include "monitor/recording/topic_schema.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// Name of the metadata record. Its keys are version, scene, scene_revision and cell (the YAML
// text). Further keys stand only where they are known or needed. `build` and `cell_hash` are those
// of the catalogue: the build that made the reports, and the SHA-256 of the cell with its files.
// `part` counts the files of one recording, from 1. `pairs_every` stands where it is not 1.
// `cell_file` is the path of the cell, in a recording with the files that it names
// (recorded_cell.hpp). `daemon` is the number of the daemon's run, in a recording from DDS.
// `began_after` and `in_force_from` stand where the scene followed another one (SceneInForce). The
// record is repeated for each scene, in front of its first report.
inline constexpr std::string_view kRecordingMetadata = "clearance.recording";

// Name of a metadata record at the head of a file that continues a recording: a scene that was in
// force before the file begins (FormerScenes), the one that has been there longest first. Senders
// may still use its ids. Its keys are scene_revision, and objects: their names by id, with commas.
inline constexpr std::string_view kFormerMetadata = "clearance.former_scene";

// Name of the metadata record in front of a state of a partner that the daemon took over. Its key
// `number` counts them, from 1. The daemon counts its cycles from there on as its partner did, so
// cycles in descriptions after it cannot be compared with those before it.
inline constexpr std::string_view kJoinedMetadata = "clearance.joined";

// Errors are kept, as in McapWriter. Only one thread may use it at a time.
class RecordingWriter {
 public:
  RecordingWriter(const std::filesystem::path& file, const Topics& topics,
                  const RecordingOptions& options = {});

  // Keeps the files that the cell was read from, in this file and every one after it, in front of
  // its description. Those that this file has already are not repeated. If they are not kept,
  // returns the reason: they are too large (attach_bytes), or one cannot be read. A recording
  // without them is whole, but replays need the files.
  [[nodiscard]] std::string attach(const Cell& cell) {
    return attach(attached_files(cell, options_, attached_));
  }
  // The same with files that were read before.
  [[nodiscard]] std::string attach(AttachedFiles files);

  // The catalogue maps ids to names and is also kept as metadata. It belongs in front of all
  // messages that use the ids.
  void catalogue(const clearance_msg_Catalogue& catalogue, std::int64_t log_ns);
  // Only the metadata.
  void describe(const clearance_msg_Catalogue& catalogue);

  // `publish_ns`: the source's stamp where there is one. Topics that are left out are not written.
  void write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns,
             std::span<const std::byte> cdr);
  template <class T>
  void write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns, const T& sample) {
    if (holds(kind)) write(kind, log_ns, publish_ns, encoder_.encode(sample));
  }
  [[nodiscard]] bool holds(TopicKind kind) const { return !options_.left_out.contains(kind); }

  // Begins the next file, with the last catalogue, when this one is large or long enough. It is
  // called where a file may end: after a report and the messages that belong to it. Returns true
  // when it began a file.
  bool roll(std::int64_t log_ns);
  // The same, whatever the size of the file is.
  bool begin_anew(std::int64_t log_ns);

  // Metadata beside the description, in this file, at this place between its messages.
  void note(std::string_view name, const McapMap& values) {
    end_chunk();
    mcap_->metadata(name, values);
  }

  // A channel beside those of our topics, in this file and every one after it, with CDR messages;
  // returns its id.
  [[nodiscard]] std::uint16_t add_channel(const McapSchema& schema, const std::string& topic);
  void write(std::uint16_t channel, std::int64_t log_ns, std::span<const std::byte> cdr) {
    write(channel, log_ns, log_ns, cdr);
  }
  void write(std::uint16_t channel, std::int64_t log_ns, std::int64_t publish_ns,
             std::span<const std::byte> cdr) {
    mcap_->write(channel, static_cast<std::uint64_t>(log_ns),
                 static_cast<std::uint64_t>(publish_ns), cdr);
  }

  // `stamp_ns`: of the frame. A state is noted as kJoinedMetadata, too; empty bytes: it is lost.
  void write(SideTopic topic, std::int64_t log_ns, std::int64_t stamp_ns,
             std::span<const std::byte> cdr);

  // Afterwards everything written so far survives a crash.
  void flush() { mcap_->flush(); }
  // Calls McapWriter::check.
  bool check() { return mcap_->check(); }
  bool close() { return mcap_->close(); }
  [[nodiscard]] bool ok() const noexcept { return mcap_->ok(); }
  [[nodiscard]] const std::string& error() const noexcept { return mcap_->error(); }
  // In all files.
  [[nodiscard]] std::uint64_t messages() const noexcept {
    return messages_before_ + mcap_->messages();
  }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_before_ + mcap_->bytes(); }
  // The one that is written.
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  [[nodiscard]] std::uint64_t part() const noexcept { return part_; }

 private:
  void open();
  void write_attachment(const AttachedFile& file);
  void end_chunk();
  void note_former(const clearance_msg_Catalogue& next);
  void write_former();
  [[nodiscard]] bool is_due(std::int64_t log_ns) const noexcept;

  std::filesystem::path file_;
  Topics topics_;
  RecordingOptions options_;
  std::optional<McapWriter> mcap_;
  std::array<std::uint16_t, kRecordedTopics.size()> channels_{};
  std::vector<std::pair<McapSchema, std::string>> more_channels_;  // and their topics, in order
  // The channels of side topics, each from its first message on.
  std::array<std::optional<std::uint16_t>, kSideTopics> side_channels_;
  CdrEncoder encoder_;
  std::uint64_t part_ = 1, joined_ = 0;
  std::optional<std::int64_t> began_ns_;  // the first log time in this file
  std::uint64_t messages_before_ = 0, bytes_before_ = 0;
  AttachedFiles attached_;                           // the files of the last cell
  std::uint64_t attached_bytes_ = 0;                 // in this file
  McapMap about_;                                    // the last description
  std::optional<std::vector<std::byte>> catalogue_;  // the last one, as CDR
  // By id, with commas: of the last description, and of those before in the same run of the daemon.
  std::string object_names_;
  FormerScenes<std::string> former_;
};

}  // namespace clearance
