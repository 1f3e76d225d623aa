// Gives each topic a channel at the start of a file, so that channel ids do not depend
// on what is written first.
#include "monitor/recording/writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "monitor/files/numbered_file.hpp"
#include "monitor/recording/recorded_cell.hpp"

namespace clearance {
RecordingWriter::RecordingWriter(const std::filesystem::path& file, const Topics& topics,
                                 const RecordingOptions& options)
    : file_(file), topics_(topics), options_(options) {
  open();
}

void RecordingWriter::open() {
  mcap_.emplace(file_,
                McapWriterOptions{.compression = options_.compress ? McapCompression::kZstd
                                                                   : McapCompression::kStored,
                                  .overwrite = options_.overwrite});
  for (const Topic& topic : kRecordedTopics) {
    if (!holds(topic.kind)) continue;
    channels_[index(topic.kind)] =
        mcap_->add_channel(topic_schema(topic.kind), topics_.*topic.name, kCdrEncoding);
  }
  // In the same order, so with the same ids.
  for (const auto& [schema, topic] : more_channels_) {
    mcap_->add_channel(schema, topic, kCdrEncoding);
  }
}

std::uint16_t RecordingWriter::add_channel(const McapSchema& schema, const std::string& topic) {
  more_channels_.emplace_back(schema, topic);
  return mcap_->add_channel(schema, topic, kCdrEncoding);
}

// Files that this file has already are not repeated.
std::string RecordingWriter::attach(AttachedFiles files) {
  const AttachedFiles before = std::exchange(attached_, std::move(files));
  for (const AttachedFile& file : attached_.files) {
    const bool is_new = std::ranges::none_of(before.files, [&file](const AttachedFile& one) {
      return one.name == file.name && one.revision == file.revision;
    });
    if (is_new) write_attachment(file);
  }
  return attached_.missing;
}

void RecordingWriter::write_attachment(const AttachedFile& file) {
  end_chunk();
  const std::uint64_t before = mcap_->bytes();
  mcap_->attachment(file.name, file.media_type, file.bytes);
  attached_bytes_ += mcap_->bytes() - before;
}

// Attachments and metadata go to the file at once, and messages with their chunk. This keeps their
// order.
void RecordingWriter::end_chunk() {
  if (mcap_->messages() > 0) mcap_->flush();
}

// A scene that follows none begins a run of the daemon: no sender has ids of the scenes before.
void RecordingWriter::note_former(const clearance_msg_Catalogue& next) {
  const auto revision = about_.find("scene_revision");
  if (next.in_force_from == 0) {
    former_.clear();
  } else if (revision != about_.end()) {
    std::uint64_t number = 0;
    const std::string& text = revision->second;
    std::from_chars(text.data(), text.data() + text.size(), number);
    former_.slot(number).kept = std::move(object_names_);
  }
  object_names_.clear();
  for (std::uint32_t i = 0; i < next.objects._length; ++i) {
    if (i > 0) object_names_ += ',';
    object_names_ += next.objects._buffer[i].name;
  }
}

void RecordingWriter::write_former() {
  former_.for_each([this](const auto& scene) {
    mcap_->metadata(kFormerMetadata,
                    {{"scene_revision", std::to_string(scene.revision)}, {"objects", scene.kept}});
  });
}

// Metadata stands outside the messages, so that a reader finds the cell without decoding one.
void RecordingWriter::describe(const clearance_msg_Catalogue& catalogue) {
  note_former(catalogue);
  about_ = {{"version", CLEARANCE_VERSION},
            {"scene", catalogue.scene},
            {"scene_revision", std::to_string(catalogue.scene_revision)},
            {"cell", catalogue.cell_yaml}};
  for (const auto& [key, text] :
       {std::pair{"build", catalogue.build}, std::pair{"cell_hash", catalogue.cell_hash}})
    if (text != nullptr && *text != '\0') about_[key] = text;
  if (!attached_.cell_file.empty()) about_["cell_file"] = attached_.cell_file;
  if (options_.pairs_every > 1) about_["pairs_every"] = std::to_string(options_.pairs_every);
  if (options_.ticks_every > 1) about_["ticks_every"] = std::to_string(options_.ticks_every);
  if (options_.roll_bytes > 0 || options_.roll_ns > 0) about_["part"] = std::to_string(part_);
  if (catalogue.daemon != 0) about_["daemon"] = std::to_string(catalogue.daemon);
  if (*catalogue.share != '\0') about_["share"] = catalogue.share;
  if (catalogue.in_force_from != 0) {
    about_["began_after"] = std::to_string(catalogue.began_after);
    about_["in_force_from"] = std::to_string(catalogue.in_force_from);
  }
  end_chunk();
  mcap_->metadata(kRecordingMetadata, about_);
}

// The same content as metadata and as a message of the topic.
void RecordingWriter::catalogue(const clearance_msg_Catalogue& catalogue, std::int64_t log_ns) {
  describe(catalogue);
  write(TopicKind::kCatalogue, log_ns, log_ns, catalogue);
}

// MCAP times are unsigned; ours are never negative.
void RecordingWriter::write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns,
                            std::span<const std::byte> cdr) {
  if (!holds(kind)) return;
  if (!began_ns_) began_ns_ = log_ns;
  if (kind == TopicKind::kCatalogue) catalogue_.emplace(cdr.begin(), cdr.end());
  mcap_->write(channels_[index(kind)], static_cast<std::uint64_t>(log_ns),
               static_cast<std::uint64_t>(publish_ns), cdr);
}

void RecordingWriter::write(SideTopic topic, std::int64_t log_ns, std::int64_t stamp_ns,
                            std::span<const std::byte> cdr) {
  auto& channel = side_channels_[static_cast<std::size_t>(topic)];
  if (!channel) channel = add_channel(side_schema(topic), name(topic));
  if (topic == SideTopic::kStates) note(kJoinedMetadata, {{"number", std::to_string(++joined_)}});
  if (cdr.empty()) return;
  write(*channel, log_ns, stamp_ns, cdr);
}

bool RecordingWriter::is_due(std::int64_t log_ns) const noexcept {
  const bool large =
      options_.roll_bytes > 0 && mcap_->bytes() >= options_.roll_bytes + attached_bytes_;
  const bool long_enough = options_.roll_ns > 0 && log_ns - *began_ns_ >= options_.roll_ns;
  return large || long_enough;
}

bool RecordingWriter::roll(std::int64_t log_ns) { return is_due(log_ns) && begin_anew(log_ns); }

// The next file never replaces one that is there, unless the first one may. A file that could not
// be closed ends the recording.
bool RecordingWriter::begin_anew(std::int64_t log_ns) {
  const bool more_than_a_catalogue = mcap_->messages() > 1;
  if (!ok() || !more_than_a_catalogue || !mcap_->close()) return false;
  messages_before_ += mcap_->messages();
  bytes_before_ += mcap_->bytes();
  file_ = next_number(file_);
  if (!options_.overwrite) file_ = first_free(file_);
  began_ns_.reset();
  ++part_;
  open();
  attached_bytes_ = 0;
  write_former();
  for (const AttachedFile& file : attached_.files) write_attachment(file);
  if (!about_.empty()) {
    about_["part"] = std::to_string(part_);
    mcap_->metadata(kRecordingMetadata, about_);
  }
  if (catalogue_) {
    const std::vector<std::byte> last = *catalogue_;
    write(TopicKind::kCatalogue, log_ns, log_ns, std::span<const std::byte>(last));
  }
  return true;
}

}  // namespace clearance
