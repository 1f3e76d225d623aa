#include "monitor/mcap/attachments.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <optional>

#include "monitor/mcap/file.hpp"
#include "monitor/mcap/format.hpp"
#include "monitor/mcap/reader.hpp"

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

}  // namespace

McapAttachments read_first_attachments(const std::filesystem::path& path) {
  McapAttachments result;
  McapFile file(path);
  std::uint64_t offset = kMcapMagic.size();
  std::vector<std::byte> body;
  for (std::array<std::byte, kMcapRecordHeader> header; file.open() && file.read(offset, header);) {
    const auto kind = static_cast<McapKind>(header[0]);
    if (kind == McapKind::kChunk || kind == McapKind::kMessage || kind == McapKind::kDataEnd) break;
    std::uint64_t length = 0;
    std::memcpy(&length, &header[1], sizeof length);
    const std::uint64_t begin = offset + header.size();
    if (length > file.size() - begin) break;  // cut off: the reader of messages says so
    offset = begin + length;
    if (kind != McapKind::kAttachment) continue;
    std::optional<McapAttachment> found;
    if (length <= kLargestMcapRecord) {
      body.resize(static_cast<std::size_t>(length));
      if (file.read(begin, body)) found = attachment_of(body);
    }
    if (!found) {
      result.error = fmt::format("{}: the attachment at byte {} is damaged or too large",
                                 path.string(), begin - header.size());
      break;
    }
    result.found.push_back(std::move(*found));
  }
  return result;
}

}  // namespace clearance
