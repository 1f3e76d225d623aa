// CDR bytes of our topic types without a participant: what a recording holds and what DDS sends.
//
// Bytes start with the 4-byte encapsulation header. Encoding writes XCDR1 little-endian, padded to
// 4 bytes, which is what Cyclone 0.10.2 puts on the wire for @final types. Decoding takes XCDR1 and
// plain XCDR2 of either byte order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Encodes samples one after another; keeps its buffer, so that repeated use settles to no
// allocation.
class CdrEncoder {
 public:
  CdrEncoder();
  ~CdrEncoder();
  CdrEncoder(const CdrEncoder&) = delete;
  CdrEncoder& operator=(const CdrEncoder&) = delete;

  // The bytes, valid until the next call. Empty when the sample cannot be on the wire: a sequence
  // or string longer than its bound.
  template <class T>
  [[nodiscard]] std::span<const std::byte> encode(const T& sample) {
    return encode(&sample, topic_descriptor<T>());
  }
  [[nodiscard]] std::span<const std::byte> encode(const void* sample,
                                                  const dds_topic_descriptor_t& type);

 private:
  struct Stream;
  Stream* stream_;
  std::vector<std::byte> bytes_;
};

// The origin of bytes, which determines the checks that they need.
enum class CdrBytes : std::uint8_t {
  kUnchecked,  // any origin: every length is checked before it is followed
  kOfReader,   // Cyclone's reader, which has checked them and put them into native byte order
};

// Decodes bytes of any origin into samples: malformed, truncated or over-long input is refused,
// never followed. Keeps a scratch buffer between calls.
class CdrDecoder {
 public:
  // False leaves `sample` as it was. True replaces its content, reusing its sequences where they
  // fit.
  template <class T>
  [[nodiscard]] bool decode(std::span<const std::byte> cdr, Sample<T>& sample,
                            CdrBytes bytes = CdrBytes::kUnchecked) {
    return decode(cdr, &*sample, topic_descriptor<T>(), bytes);
  }
  // `sample` must own what it points to, as Sample does.
  [[nodiscard]] bool decode(std::span<const std::byte> cdr, void* sample,
                            const dds_topic_descriptor_t& type,
                            CdrBytes bytes = CdrBytes::kUnchecked);

 private:
  std::vector<std::uint64_t> scratch_;  // 8-byte words: the stream functions read aligned values
};

}  // namespace clearance
