// Messages are collected in a chunk in memory; a chunk and its indexes go to the file in one write.
// The writer keeps what the summary needs until the file is closed.
#include "monitor/files/writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "monitor/files/file_error.hpp"

namespace clearance {
namespace {

// When an attachment was recorded and made: not known.
constexpr std::uint64_t kAttachmentTime = 0;

// Record 0x03: id, name, encoding, text.
void put_schema(McapBytes& out, std::uint16_t id, const McapSchema& schema) {
  const std::size_t record = out.begin_record(McapKind::kSchema);
  out.put(id);
  out.put_text(schema.name);
  out.put_text(schema.encoding);
  out.put_text(schema.text);
  out.end_record(record);
}

// Record 0x04: id, schema id, topic, message encoding, metadata.
void put_channel(McapBytes& out, const McapChannel& channel) {
  const std::size_t record = out.begin_record(McapKind::kChannel);
  out.put(channel.id);
  out.put(channel.schema_id);
  out.put_text(channel.topic);
  out.put_text(channel.encoding);
  out.put_map(channel.metadata);
  out.end_record(record);
}

// Pairs of channel id and number, prefixed by their length in bytes.
void put_channel_map(McapBytes& out, const std::map<std::uint16_t, std::uint64_t>& map) {
  const std::size_t length = out.begin_length<std::uint32_t>();
  for (const auto& [channel, value] : map) {
    out.put(channel);
    out.put(value);
  }
  out.end_length<std::uint32_t>(length);
}

// Record 0x08; read_chunk_index in summary.cpp reads it.
void put_chunk_index(McapBytes& out, const McapChunkIndex& index) {
  const std::size_t record = out.begin_record(McapKind::kChunkIndex);
  out.put(index.start_ns);
  out.put(index.end_ns);
  out.put(index.offset);
  out.put(index.length);
  put_channel_map(out, index.message_indexes);
  out.put(index.message_index_length);
  out.put_text(index.compression);
  out.put(index.compressed);
  out.put(index.uncompressed);
  out.end_record(record);
}

// Record 0x0b.
void put_statistics(McapBytes& out, const McapStatistics& statistics, std::size_t schemas,
                    std::size_t channels, std::size_t attachments) {
  const std::size_t record = out.begin_record(McapKind::kStatistics);
  out.put(statistics.messages);
  out.put(static_cast<std::uint16_t>(schemas));
  out.put(static_cast<std::uint32_t>(channels));
  out.put(static_cast<std::uint32_t>(attachments));
  out.put(statistics.metadata);
  out.put(statistics.chunks);
  out.put(statistics.start_ns);
  out.put(statistics.end_ns);
  put_channel_map(out, statistics.channel_messages);
  out.end_record(record);
}

}  // namespace

// Magic and header go to the file at once: a file that is only this long is a valid beginning.
McapWriter::McapWriter(const std::filesystem::path& file, const McapWriterOptions& options)
    : file_(file), options_(options) {
  open();
  if (!ok()) return;
  put_out(std::as_bytes(std::span(kMcapMagic)));
  out_.clear();
  const std::size_t record = out_.begin_record(McapKind::kHeader);
  out_.put_text("");  // no profile
  out_.put_text("clearance " CLEARANCE_VERSION);
  out_.end_record(record);
  put_out(out_.view());
}

// O_EXCL decides in one step whether the file exists; a check before could be overtaken. With
// O_NONBLOCK, a pipe that has no reader is refused instead of waited for; regular files do not heed
// it. With O_APPEND, a file that another program cut off stays too short, which check() sees.
void McapWriter::open() {
  const int existing = options_.overwrite ? O_TRUNC : O_EXCL;
  constexpr int kFlags = O_WRONLY | O_CREAT | O_APPEND | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
  descriptor_ = ::open(file_.c_str(), kFlags | existing, 0644);
  struct stat status {};
  const bool opened = descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0;
  if (!opened || !S_ISREG(status.st_mode)) fail(cannot_create(file_));
}

// Errors of closing are lost here; callers who care call close().
McapWriter::~McapWriter() { close(); }

// The first error is kept: later ones are its consequences.
void McapWriter::fail(const std::string& what) {
  if (error_.empty()) error_ = what;
}

// Everything that is written to the file passes through here, so that the checksum of the data
// section covers it. After an error nothing more is written.
void McapWriter::put_out(std::span<const std::byte> bytes) {
  crc_ = mcap_crc(crc_, bytes);
  check();
  while (ok() && !bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno != EINTR) fail(cannot_write(file_));
      continue;
    }
    offset_ += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

// A file that was moved away still grows, but is no longer where it is looked for.
bool McapWriter::check() {
  if (!ok() || descriptor_ < 0) return ok();
  struct stat here {
  }, there{};
  const auto happened = [this](const char* what) {
    fail(fmt::format("{} was {} while it was being written", file_.string(), what));
  };
  if (::fstat(descriptor_, &here) != 0) {
    fail(cannot_write(file_));
  } else if (here.st_nlink == 0) {
    happened("deleted");
  } else if (static_cast<std::uint64_t>(here.st_size) != offset_) {
    happened("changed by another program");
  } else if (::stat(file_.c_str(), &there) == 0 ? there.st_ino != here.st_ino : errno == ENOENT) {
    happened("moved or replaced");
  }
  return ok();
}

// Definitions stand in the chunk in front of the messages that use them, and again in the summary.
// So a file that was cut off can still be read.
std::uint16_t McapWriter::add_channel(const McapSchema& schema, std::string_view topic,
                                      std::string_view encoding, const McapMap& metadata) {
  auto known = std::find(schemas_.begin(), schemas_.end(), schema);
  const auto schema_id = static_cast<std::uint16_t>(known - schemas_.begin() + 1);
  if (known == schemas_.end()) {
    schemas_.push_back(schema);
    put_schema(chunk_, schema_id, schema);
  }
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  channels_.push_back({id, schema_id, schema, std::string(topic), std::string(encoding), metadata});
  in_chunk_.emplace_back();
  put_channel(chunk_, channels_.back());
  return id;
}

// A chunk is closed when it is large, or when it holds as much time as a crash may cost.
void McapWriter::write(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                       std::span<const std::byte> payload) {
  if (!ok()) return;
  // The index gives the offset of the message inside of the uncompressed chunk.
  Channel& state = in_chunk_[channel - 1u];
  state.index.emplace_back(log_time, chunk_.size());
  const std::size_t record = chunk_.begin_record(McapKind::kMessage);
  chunk_.put(channel);
  chunk_.put(state.sequence++);
  chunk_.put(log_time);
  chunk_.put(publish_time);
  chunk_.put_raw(payload);
  chunk_.end_record(record);

  const bool first = statistics_.messages++ == 0;
  statistics_.start_ns = first ? log_time : std::min(statistics_.start_ns, log_time);
  statistics_.end_ns = std::max(statistics_.end_ns, log_time);
  ++statistics_.channel_messages[channel];
  const bool first_in_chunk = chunk_messages_++ == 0;
  chunk_start_ns_ = first_in_chunk ? log_time : std::min(chunk_start_ns_, log_time);
  chunk_end_ns_ = first_in_chunk ? log_time : std::max(chunk_end_ns_, log_time);
  if (chunk_.size() >= options_.chunk_bytes ||
      chunk_end_ns_ - chunk_start_ns_ >= options_.chunk_span_ns) {
    flush();
  }
}

// Outside chunks, at once: a reader needs it before the first message.
void McapWriter::metadata(std::string_view name, const McapMap& values) {
  out_.clear();
  const std::size_t record = out_.begin_record(McapKind::kMetadata);
  out_.put_text(name);
  out_.put_map(values);
  out_.end_record(record);
  metadata_indexes_.push_back({offset_, out_.size(), std::string(name)});
  ++statistics_.metadata;
  put_out(out_.view());
}

// Written like metadata. The checksum is of all fields before it.
void McapWriter::attachment(std::string_view name, std::string_view media_type,
                            std::span<const std::byte> bytes) {
  out_.clear();
  const std::size_t record = out_.begin_record(McapKind::kAttachment);
  const std::size_t body = out_.size();
  out_.put(kAttachmentTime);
  out_.put(kAttachmentTime);
  out_.put_text(name);
  out_.put_text(media_type);
  out_.put(std::uint64_t{bytes.size()});
  out_.put_raw(bytes);
  out_.put(mcap_crc(0, out_.view().subspan(body)));
  out_.end_record(record);
  attachment_indexes_.push_back(
      {offset_, out_.size(), bytes.size(), std::string(name), std::string(media_type)});
  put_out(out_.view());
}

// Writes the open chunk with the indexes of its messages. The checksum is of the records before
// they are compressed.
void McapWriter::flush() {
  if (!ok() || chunk_.size() == 0) return;
  out_.clear();
  if (options_.compression == McapCompression::kZstd) compress_zstd(chunk_.view(), compressed_);
  McapChunkIndex index;
  index.compression = name(compressed_.empty() ? McapCompression::kStored : McapCompression::kZstd);
  const std::span<const std::byte> stored = compressed_.empty() ? chunk_.view() : compressed_;
  index.start_ns = chunk_start_ns_;
  index.end_ns = chunk_end_ns_;
  index.offset = offset_;
  index.compressed = stored.size();
  index.uncompressed = chunk_.size();
  const std::size_t record = out_.begin_record(McapKind::kChunk);
  out_.put(chunk_start_ns_);
  out_.put(chunk_end_ns_);
  out_.put(std::uint64_t{chunk_.size()});
  out_.put(mcap_crc(0, chunk_.view()));
  out_.put_text(index.compression);
  out_.put(index.compressed);
  out_.put_raw(stored);
  out_.end_record(record);
  index.length = out_.size();
  write_message_indexes(index);
  put_out(out_.view());  // at once: a crash between chunk and indexes is no special case

  chunk_indexes_.push_back(std::move(index));
  ++statistics_.chunks;
  chunk_.clear();
  chunk_messages_ = chunk_start_ns_ = chunk_end_ns_ = 0;
}

// By channel and in order of log time, which is not always the order of writing.
void McapWriter::write_message_indexes(McapChunkIndex& index) {
  const std::size_t begin = out_.size();
  for (const McapChannel& channel : channels_) {
    auto& entries = in_chunk_[channel.id - 1u].index;
    if (entries.empty()) continue;
    std::stable_sort(entries.begin(), entries.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    index.message_indexes[channel.id] = offset_ + out_.size();
    const std::size_t record = out_.begin_record(McapKind::kMessageIndex);
    out_.put(channel.id);
    const std::size_t array = out_.begin_length<std::uint32_t>();
    for (const auto& [log_time, offset] : entries) {
      out_.put(log_time);
      out_.put(offset);
    }
    out_.end_length<std::uint32_t>(array);
    out_.end_record(record);
    entries.clear();
  }
  index.message_index_length = out_.size() - begin;
}

// Groups of equal records, an offset to each group, and the footer whose checksum covers them all.
void McapWriter::write_summary() {
  McapBytes summary;
  McapBytes offsets;
  const std::uint64_t start = offset_;
  // Records of one kind stand together, as the specification demands of the summary section.
  const auto group = [&](McapKind kind, const auto& put_all) {
    const std::size_t begin = summary.size();
    put_all();
    if (summary.size() == begin) return;
    const std::size_t record = offsets.begin_record(McapKind::kSummaryOffset);
    offsets.put(static_cast<std::uint8_t>(kind));
    offsets.put(start + begin);
    offsets.put(std::uint64_t{summary.size() - begin});
    offsets.end_record(record);
  };
  group(McapKind::kSchema, [&] {
    for (std::size_t i = 0; i < schemas_.size(); ++i) {
      put_schema(summary, static_cast<std::uint16_t>(i + 1), schemas_[i]);
    }
  });
  group(McapKind::kChannel, [&] {
    for (const McapChannel& channel : channels_) put_channel(summary, channel);
  });
  group(McapKind::kStatistics, [&] {
    put_statistics(summary, statistics_, schemas_.size(), channels_.size(),
                   attachment_indexes_.size());
  });
  group(McapKind::kChunkIndex, [&] {
    for (const McapChunkIndex& index : chunk_indexes_) put_chunk_index(summary, index);
  });
  group(McapKind::kAttachmentIndex, [&] {
    for (const AttachmentIndex& index : attachment_indexes_) {
      const std::size_t record = summary.begin_record(McapKind::kAttachmentIndex);
      summary.put(index.offset);
      summary.put(index.length);
      summary.put(kAttachmentTime);  // log time
      summary.put(kAttachmentTime);  // created
      summary.put(index.size);
      summary.put_text(index.name);
      summary.put_text(index.media_type);
      summary.end_record(record);
    }
  });
  group(McapKind::kMetadataIndex, [&] {
    for (const MetadataIndex& index : metadata_indexes_) {
      const std::size_t record = summary.begin_record(McapKind::kMetadataIndex);
      summary.put(index.offset);
      summary.put(index.length);
      summary.put_text(index.name);
      summary.end_record(record);
    }
  });
  const std::uint64_t offsets_start = start + summary.size();
  summary.put_raw(offsets.view());
  const std::size_t footer = summary.begin_record(McapKind::kFooter);
  summary.put(start);
  summary.put(offsets_start);
  summary.put(std::uint32_t{0});
  summary.end_record(footer);
  // McapBytes cannot fill in the checksum, so everything in front of it is written first, then the
  // checksum.
  const auto covered = summary.view().first(summary.size() - sizeof(std::uint32_t));
  const std::uint32_t crc = mcap_crc(0, covered);
  put_out(covered);
  put_out(std::as_bytes(std::span(&crc, 1)));
}

// The end of the data with its checksum, then the summary, which lets readers find a window of
// time.
bool McapWriter::close() {
  // Closed already, or never opened.
  if (descriptor_ < 0) return ok();
  flush();
  out_.clear();
  const std::uint32_t data_crc = crc_;
  const std::size_t record = out_.begin_record(McapKind::kDataEnd);
  out_.put(data_crc);
  out_.end_record(record);
  put_out(out_.view());
  write_summary();
  put_out(std::as_bytes(std::span(kMcapMagic)));
  check();
  if (::close(descriptor_) != 0) fail(cannot_write(file_));
  descriptor_ = -1;
  return ok();
}

}  // namespace clearance
