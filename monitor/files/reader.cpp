// Streams records from the front and hands out messages; chunks are opened in memory. The reader
// stops at the first record that makes no sense, and every message before it has been handed out.
#include "monitor/files/reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/text/sentences.hpp"
#include "monitor/files/file_error.hpp"

namespace clearance {
namespace {

// For messages about damage.
std::string seconds(std::uint64_t ns) {
  return fmt::format("{:.3f} s", static_cast<double>(ns) * 1e-9);
}

}  // namespace

McapReader::McapReader(const std::filesystem::path& file, const McapWindow& window)
    : path_(file), window_(window), file_(file) {
  begin();
}

McapReader::McapReader(std::span<const std::byte> bytes, const std::string& name,
                       const McapWindow& window)
    : path_(name), window_(window), file_(bytes) {
  begin();
}

// With a window and a summary, chunks are read through the index. Otherwise the file is streamed,
// which needs no summary.
void McapReader::begin() {
  if (!read_magic()) return;
  summary_ = read_mcap_summary(file_);
  // Without a window every chunk is needed anyway, and streaming finds damage that an index hides.
  const bool whole = window_.start_ns == 0 && window_.end_ns == McapWindow{}.end_ns;
  if (whole || !summary_ || summary_->chunks.empty()) return;
  indexed_ = true;
  channels_ = summary_->channels;
  metadata_ = summary_->metadata;
}

// A file can be no MCAP at all for three causes, and each has its own message.
bool McapReader::read_magic() {
  std::array<std::byte, kMcapMagic.size()> magic{};
  done_ = true;
  readable_ = false;
  if (!file_.open()) {
    error_ = cannot_read(path_);
    return false;
  }
  if (file_.size() == 0) {
    error_ = fmt::format("{} is empty: nothing was recorded, or the recorder was stopped at once",
                         path_.string());
    return false;
  }
  if (!file_.read(0, magic) || !std::ranges::equal(magic, std::as_bytes(std::span(kMcapMagic)))) {
    error_ = fmt::format("{} is not an MCAP file: it does not begin with the MCAP magic bytes",
                         path_.string());
    return false;
  }
  done_ = false;
  readable_ = true;
  offset_ = magic.size();
  crc_ = mcap_crc(0, magic);
  return true;
}

// Progress counts bytes, because the number of messages is known only for a closed file.
double McapReader::progress() const noexcept {
  return file_.size() == 0 ? 1.0 : static_cast<double>(offset_) / static_cast<double>(file_.size());
}

// Ends the reading: what follows a damage cannot be trusted. The message says where it is and how
// much was read before, which is what a person can still use.
void McapReader::damage(std::uint64_t offset, const std::string& what) {
  done_ = true;
  chunk_ = {};
  error_ = fmt::format("{} is damaged at byte {} of {}: {}. Before that came {}", path_.string(),
                       offset, file_.size(), what, counted(messages_, "message"));
  if (messages_ > 0)
    error_ += fmt::format(", the last {} after the first", seconds(last_ns_ - first_ns_));
}

// The commonest damage has its likely causes in the message.
void McapReader::cut_off(std::uint64_t offset) {
  damage(offset,
         "the file is cut off here (the recorder was stopped hard, or the copy is incomplete)");
}

// Goes on until a message of the window is found.
bool McapReader::next(McapMessage& message) {
  bool found = false;
  while (!found && !done_) {
    if (!chunk_.empty() || chunk_cut_off_) {
      take_from_chunk(message, found);
      continue;
    }
    Record record{};
    if (indexed_ ? next_indexed_chunk(record) : next_record(record)) take(record, message, found);
  }
  return found;
}

// Dispatches by kind. Definitions and messages may stand outside chunks as well.
void McapReader::take(const Record& record, McapMessage& message, bool& found) {
  // The summary follows the data and repeats the definitions.
  if (data_ended_ && record.kind != McapKind::kFooter) return pass_over(record);
  // No writer does that; a flipped bit in an index does, and no checksum would tell in time.
  if (has_chunks_ && record.kind == McapKind::kMessage) {
    return damage(record.offset, "a message outside the chunks of a file that has chunks");
  }
  switch (record.kind) {
    case McapKind::kChunk:
      return open_chunk(record);
    case McapKind::kDataEnd:
      return end_data(record);
    case McapKind::kFooter:
      return end_file(record);
    case McapKind::kMessage:
    case McapKind::kSchema:
    case McapKind::kChannel:
    case McapKind::kMetadata:
      break;
    default:
      return pass_over(record);
  }
  if (!read_body(record)) return;
  const bool sound = record.kind == McapKind::kMessage ? take_message(body_, message, found)
                                                       : take_definition(record.kind, body_);
  if (!sound && !done_) damage(record.offset, "a record whose content does not fit its length");
}

// Record 0x06: times, uncompressed size, CRC, compression, length, records.
void McapReader::open_chunk(const Record& record) {
  // A chunk that the end of the file cuts through still gives its first messages.
  const std::uint64_t there = file_.size() - offset_;
  has_chunks_ = true;
  chunk_cut_off_ = record.length > there;
  const Record present{record.kind, record.offset, std::min(record.length, there)};
  if (!read_body(present)) return;
  McapFields fields(body_);
  static_cast<void>(fields.get<std::uint64_t>());  // smallest log time
  static_cast<void>(fields.get<std::uint64_t>());  // largest
  const auto uncompressed = fields.get<std::uint64_t>();
  const auto crc = fields.get<std::uint32_t>();
  const std::string compression = fields.get_text();
  const auto length = fields.get<std::uint64_t>();
  if (!fields.ok()) {
    if (chunk_cut_off_) return cut_off(record.offset);
    return damage(record.offset, "a chunk whose content does not fit its length");
  }
  const std::optional<McapCompression> how = mcap_compression(compression);
  if (!how) return refuse_compression(compression);
  const auto stored = chunk_cut_off_ ? fields.rest() : fields.get_raw(length);
  if (!fields.ok()) {
    return damage(record.offset, "a chunk whose content does not fit its length");
  }
  chunk_offset_ = record.offset;
  chunk_is_stored_ = *how == McapCompression::kStored;
  chunk_end_ = offset_;
  chunk_ = chunk_is_stored_ ? stored : decompressed(record, *how, stored, uncompressed);
  if (chunk_cut_off_ || done_) return;
  if (chunk_.size() != uncompressed) {
    return damage(record.offset,
                  chunk_is_stored_
                      ? "a chunk whose content does not fit its length"
                      : fmt::format("a chunk whose {} data makes no sense", compression));
  }
  if (crc != 0 && crc != mcap_crc(0, chunk_)) {
    damage(record.offset, "the checksum of the chunk does not match its content");
  }
}

// The whole chunk, or the part that is there of one that is cut off.
std::span<const std::byte> McapReader::decompressed(const Record& record, McapCompression how,
                                                    std::span<const std::byte> stored,
                                                    std::uint64_t size) {
  if (size > kLargestMcapChunk) {
    damage(record.offset, too_large("chunk", size, kLargestMcapChunk));
    return {};
  }
  decompress(how, stored, static_cast<std::size_t>(size), decompressed_);
  return decompressed_;
}

void McapReader::refuse_compression(const std::string& compression) {
  done_ = true;
  readable_ = false;
  chunk_cut_off_ = false;
  error_ = fmt::format(
      "{} has chunks compressed by '{}'; expected zstd, lz4 or none. Rewrite it with the "
      "command-line tool of mcap.dev: mcap compress IN.mcap -o OUT.mcap",
      path_.string(), compression);
}

// One record of the open chunk.
void McapReader::take_from_chunk(McapMessage& message, bool& found) {
  McapFields fields(chunk_);
  const auto kind = static_cast<McapKind>(fields.get<std::uint8_t>());
  const auto body = fields.get_raw(fields.get<std::uint64_t>());
  // A byte offset inside compressed data means nothing to a reader.
  const std::uint64_t offset = chunk_is_stored_ ? chunk_end_ - chunk_.size() : chunk_offset_;
  if (!fields.ok()) {
    if (chunk_cut_off_) return cut_off(file_.size());
    return damage(offset, "a record in a chunk that is longer than the chunk");
  }
  if (kind == McapKind{}) {
    return damage(offset, "a record of kind 0 in a chunk, which does not exist");
  }
  chunk_ = fields.rest();
  bool sound = true;
  if (kind == McapKind::kMessage) {
    sound = take_message(body, message, found);
  } else if (kind == McapKind::kSchema || kind == McapKind::kChannel) {
    sound = take_definition(kind, body);
  }
  if (!sound && !done_) damage(offset, "a record in a chunk whose content does not fit its length");
}

// Schemas, channels and metadata. A second definition of an id must equal the first.
bool McapReader::take_definition(McapKind kind, std::span<const std::byte> body) {
  McapFields fields(body);
  if (kind == McapKind::kMetadata) {
    const std::string name = fields.get_text();
    metadata_[name] = fields.get_map();
    return fields.ok();
  }
  const auto id = fields.get<std::uint16_t>();
  if (kind == McapKind::kSchema) {
    const McapSchema schema = fields.get_schema();
    return fields.ok() && id != 0 && schemas_.try_emplace(id, schema).first->second == schema;
  }
  McapChannel channel = fields.get_channel(id);
  if (!fields.ok()) return false;
  if (indexed_) return channels_.contains(id);  // known from the summary, schema and all
  if (channel.schema_id != 0) {
    const auto schema = schemas_.find(channel.schema_id);
    if (schema == schemas_.end()) return false;
    channel.schema = schema->second;
  }
  return channels_.try_emplace(id, channel).first->second == channel;
}

// A message outside the window is sound, but not handed out.
bool McapReader::take_message(std::span<const std::byte> body, McapMessage& message, bool& found) {
  McapFields fields(body);
  const auto channel = channels_.find(fields.get<std::uint16_t>());
  message.sequence = fields.get<std::uint32_t>();
  message.log_time = fields.get<std::uint64_t>();
  message.publish_time = fields.get<std::uint64_t>();
  // The payload has no length of its own: it is the rest of the record.
  message.payload = fields.rest();
  if (!fields.ok() || channel == channels_.end()) return false;
  message.channel = &channel->second;
  if (message.log_time < window_.start_ns || message.log_time > window_.end_ns) return true;
  first_ns_ = messages_ == 0 ? message.log_time : std::min(first_ns_, message.log_time);
  last_ns_ = std::max(last_ns_, message.log_time);
  ++messages_;
  found = true;
  return true;
}

}  // namespace clearance
