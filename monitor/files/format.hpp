// The MCAP container (version 0) as writer and reader share it: record kinds, bytes, checksums.
//
// A file is magic, records, magic; a record is u8 kind, u64 length, body; all little-endian. A
// string is u32 length and UTF-8; maps and arrays are prefixed by their length in bytes.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clearance {

static_assert(std::endian::native == std::endian::little, "MCAP integers are copied as they are");

// At the beginning and at the end of a file (mcap.dev/spec, "Magic").
inline constexpr std::array<unsigned char, 8> kMcapMagic = {0x89, 'M', 'C',  'A',
                                                            'P',  '0', '\r', '\n'};

// Opcodes of the specification, section "Records". 0x00 is not valid, 0x80 and above are private.
enum class McapKind : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0a,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

// Bytes; both are fixed by the specification.
inline constexpr std::size_t kMcapRecordHeader = 9;  // kind and length
inline constexpr std::size_t kMcapFooterBody = 20;   // summary start, offsets start, CRC

// Ordered by key, so that the same map gives the same bytes.
using McapMap = std::map<std::string, std::string>;

// Record 0x03, without its id.
struct McapSchema {
  std::string name;      // e.g. clearance::msg::PoseBatch
  std::string encoding;  // e.g. omgidl
  std::string text;
  bool operator==(const McapSchema&) const = default;
};

// Record 0x04, together with its schema.
struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  // 0: none
  McapSchema schema;
  std::string topic;
  std::string encoding;  // of the messages, e.g. cdr
  McapMap metadata;
  bool operator==(const McapChannel&) const = default;
};

// Record 0x08: where a chunk is and which log times it spans, so that a reader can skip it.
struct McapChunkIndex {
  std::uint64_t start_ns = 0, end_ns = 0;  // smallest and largest log time
  std::uint64_t offset = 0, length = 0;    // of the chunk record, its 9-byte header included
  std::map<std::uint16_t, std::uint64_t> message_indexes;  // channel to file offset
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed = 0, uncompressed = 0;  // bytes
};

// Record 0x0b: counts and the span of log times of the whole file.
struct McapStatistics {
  std::uint64_t messages = 0;
  std::uint32_t chunks = 0;
  std::uint32_t metadata = 0;
  std::uint64_t start_ns = 0, end_ns = 0;
  std::map<std::uint16_t, std::uint64_t> channel_messages;
};

// zlib's CRC-32, continued from `crc` (0 to begin). In a file, 0 stands for 'not given'.
[[nodiscard]] std::uint32_t mcap_crc(std::uint32_t crc, std::span<const std::byte> bytes) noexcept;

// Appends little-endian values to a buffer.
class McapBytes {
 public:
  // Everything put so far; valid until the next put.
  [[nodiscard]] std::span<const std::byte> view() const noexcept { return bytes_; }
  [[nodiscard]] std::size_t size() const noexcept { return bytes_.size(); }
  void clear() noexcept { bytes_.clear(); }

  // Any integer, as its bytes stand in memory.
  template <class Integer>
  void put(Integer value) {
    put_raw(std::as_bytes(std::span(&value, 1)));
  }
  // Bytes as they are, without a length.
  void put_raw(std::span<const std::byte> bytes) {
    if (bytes.empty()) return;
    const std::size_t begin = bytes_.size();
    bytes_.resize(begin + bytes.size());
    std::memcpy(bytes_.data() + begin, bytes.data(), bytes.size());
  }
  // u32 length and UTF-8 bytes.
  void put_text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    put_raw(std::as_bytes(std::span(text)));
  }
  // u32 length in bytes, then keys and values in turn.
  void put_map(const McapMap& map) {
    const std::size_t length = begin_length<std::uint32_t>();
    for (const auto& [key, value] : map) {
      put_text(key);
      put_text(value);
    }
    end_length<std::uint32_t>(length);
  }

  // A length that is known only afterwards: of a record, a map or an array.
  template <class Length>
  [[nodiscard]] std::size_t begin_length() {
    put(Length{0});
    return bytes_.size();
  }
  template <class Length>
  void end_length(std::size_t begin) {
    const auto length = static_cast<Length>(bytes_.size() - begin);
    std::memcpy(bytes_.data() + begin - sizeof(Length), &length, sizeof(Length));
  }
  // Returns the place that end_record() needs; records do not nest except in chunks.
  [[nodiscard]] std::size_t begin_record(McapKind kind) {
    put(static_cast<std::uint8_t>(kind));
    return begin_length<std::uint64_t>();
  }
  // Fills in the length that begin_record() left open.
  void end_record(std::size_t begin) { end_length<std::uint64_t>(begin); }

 private:
  std::vector<std::byte> bytes_;
};

// Reads what McapBytes wrote, from bytes of any origin: what is not there reads as zero or empty
// and turns ok() false for good.
class McapFields {
 public:
  explicit McapFields(std::span<const std::byte> bytes) : rest_(bytes) {}

  // False once something was missing; every value read since is zero or empty.
  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] std::span<const std::byte> rest() const noexcept { return rest_; }

  template <class Integer>
  [[nodiscard]] Integer get() noexcept {
    Integer value{};
    const std::span<const std::byte> bytes = get_raw(sizeof(Integer));
    if (ok_) std::memcpy(&value, bytes.data(), sizeof(Integer));
    return value;
  }
  // A view; empty once anything was missing.
  [[nodiscard]] std::span<const std::byte> get_raw(std::uint64_t size) noexcept {
    if (!ok_ || size > rest_.size()) {
      ok_ = false;
      return {};
    }
    const std::span<const std::byte> bytes = rest_.first(static_cast<std::size_t>(size));
    rest_ = rest_.subspan(static_cast<std::size_t>(size));
    return bytes;
  }
  // Reads what put_text() wrote. The text is not checked for UTF-8.
  [[nodiscard]] std::string get_text() {
    const std::span<const std::byte> bytes = get_raw(get<std::uint32_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  // A key that stands twice keeps its last value.
  [[nodiscard]] McapMap get_map() {
    McapFields entries(get_raw(get<std::uint32_t>()));
    McapMap map;
    while (entries.ok() && !entries.rest().empty()) {
      const std::string key = entries.get_text();
      map[key] = entries.get_text();
    }
    ok_ = ok_ && entries.ok();
    return map;
  }
  // The fields that follow the id of a schema.
  [[nodiscard]] McapSchema get_schema() {
    McapSchema schema;
    schema.name = get_text();
    schema.encoding = get_text();
    schema.text = get_text();
    return schema;
  }
  // The fields that follow the id of a channel; without its schema, of which the record has the id
  // only.
  [[nodiscard]] McapChannel get_channel(std::uint16_t id) {
    McapChannel channel;
    channel.id = id;
    channel.schema_id = get<std::uint16_t>();
    channel.topic = get_text();
    channel.encoding = get_text();
    channel.metadata = get_map();
    return channel;
  }
  // A map from channel ids to numbers.
  [[nodiscard]] std::map<std::uint16_t, std::uint64_t> get_channel_map() {
    McapFields entries(get_raw(get<std::uint32_t>()));
    std::map<std::uint16_t, std::uint64_t> map;
    while (entries.ok() && !entries.rest().empty()) {
      const auto channel = entries.get<std::uint16_t>();
      map[channel] = entries.get<std::uint64_t>();
    }
    ok_ = ok_ && entries.ok();
    return map;
  }

 private:
  std::span<const std::byte> rest_;
  bool ok_ = true;
};

}  // namespace clearance
