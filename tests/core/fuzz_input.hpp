// Decodes the bytes that a fuzz target receives.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/pose.hpp"

namespace clearance {

// The input, byte by byte, followed by zeros.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  [[nodiscard]] bool any_left() const { return at_ < size_; }
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }
  std::uint32_t word() {
    const std::uint32_t low = byte(), high = byte();
    return low | high << 8;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

inline void append_numbers(Pose& pose, std::vector<double*>& numbers) {
  for (int k = 0; k < 3; ++k) numbers.push_back(&pose.position[k]);
  for (int k = 0; k < 4; ++k) numbers.push_back(&pose.orientation.coeffs()[k]);
}

// Changes numbers until the input ends. They become neighbouring doubles, zero or another of the
// numbers, or change by a little or by powers of two from 2^-powers to below 2^powers.
inline void change(std::span<double* const> numbers, int powers, Bytes& bytes) {
  while (bytes.any_left()) {
    double& x = *numbers[bytes.word() % numbers.size()];
    const std::uint8_t how = bytes.byte();
    switch (how % 6) {
      case 0:
        x = std::nextafter(x, how < 128 ? -HUGE_VAL : HUGE_VAL);
        break;
      case 1:
        x = 0.0;
        break;
      case 2:
        x = -x;
        break;
      case 3:
        x = *numbers[bytes.word() % numbers.size()];
        break;
      case 4:
        x = std::ldexp(x, bytes.byte() % (2 * powers) - powers);
        break;
      default:
        x += (how - 128) * std::ldexp(1.0, -bytes.byte() % 64);
    }
  }
}

}  // namespace clearance
