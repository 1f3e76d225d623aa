// The footer has a fixed length, so it is found from the end of the file and says where the summary
// begins. The summary is read as a whole, and used only if its checksum and every record in it are
// right.
#include <algorithm>
#include <array>

#include "monitor/files/reader.hpp"

namespace clearance {
namespace {

// For the same reason as kLargestMcapRecord; a larger summary is ignored and the file streamed.
constexpr std::uint64_t kLargestSummary = std::uint64_t{1} << 28;  // 256 MiB: some 2 million chunks

// Record 0x02. The place of the summary offsets is not needed.
struct Footer {
  std::uint64_t offset = 0;  // of the record
  std::uint64_t summary_start = 0;
  std::uint32_t crc = 0;
};

// The last record of a closed file has a fixed length, so it is found from the end.
std::optional<Footer> read_footer(McapFile& file) {
  constexpr std::uint64_t kTail = kMcapRecordHeader + kMcapFooterBody + kMcapMagic.size();
  if (file.size() < kTail + kMcapMagic.size()) return std::nullopt;
  Footer footer{.offset = file.size() - kTail};
  std::array<std::byte, kTail> tail;
  if (!file.read(footer.offset, tail)) return std::nullopt;
  if (!std::ranges::equal(std::span(tail).last(kMcapMagic.size()),
                          std::as_bytes(std::span(kMcapMagic)))) {
    return std::nullopt;
  }
  McapFields fields(tail);
  if (fields.get<std::uint8_t>() != static_cast<std::uint8_t>(McapKind::kFooter))
    return std::nullopt;
  if (fields.get<std::uint64_t>() != kMcapFooterBody) return std::nullopt;
  footer.summary_start = fields.get<std::uint64_t>();
  static_cast<void>(fields.get<std::uint64_t>());  // where the summary offsets begin
  footer.crc = fields.get<std::uint32_t>();
  if (footer.summary_start == 0 || footer.summary_start >= footer.offset) return std::nullopt;
  return footer;
}

// In the order of the format's specification; what we do not use is passed over.
McapStatistics read_statistics(McapFields& fields) {
  McapStatistics statistics;
  statistics.messages = fields.get<std::uint64_t>();
  static_cast<void>(fields.get<std::uint16_t>());  // schemas
  static_cast<void>(fields.get<std::uint32_t>());  // channels
  static_cast<void>(fields.get<std::uint32_t>());  // attachments
  statistics.metadata = fields.get<std::uint32_t>();
  statistics.chunks = fields.get<std::uint32_t>();
  statistics.start_ns = fields.get<std::uint64_t>();
  statistics.end_ns = fields.get<std::uint64_t>();
  statistics.channel_messages = fields.get_channel_map();
  return statistics;
}

// Field order as in the specification, record 0x08.
McapChunkIndex read_chunk_index(McapFields& fields) {
  McapChunkIndex index;
  index.start_ns = fields.get<std::uint64_t>();
  index.end_ns = fields.get<std::uint64_t>();
  index.offset = fields.get<std::uint64_t>();
  index.length = fields.get<std::uint64_t>();
  index.message_indexes = fields.get_channel_map();
  index.message_index_length = fields.get<std::uint64_t>();
  index.compression = fields.get_text();
  index.compressed = fields.get<std::uint64_t>();
  index.uncompressed = fields.get<std::uint64_t>();
  return index;
}

// Metadata stands in the data section; the summary says where.
bool read_metadata(McapFile& file, McapFields& index, McapSummary& summary) {
  const auto offset = index.get<std::uint64_t>();
  const auto length = index.get<std::uint64_t>();
  if (!index.ok() || length < kMcapRecordHeader || length > file.size()) return false;
  std::vector<std::byte> record(static_cast<std::size_t>(length));
  if (!file.read(offset, record)) return false;
  McapFields fields(record);
  if (fields.get<std::uint8_t>() != static_cast<std::uint8_t>(McapKind::kMetadata)) return false;
  static_cast<void>(fields.get<std::uint64_t>());
  const std::string name = fields.get_text();
  summary.metadata[name] = fields.get_map();
  return fields.ok();
}

// One record of the summary section. Kinds that are not known are skipped, as the format demands.
bool read_record(McapFile& file, McapKind kind, McapFields& fields,
                 std::map<std::uint16_t, McapSchema>& schemas, McapSummary& summary) {
  switch (kind) {
    case McapKind::kSchema: {
      const auto id = fields.get<std::uint16_t>();
      schemas[id] = fields.get_schema();
      return fields.ok();
    }
    case McapKind::kChannel: {
      const auto id = fields.get<std::uint16_t>();
      McapChannel& channel = summary.channels[id] = fields.get_channel(id);
      channel.schema = schemas[channel.schema_id];
      return fields.ok();
    }
    case McapKind::kStatistics:
      summary.statistics = read_statistics(fields);
      return fields.ok();
    case McapKind::kChunkIndex:
      summary.chunks.push_back(read_chunk_index(fields));
      return fields.ok();
    case McapKind::kMetadataIndex:
      return read_metadata(file, fields, summary);
    default:
      return true;
  }
}

}  // namespace

// Nothing is taken from a summary whose checksum or content is wrong: the reader then streams.
std::optional<McapSummary> read_mcap_summary(McapFile& file) {
  const std::optional<Footer> footer = read_footer(file);
  if (!footer) return std::nullopt;
  const std::uint64_t length = footer->offset - footer->summary_start;
  if (length > kLargestSummary) return std::nullopt;
  // Includes the part of the footer that the summary's checksum covers.
  std::vector<std::byte> bytes(static_cast<std::size_t>(length) + kMcapRecordHeader +
                               kMcapFooterBody - sizeof(std::uint32_t));
  if (!file.read(footer->summary_start, bytes)) return std::nullopt;
  if (footer->crc != 0 && footer->crc != mcap_crc(0, bytes)) return std::nullopt;

  McapSummary summary;
  std::map<std::uint16_t, McapSchema> schemas;
  McapFields records{std::span(bytes).first(static_cast<std::size_t>(length))};
  while (!records.rest().empty()) {
    const auto kind = static_cast<McapKind>(records.get<std::uint8_t>());
    McapFields fields(records.get_raw(records.get<std::uint64_t>()));
    if (!records.ok() || !read_record(file, kind, fields, schemas, summary)) return std::nullopt;
  }
  // A summary may list them in any order; reading forwards is faster.
  std::ranges::sort(summary.chunks, {}, &McapChunkIndex::offset);
  return summary;
}

}  // namespace clearance
