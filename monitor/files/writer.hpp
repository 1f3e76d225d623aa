// Writes MCAP files: chunks, compressed or not, with message indexes, a summary and checksums.
// Every reader can seek in them, and a crash costs no more than the last chunk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "monitor/files/compression.hpp"
#include "monitor/files/format.hpp"

namespace clearance {

// The defaults lose at most 0.2 s in a crash, and chunks stay small enough to be read at once.
struct McapWriterOptions {
  // A chunk goes to the file when it holds this much or spans this much log time, whichever comes
  // first.
  std::size_t chunk_bytes = std::size_t{1} << 20;
  std::uint64_t chunk_span_ns = 200'000'000;
  McapCompression compression = McapCompression::kStored;  // or zstd
  bool overwrite = true;                                   // false: an existing file is an error
};

// Errors are kept: after the first one nothing more is written, and error() says what happened to
// which file. Whatever is no regular file (a pipe, a device) is refused, so that no write waits for
// a reader. The same calls give the same bytes.
class McapWriter {
 public:
  McapWriter(const std::filesystem::path& file, const McapWriterOptions& options = {});
  ~McapWriter();  // closes
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  // False after the first error of the system.
  [[nodiscard]] bool ok() const noexcept { return error_.empty(); }
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  [[nodiscard]] std::uint64_t messages() const noexcept { return statistics_.messages; }
  // The size of the file so far, including the chunk that is still in memory, before that is
  // compressed.
  [[nodiscard]] std::uint64_t bytes() const noexcept { return offset_ + chunk_.size(); }

  // Equal schemas are written once. Returns the channel's id, from 1.
  std::uint16_t add_channel(const McapSchema& schema, std::string_view topic,
                            std::string_view encoding, const McapMap& metadata = {});

  // Sequence numbers are counted per channel. Times in ns.
  void write(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
             std::span<const std::byte> payload);

  // A named set of texts, outside the messages.
  void metadata(std::string_view name, const McapMap& values);

  // A whole file beside the messages, with its name, media type and bytes.
  void attachment(std::string_view name, std::string_view media_type,
                  std::span<const std::byte> bytes);

  // Ends the chunk and hands it to the operating system.
  void flush();

  // Returns true while the file is still there under its name with all that was handed over. A file
  // that was deleted, moved away or cut off by another program is an error. Every write also makes
  // this check before and after it.
  bool check();

  // Writes the summary and closes the file; true when everything is in it.
  bool close();

 private:
  // The messages that a channel has written.
  struct Channel {
    std::uint32_t sequence = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  // (log time, offset) in this chunk
  };
  // Record 0x0d, written with the summary.
  struct MetadataIndex {
    std::uint64_t offset, length;
    std::string name;
  };

  // Record 0x0a, written with the summary.
  struct AttachmentIndex {
    std::uint64_t offset, length, size;
    std::string name, media_type;
  };

  void fail(const std::string& what);
  void open();
  // To the file, through the checksum.
  void put_out(std::span<const std::byte> bytes);
  void write_message_indexes(McapChunkIndex& index);
  void write_summary();

  std::filesystem::path file_;
  McapWriterOptions options_;
  int descriptor_ = -1;
  std::string error_;
  std::uint64_t offset_ = 0;  // bytes in the file
  std::uint32_t crc_ = 0;     // of them

  std::vector<McapSchema> schemas_;
  std::vector<McapChannel> channels_;
  std::vector<Channel> in_chunk_;  // by channel id - 1
  McapBytes chunk_;                // its records
  std::uint64_t chunk_messages_ = 0;
  std::uint64_t chunk_start_ns_ = 0, chunk_end_ns_ = 0;
  std::vector<std::byte> compressed_;  // scratch
  McapBytes out_;                      // scratch

  McapStatistics statistics_;
  std::vector<McapChunkIndex> chunk_indexes_;
  std::vector<MetadataIndex> metadata_indexes_;
  std::vector<AttachmentIndex> attachment_indexes_;
};

}  // namespace clearance
