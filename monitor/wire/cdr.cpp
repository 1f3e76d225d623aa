// Uses Cyclone's own serializer, so that a recording has the bytes of the network. Input is first
// normalised, which checks every length, and only then read.
#include "monitor/wire/cdr.hpp"

#include <cstdint>
#include <cstring>
#include <limits>

#include "monitor/wire/cyclone_private.hpp"

namespace clearance {
namespace {

constexpr std::size_t kHeader = 4;      // representation id (2), options (2); big-endian both
constexpr std::size_t kMaxPadding = 3;  // what may follow the last field
constexpr std::byte kXcdr1LittleEndian{1};

// The meaning of the first two bytes (DDSI-RTPS 2.3, section 10.2).
struct Encapsulation {
  std::uint32_t xcdr_version;
  bool big_endian;
};

// The representations that a @final type can have (DDS-XTypes 1.3, table 60).
bool read_encapsulation(std::span<const std::byte> cdr, Encapsulation& out) {
  if (cdr.size() < kHeader || cdr[0] != std::byte{0}) return false;
  switch (std::to_integer<int>(cdr[1])) {
    case 0:
      out = {.xcdr_version = 1, .big_endian = true};
      return true;
    case 1:
      out = {.xcdr_version = 1, .big_endian = false};
      return true;
    case 6:
      out = {.xcdr_version = 2, .big_endian = true};
      return true;
    case 7:
      out = {.xcdr_version = 2, .big_endian = false};
      return true;
    default:
      return false;
  }
}

// Checked bytes in native order into a sample.
void read(const void* bytes, std::uint32_t size, std::uint32_t xcdr_version, void* sample,
          const dds_topic_descriptor_t& type) {
  dds_istream_t in;
  dds_istream_init(&in, size, bytes, xcdr_version);
  dds_stream_read(&in, static_cast<char*>(sample), type.m_ops);
  dds_istream_fini(&in);
}

}  // namespace

// Keeps Cyclone's header out of ours.
struct CdrEncoder::Stream {
  dds_ostreamLE_t out;
};

// XCDR version 1; the size 0 lets the buffer grow when needed.
CdrEncoder::CdrEncoder() : stream_(new Stream) { dds_ostreamLE_init(&stream_->out, 0, 1); }

CdrEncoder::~CdrEncoder() {
  dds_ostreamLE_fini(&stream_->out);
  delete stream_;
}

// The low two bits of the options are the number of padding bytes (DDS-XTypes 1.3, section
// 7.6.3.1.2).
std::span<const std::byte> CdrEncoder::encode(const void* sample,
                                              const dds_topic_descriptor_t& type) {
  dds_ostream_t& out = stream_->out.x;
  out.m_index = 0;
  if (dds_stream_writeLE(&stream_->out, static_cast<const char*>(sample), type.m_ops) == nullptr) {
    // Cyclone 0.10.2 has released the buffer when it refuses a sequence, without saying so in the
    // stream.
    dds_ostreamLE_init(&stream_->out, 0, 1);
    return {};
  }
  const std::size_t padding = (kHeader - out.m_index % kHeader) % kHeader;
  bytes_.assign(kHeader + out.m_index + padding, std::byte{0});
  bytes_[1] = kXcdr1LittleEndian;
  bytes_[3] = static_cast<std::byte>(padding);
  std::memcpy(bytes_.data() + kHeader, out.m_buffer, out.m_index);
  return bytes_;
}

// Bytes of a reader are read where they are: half of the time goes without the copy and the check.
// Others are copied, since normalising swaps them in place and needs alignment to 8.
bool CdrDecoder::decode(std::span<const std::byte> cdr, void* sample,
                        const dds_topic_descriptor_t& type, CdrBytes origin) {
  Encapsulation encapsulation{};
  if (!read_encapsulation(cdr, encapsulation)) return false;
  const std::span<const std::byte> body = cdr.subspan(kHeader);
  if (body.size() > std::numeric_limits<std::uint32_t>::max() - 8) return false;
  const auto size = static_cast<std::uint32_t>(body.size());
  if (origin == CdrBytes::kOfReader && !encapsulation.big_endian) {
    read(body.data(), size, encapsulation.xcdr_version, sample, type);
    return true;
  }
  scratch_.resize(body.size() / sizeof(std::uint64_t) + 1);
  std::memcpy(scratch_.data(), body.data(), body.size());
  char* const bytes = reinterpret_cast<char*>(scratch_.data());

  // Checks every length against what is there and puts the bytes into native order; dds_stream_read
  // itself trusts them.
  std::uint32_t end = 0;
  const bool sound = dds_stream_normalize_data(bytes, &end, size, encapsulation.big_endian,
                                               encapsulation.xcdr_version, type.m_ops) != nullptr;
  if (!sound || size - end > kMaxPadding) return false;

  read(bytes, end, encapsulation.xcdr_version, sample, type);
  return true;
}

}  // namespace clearance
