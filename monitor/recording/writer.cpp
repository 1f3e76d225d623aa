// Gives each of the six topics a channel at the start, so that channel ids do not depend on what
// is written first.
#include "monitor/recording/writer.hpp"

namespace clearance {

RecordingWriter::RecordingWriter(const std::filesystem::path& file, const Topics& topics,
                                 const McapWriterOptions& options)
    : mcap_(file, options) {
  for (const Topic& topic : kTopics) {
    channels_[index(topic.kind)] =
        mcap_.add_channel(topic_schema(topic.kind), topics.*topic.name, kCdrEncoding);
  }
}

// Metadata stands outside the messages, so that a reader finds the cell without decoding one.
void RecordingWriter::describe(const clearance_msg_Catalogue& catalogue, const std::string& build) {
  McapMap about = {{"version", CLEARANCE_VERSION},
                   {"scene", catalogue.scene},
                   {"scene_revision", std::to_string(catalogue.scene_revision)},
                   {"cell", catalogue.cell_yaml}};
  if (!build.empty()) about["build"] = build;
  mcap_.metadata(kRecordingMetadata, about);
}

// The same content as metadata and as a message of the topic.
void RecordingWriter::catalogue(const clearance_msg_Catalogue& catalogue, std::int64_t log_ns,
                                const std::string& build) {
  describe(catalogue, build);
  write(TopicKind::kCatalogue, log_ns, log_ns, catalogue);
}

// MCAP times are unsigned; ours are never negative.
void RecordingWriter::write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns,
                            std::span<const std::byte> cdr) {
  mcap_.write(channels_[index(kind)], static_cast<std::uint64_t>(log_ns),
              static_cast<std::uint64_t>(publish_ns), cdr);
}

}  // namespace clearance
