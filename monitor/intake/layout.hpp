// How the numbers of a picture lie in the memory of its message, as the message states it: one
// check for images and points. A layout that cannot be what it says would be read as other depths.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "monitor/intake/camera_messages.hpp"

namespace clearance {

struct Layout {
  enum class Number : std::uint8_t { kMillimetres16, kMetres32 };
  Number number = Number::kMetres32;
  std::uint32_t columns = 0, rows = 0;
  std::uint64_t element_step = 0, row_step = 0;  // bytes from one to the next
  std::array<std::size_t, 3> offsets{};          // of the numbers of an element, bytes
  std::size_t numbers = 1;
  std::span<const std::byte> bytes;
};

// The number whose bytes begin here, aligned or not.
template <class Number>
[[nodiscard]] Number number_at(const std::byte* bytes) noexcept {
  Number number{};
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

// Returns kNoPixels, kTooManyPixels, kStep or kShortData, for rows that are not all there;
// kLayout for rows with as much padding as content, which hold wider numbers than the message says;
// kByteOrder for numbers that make sense in the other order only.
[[nodiscard]] FrameFault judge(const Layout& layout, std::size_t most) noexcept;

}  // namespace clearance
