// A digest of bytes, eight a step (FNV-1a's mixing). Equal bytes have the same digest; bytes that
// differ have the same one by chance only, once in 2^64.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace clearance {

class Digest {
 public:
  void add(std::span<const std::byte> bytes) noexcept {
    while (bytes.size() >= sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data(), sizeof word);
      mix(word);
      bytes = bytes.subspan(sizeof word);
    }
    for (const std::byte byte : bytes) mix(std::to_integer<std::uint64_t>(byte));
  }
  void add(std::string_view text) noexcept { add(std::as_bytes(std::span(text))); }
  void add(std::uint64_t number) noexcept { mix(number); }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  void mix(std::uint64_t word) noexcept {
    value_ = (value_ ^ word) * 0x100000001B3U;
    value_ ^= value_ >> 29;
  }
  std::uint64_t value_ = 0xCBF29CE484222325U;
};

// A digest of one depth; 0 for what is none: NaN, infinity and 0.
[[nodiscard]] inline std::uint32_t digest_of_depth(float depth) noexcept {
  return std::isfinite(depth) && depth != 0.0F ? std::bit_cast<std::uint32_t>(depth) : 0;
}

}  // namespace clearance
