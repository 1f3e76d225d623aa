#include "monitor/files/attachments.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <utility>

#include "monitor/files/file.hpp"
#include "monitor/files/reader.hpp"

namespace clearance {
namespace {

// Nothing when its lengths or its checksum do not fit.
std::optional<McapAttachment> attachment_of(std::span<const std::byte> body) {
  McapFields fields(body);
  McapAttachment attachment;
  static_cast<void>(fields.get<std::uint64_t>());  // log time
  static_cast<void>(fields.get<std::uint64_t>());  // created
  attachment.name = fields.get_text();
  attachment.media_type = fields.get_text();
  const std::span<const std::byte> bytes = fields.get_raw(fields.get<std::uint64_t>());
  const std::size_t covered = body.size() - fields.rest().size();
  const auto crc = fields.get<std::uint32_t>();
  if (!fields.ok() || (crc != 0 && crc != mcap_crc(0, body.first(covered)))) return std::nullopt;
  attachment.bytes.assign(bytes.begin(), bytes.end());
  return attachment;
}

struct Record {
  McapKind kind;
  std::uint64_t offset;         // of its header
  std::uint64_t begin, length;  // of its body
};

// Visits the records outside chunks, by their headers, until `visit` returns false or the data end.
template <class Visit>
void for_each_record(McapFile& file, const Visit& visit) {
  std::uint64_t offset = kMcapMagic.size();
  for (std::array<std::byte, kMcapRecordHeader> header; file.open() && file.read(offset, header);) {
    Record record{static_cast<McapKind>(header[0]), offset, offset + header.size(), 0};
    std::memcpy(&record.length, &header[1], sizeof record.length);
    // Cut off: the reader of messages says so.
    if (record.length > file.size() - record.begin) return;
    if (record.kind == McapKind::kDataEnd || !visit(record)) return;
    offset = record.begin + record.length;
  }
}

bool read_body(McapFile& file, const Record& record, std::vector<std::byte>& body) {
  if (record.length > kLargestMcapRecord) return false;
  body.resize(static_cast<std::size_t>(record.length));
  return file.read(record.begin, body);
}

}  // namespace

McapAttachments read_attachments(const std::filesystem::path& path,
                                 std::optional<std::uint64_t> before) {
  McapAttachments result;
  McapFile file(path);
  std::vector<std::byte> body;
  for_each_record(file, [&](const Record& record) {
    const bool of_messages = record.kind == McapKind::kChunk || record.kind == McapKind::kMessage;
    if (before ? record.offset >= *before : of_messages) return false;
    if (record.kind != McapKind::kAttachment) return true;
    std::optional<McapAttachment> found;
    if (read_body(file, record, body)) found = attachment_of(body);
    if (!found) {
      result.error = fmt::format("{}: the attachment at byte {} is damaged or too large",
                                 path.string(), record.offset);
      return false;
    }
    result.found.push_back(std::move(*found));
    return true;
  });
  return result;
}

std::vector<McapMetadata> read_metadata(const std::filesystem::path& path) {
  std::vector<McapMetadata> all;
  McapFile file(path);
  std::vector<std::byte> body;
  for_each_record(file, [&](const Record& record) {
    if (record.kind != McapKind::kMetadata) return true;
    if (!read_body(file, record, body)) return false;
    McapFields fields(body);
    McapMetadata metadata{.offset = record.offset, .name = fields.get_text(), .values = {}};
    metadata.values = fields.get_map();
    if (fields.ok()) all.push_back(std::move(metadata));
    return fields.ok();
  });
  return all;
}

}  // namespace clearance
