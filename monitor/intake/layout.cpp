#include "monitor/intake/layout.hpp"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace clearance {
namespace {

// Elements that are looked at, spread evenly.
constexpr std::uint64_t kMostLookedAt = 4096;
// Tolerates this many numbers that look like lengths only by chance, in a picture without depth.
constexpr std::size_t kFewNumbers = 8;

template <class Word>
Word word_at(const std::byte* bytes) noexcept {
  Word word{};
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

std::uint16_t turned(std::uint16_t word) noexcept { return __builtin_bswap16(word); }
std::uint32_t turned(std::uint32_t word) noexcept { return __builtin_bswap32(word); }

// A length in metres that a sensor may have measured. The exponents of words in the wrong order are
// random, and one in four gives such a length.
bool is_length(std::uint32_t word) noexcept {
  const float metres = std::abs(std::bit_cast<float>(word));
  return metres >= 1e-3F && metres <= 1e7F;
}
// Two depths of one surface that are not equal. In the wrong order, they differ by multiples of
// 256 mm.
bool are_neighbours(std::uint16_t a, std::uint16_t b) noexcept {
  return a != 0 && b != 0 && a != b && std::abs(int{a} - int{b}) < 256;
}

bool has_other_byte_order(const Layout& layout) noexcept {
  const std::uint64_t count = std::uint64_t{layout.columns} * layout.rows;
  const std::uint64_t stride = (count + kMostLookedAt - 1) / kMostLookedAt;
  std::size_t as_stated = 0, in_the_other = 0;
  for (std::uint64_t i = 0; i < count; i += stride) {
    const std::uint64_t column = i % layout.columns;
    const std::byte* const element =
        layout.bytes.data() + i / layout.columns * layout.row_step + column * layout.element_step;
    if (layout.number == Layout::Number::kMillimetres16) {
      if (column + 1 == layout.columns) continue;
      const auto a = word_at<std::uint16_t>(element);
      const auto b = word_at<std::uint16_t>(element + layout.element_step);
      as_stated += are_neighbours(a, b) ? 1 : 0;
      in_the_other += are_neighbours(turned(a), turned(b)) ? 1 : 0;
      continue;
    }
    for (std::size_t k = 0; k < layout.numbers; ++k) {
      const auto word = word_at<std::uint32_t>(element + layout.offsets[k]);
      as_stated += is_length(word) ? 1 : 0;
      in_the_other += is_length(turned(word)) ? 1 : 0;
    }
  }
  return in_the_other > 2 * as_stated + kFewNumbers;
}

}  // namespace

// Products of the message's 32-bit numbers do not overflow 64 bits.
FrameFault judge(const Layout& layout, std::size_t most) noexcept {
  if (layout.columns == 0 || layout.rows == 0) return FrameFault::kNoPixels;
  if (std::uint64_t{layout.columns} * layout.rows > most) return FrameFault::kTooManyPixels;
  const std::uint64_t row = layout.columns * layout.element_step;
  if (layout.row_step < row) return FrameFault::kStep;
  // The last row may end without its padding.
  const std::uint64_t bytes = layout.bytes.size();
  if (bytes < row || (bytes - row) / layout.row_step < layout.rows - 1)
    return FrameFault::kShortData;
  if (layout.rows > 1 && layout.row_step >= 2 * row) return FrameFault::kLayout;
  return has_other_byte_order(layout) ? FrameFault::kByteOrder : FrameFault::kNoFault;
}

}  // namespace clearance
