// Reads MCAP files of any origin and in any state. A file is streamed from the front up to the end
// or the damage. For a window of time, it is read through the index.
//
// Chunks may be compressed by zstd or LZ4; others are refused by name. Padding and unknown records
// are skipped. A length in the file is trusted only up to the file's size and 1 GiB,
// and a chunk is decompressed only up to 256 MiB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "monitor/files/compression.hpp"
#include "monitor/files/file.hpp"
#include "monitor/files/format.hpp"

namespace clearance {

// A length that a flipped bit made huge must not allocate that much.
inline constexpr std::uint64_t kLargestMcapRecord = std::uint64_t{1} << 30;  // in memory at once
// A small compressed chunk can state to be huge. Writers make chunks of a few MiB, or of one
// message.
inline constexpr std::uint64_t kLargestMcapChunk = std::uint64_t{1} << 28;  // decompressed

// One message; its payload is a view into the reader.
struct McapMessage {
  const McapChannel* channel = nullptr;  // valid as long as the reader
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;  // ns
  std::span<const std::byte> payload;            // valid until the next call
};

// The summary section at the end of a closed file.
struct McapSummary {
  McapStatistics statistics;
  std::map<std::uint16_t, McapChannel> channels;
  std::vector<McapChunkIndex> chunks;  // in file order
  std::map<std::string, McapMap> metadata;
};

// None when the file was never closed, or its summary is missing or damaged.
[[nodiscard]] std::optional<McapSummary> read_mcap_summary(McapFile& file);

struct McapWindow {  // log times, ns, both included
  std::uint64_t start_ns = 0;
  std::uint64_t end_ns = std::numeric_limits<std::uint64_t>::max();
};

// Only one thread may use it at a time. Exceptions come from memory allocation only; faults of the
// file are in error().
class McapReader {
 public:
  // Only messages inside the window are returned; when the file is indexed, only their chunks are
  // read.
  explicit McapReader(const std::filesystem::path& file, const McapWindow& window = {});
  // The same from memory, which must outlive the reader; `name` is used in messages.
  McapReader(std::span<const std::byte> bytes, const std::string& name,
             const McapWindow& window = {});

  // The next message in file order. False at the end, or where the file stops making sense: then
  // error() is not empty.
  [[nodiscard]] bool next(McapMessage& message);

  // A sentence with file, byte offset, reason and how much was read before; empty for a sound file.
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  // True when the file was cut off or damaged: the messages before the damage are sound and
  // complete. False when it is no MCAP file, or one that this reader does not take.
  [[nodiscard]] bool readable() const noexcept { return readable_; }

  // Nothing where the file was cut off or its end is damaged.
  [[nodiscard]] const std::optional<McapSummary>& summary() const noexcept { return summary_; }
  // The records read so far.
  [[nodiscard]] const std::map<std::string, McapMap>& metadata() const noexcept {
    return metadata_;
  }
  // Messages of the window handed out so far.
  [[nodiscard]] std::uint64_t messages() const noexcept { return messages_; }
  // Share of the file that has been read, 0 to 1.
  [[nodiscard]] double progress() const noexcept;

 private:
  // The header of a record.
  struct Record {
    McapKind kind;
    std::uint64_t offset;  // of its first byte in the file
    std::uint64_t length;  // of its body
  };

  void begin();
  // Both set error() and end the reading.
  void damage(std::uint64_t offset, const std::string& what);
  void cut_off(std::uint64_t offset);
  [[nodiscard]] bool read_magic();
  [[nodiscard]] bool next_record(Record& record);
  [[nodiscard]] bool next_indexed_chunk(Record& record);
  // False, and the reading has ended: it is cut off, or too long.
  [[nodiscard]] bool read_body(const Record& record);
  void pass_over(const Record& record);
  // One record outside chunks; sets `found` when it is a message of the window.
  void take(const Record& record, McapMessage& message, bool& found);
  void open_chunk(const Record& record);
  [[nodiscard]] std::span<const std::byte> decompressed(const Record& record, McapCompression how,
                                                        std::span<const std::byte> stored,
                                                        std::uint64_t size);
  [[nodiscard]] static std::string too_large(std::string_view what, std::uint64_t bytes,
                                             std::uint64_t most);
  void refuse_compression(const std::string& compression);
  void take_from_chunk(McapMessage& message, bool& found);
  void end_data(const Record& record);
  void end_file(const Record& record);
  // A record that stands outside chunks and in them alike; false when its content makes no sense.
  [[nodiscard]] bool take_definition(McapKind kind, std::span<const std::byte> body);
  [[nodiscard]] bool take_message(std::span<const std::byte> body, McapMessage& message,
                                  bool& found);

  std::filesystem::path path_;
  McapWindow window_;
  McapFile file_;
  std::optional<McapSummary> summary_;
  bool indexed_ = false;        // reading chunks through the summary
  std::size_t next_chunk_ = 0;  // into summary_->chunks

  std::uint64_t offset_ = 0;  // of the next record
  std::uint32_t crc_ = 0;     // of everything before it, when streaming
  bool has_chunks_ = false;
  bool data_ended_ = false;
  bool done_ = false;
  bool readable_ = true;
  std::string error_;

  std::vector<std::byte> body_;
  std::vector<std::byte> decompressed_;  // records of the open chunk, where they are compressed
  std::span<const std::byte> chunk_;     // what is left of the open chunk; part of one of these
  std::uint64_t chunk_offset_ = 0, chunk_end_ = 0;  // of its record in the file
  bool chunk_is_stored_ = true;                     // not compressed
  bool chunk_cut_off_ = false;

  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::map<std::string, McapMap> metadata_;
  std::uint64_t messages_ = 0;
  std::uint64_t first_ns_ = 0, last_ns_ = 0;
};

}  // namespace clearance
