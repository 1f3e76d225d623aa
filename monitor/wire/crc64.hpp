// CRC-64 of values, the same on every machine: the polynomial of ECMA-182, reflected, as in XZ
// files. It finds every error of one to three bits in up to 2 MB, and each burst of up to 64 bits.
#pragma once

#include <lzma.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace clearance {

// Values count in their own width, lowest byte first.
class Crc64 {
 public:
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T value) noexcept {
    static_assert(std::endian::native == std::endian::little);
    if (used_ + sizeof value > bytes_.size()) flush();
    std::memcpy(bytes_.data() + used_, &value, sizeof value);
    used_ += sizeof value;
  }
  // Never 0, which stands for none.
  [[nodiscard]] std::uint64_t value() noexcept {
    flush();
    return value_ == 0 ? 1 : value_;
  }

 private:
  void flush() noexcept {
    value_ = lzma_crc64(bytes_.data(), used_, value_);
    used_ = 0;
  }

  std::array<std::uint8_t, 2048> bytes_;
  std::size_t used_ = 0;
  std::uint64_t value_ = 0;
};

}  // namespace clearance
