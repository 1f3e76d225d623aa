// Finds where records begin and end, and checks the checksums over them.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "monitor/files/reader.hpp"

namespace clearance {

std::string McapReader::too_large(std::string_view what, std::uint64_t bytes, std::uint64_t most) {
  return fmt::format("a {} of {} bytes is more than this reader takes ({} MiB)", what, bytes,
                     most >> 20);
}

// Reads the header of the next record. A file that ends between records, without its closing magic,
// was cut off.
bool McapReader::next_record(Record& record) {
  if (offset_ == file_.size()) {
    cut_off(offset_);
    return false;
  }
  std::array<std::byte, kMcapRecordHeader> header{};
  if (!file_.read(offset_, header)) {
    cut_off(offset_);
    return false;
  }
  McapFields fields(header);
  record.kind = static_cast<McapKind>(fields.get<std::uint8_t>());
  record.length = fields.get<std::uint64_t>();
  record.offset = offset_;
  if (record.kind == McapKind{}) {
    damage(offset_, "a record of kind 0, which does not exist");
    return false;
  }
  // The checksum of the data section ends here; DataEnd itself is not in it.
  if (record.kind != McapKind::kDataEnd) crc_ = mcap_crc(crc_, header);
  offset_ += header.size();
  return true;
}

// The next chunk that overlaps the window, where the index says that it is.
bool McapReader::next_indexed_chunk(Record& record) {
  const std::vector<McapChunkIndex>& chunks = summary_->chunks;
  while (next_chunk_ < chunks.size() && (chunks[next_chunk_].end_ns < window_.start_ns ||
                                         chunks[next_chunk_].start_ns > window_.end_ns)) {
    ++next_chunk_;
  }
  if (next_chunk_ == chunks.size()) {
    done_ = true;
    return false;
  }
  const McapChunkIndex& chunk = chunks[next_chunk_++];
  offset_ = chunk.offset;
  if (!next_record(record)) return false;
  if (record.kind == McapKind::kChunk && record.length + kMcapRecordHeader == chunk.length)
    return true;
  damage(record.offset, "the index says that a chunk begins here, but none does");
  return false;
}

// A length is trusted only up to the file's size and what fits into memory.
bool McapReader::read_body(const Record& record) {
  if (record.length > file_.size() - offset_) {
    cut_off(record.offset);
    return false;
  }
  if (record.length > kLargestMcapRecord) {
    damage(record.offset, too_large("record", record.length, kLargestMcapRecord));
    return false;
  }
  body_.resize(static_cast<std::size_t>(record.length));
  if (!file_.read(offset_, body_)) {
    cut_off(record.offset);
    return false;
  }
  offset_ += record.length;
  if (record.kind != McapKind::kDataEnd) crc_ = mcap_crc(crc_, body_);
  return true;
}

// Only the bytes of this record matter, for the checksum; its content does not.
void McapReader::pass_over(const Record& record) {
  if (record.length > file_.size() - offset_) return cut_off(record.offset);
  std::uint64_t left = record.length;
  // Attachments may be larger than memory, so they are read block by block.
  std::array<std::byte, 65536> piece;
  while (left > 0) {
    const auto bytes = std::span(piece).first(
        static_cast<std::size_t>(std::min<std::uint64_t>(left, piece.size())));
    if (!file_.read(offset_, bytes)) return cut_off(record.offset);
    crc_ = mcap_crc(crc_, bytes);
    offset_ += bytes.size();
    left -= bytes.size();
  }
}

// A checksum of 0 stands for none.
void McapReader::end_data(const Record& record) {
  if (!read_body(record)) return;
  McapFields fields(body_);
  const auto crc = fields.get<std::uint32_t>();
  if (!fields.ok()) return damage(record.offset, "a record whose content does not fit its length");
  if (crc != 0 && crc != crc_) {
    return damage(record.offset,
                  "the checksum of everything before does not match: some bytes were changed");
  }
  data_ended_ = true;
  crc_ = 0;  // the summary has one of its own, in the footer
}

// The footer, the closing magic, and nothing behind it.
void McapReader::end_file(const Record& record) {
  if (!data_ended_)
    return damage(record.offset, "the closing record stands before the end of the data");
  // The checksum of the summary covers the footer up to the checksum itself.
  const std::uint32_t before = crc_;
  if (!read_body(record)) return;
  McapFields fields(body_);
  const auto starts = fields.get_raw(2 * sizeof(std::uint64_t));  // of the summary's parts
  const auto crc = fields.get<std::uint32_t>();
  if (!fields.ok()) return damage(record.offset, "a record whose content does not fit its length");
  if (crc != 0 && crc != mcap_crc(before, starts)) {
    return damage(record.offset,
                  "the checksum of the summary does not match: some of its bytes were changed; the "
                  "messages are not in it");
  }
  std::array<std::byte, kMcapMagic.size()> magic{};
  if (!file_.read(offset_, magic)) return cut_off(offset_);
  if (!std::ranges::equal(magic, std::as_bytes(std::span(kMcapMagic)))) {
    return damage(offset_, "the magic bytes at the end are wrong");
  }
  offset_ += magic.size();
  if (offset_ != file_.size()) return damage(offset_, "more follows behind its end");
  done_ = true;
}

}  // namespace clearance
