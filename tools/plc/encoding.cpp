#include "tools/plc/encoding.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace clearance::plc {
namespace {

// The largest count that is not above value * per_si. The product is rounded, and fma() tells
// whether the count has come to stand above it.
double counts_below(double value, double per_si, bool is_float) noexcept {
  const double product = value * per_si;
  const auto is_above = [&](double count) { return std::fma(value, per_si, -count) < 0.0; };
  if (!is_float) {
    const double count = std::floor(product);
    return is_above(count) ? count - 1.0 : count;
  }
  if (std::fabs(product) > std::numeric_limits<float>::max()) return product;
  float count = static_cast<float>(product);
  while (is_above(count)) count = std::nextafter(count, -std::numeric_limits<float>::infinity());
  return count;
}

std::uint16_t swapped(std::uint16_t word) noexcept {
  return static_cast<std::uint16_t>(word << 8 | word >> 8);
}

std::array<std::uint16_t, 2> words_of(const PlcTypeKey& type, std::uint8_t order, double count) {
  const std::uint32_t bits = type.is_float
                                 ? std::bit_cast<std::uint32_t>(static_cast<float>(count))
                                 : static_cast<std::uint32_t>(static_cast<std::int64_t>(count));
  const auto low = static_cast<std::uint16_t>(bits);
  std::array words{static_cast<std::uint16_t>(bits >> 16), low};
  if (type.registers == 1) words = {low, 0};
  const char first = kPlcOrders[order].front();
  if (type.registers == 2 && (first == 'C' || first == 'D')) std::swap(words[0], words[1]);
  if (first == 'B' || first == 'D') words = {swapped(words[0]), swapped(words[1])};
  return words;
}

}  // namespace

double safe_end(const PlcRow& row) noexcept {
  return row.key().quantity == PlcQuantity::kLength ? row.width().least : 0.0;
}

Encoded encode(const PlcRow& row, std::uint8_t order, double value) noexcept {
  const PlcTypeKey& type = row.width();
  Encoded encoded{.count = safe_end(row)};
  const double count = counts_below(value, row.per_si(), type.is_float);
  if (count > type.most)
    encoded.fits = false;
  else if (count > encoded.count)
    encoded.count = count;
  encoded.words = words_of(type, order, encoded.count);
  return encoded;
}

}  // namespace clearance::plc
