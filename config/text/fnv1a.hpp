// A 64-bit hash that distinguishes contents that no adversary has made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace clearance {

// FNV-1a (Fowler, Noll and Vo, RFC 9923). Whoever may meet an adversary compares the contents, too.
class Fnv1a {
 public:
  // Another start gives an independent hash.
  explicit Fnv1a(std::uint64_t start = 0xcbf29ce484222325u) noexcept : hash_(start) {}

  void add(std::string_view bytes) noexcept {
    for (const char byte : bytes) add(static_cast<unsigned char>(byte));
  }
  void add(std::span<const std::byte> bytes) noexcept {
    for (const std::byte byte : bytes) add(std::to_integer<std::uint64_t>(byte));
  }
  // Adds a byte, or a word at once.
  void add(std::uint64_t word) noexcept { hash_ = (hash_ ^ word) * 0x100000001b3u; }

  [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_;
};

}  // namespace clearance
