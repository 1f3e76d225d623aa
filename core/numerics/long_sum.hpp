// Sums of products of doubles without any rounding, however far apart their exponents are: a number
// in fixed point that is as long as the range of such products. For the few queries that hang on a
// sign which no double can hold.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/numerics/double_double.hpp"
#include "core/vec.hpp"

namespace clearance {

// Holds any sum of up to 2^30 products of kFactors doubles.
template <int kFactors>
class LongSum {
 public:
  // What fits: digits from 2^kLowest to below 2^kHighest.
  static constexpr int kLowest = -32 * 36 * kFactors, kHighest = 32 * 32 * kFactors;

  LongSum() noexcept {}  // NOLINT: most digits are never looked at
  LongSum(const LongSum& other) noexcept { *this = other; }  // NOLINT: nor copied
  LongSum& operator=(const LongSum& other) noexcept {
    if (this == &other) return *this;
    first_ = other.first_;
    last_ = other.last_;
    for (std::size_t i = first_; i < last_; ++i) digits_[i] = other.digits_[i];
    return *this;
  }

  // Adds x 2^exponent, which must be in range.
  void add(double x, int exponent = 0) noexcept {
    if (x == 0.0) return;
    int up = 0;
    const auto whole = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &up), 53));
    const int lowest = up - 53 + exponent + 32 * kPoint;
    const auto at = static_cast<std::size_t>(lowest / 32);
    const std::int64_t low = whole & 0xffffffff, high = whole >> 32;
    const int shift = lowest % 32;
    cover(at, at + 3);
    digits_[at] += low << shift & 0xffffffff;
    digits_[at + 1] += (low << shift >> 32) + ((high << shift) & 0xffffffff);
    digits_[at + 2] += high << shift >> 32;
    carry(at, at + 3);
  }
  // Adds sign a b, sign being 1 or -1.
  template <int kOfA, int kOfB>
  void add_product(const LongSum<kOfA>& a, const LongSum<kOfB>& b, int sign = 1) noexcept {
    static_assert(kOfA + kOfB == kFactors);
    if (a.sign() == 0 || b.sign() == 0) return;
    // Most digits of a sum of a few products are zero.
    std::array<std::size_t, LongSum<kOfB>::kDigits> of_b;
    std::size_t count = 0;
    for (std::size_t k = b.first_; k < b.last_; ++k) {
      if (b.digits_[k] != 0) of_b[count++] = k;
    }
    cover(a.first_ + b.first_, a.last_ + b.last_);
    for (std::size_t i = a.first_; i < a.last_; ++i) {
      const std::int64_t by = sign * a.digits_[i];
      if (by == 0) continue;
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = i + of_b[k];
        const std::int64_t product = by * b.digits_[of_b[k]], above = (product + kHalf) >> 32;
        digits_[at] += product - (above << 32);
        digits_[at + 1] += above;
      }
    }
    carry(a.first_ + b.first_, a.last_ + b.last_);
  }

  void negate() noexcept {
    for (std::size_t i = first_; i < last_; ++i) digits_[i] = -digits_[i];
    carry(first_, last_);
  }

  [[nodiscard]] int sign() const noexcept {
    if (first_ >= last_) return 0;
    return digits_[last_ - 1] > 0 ? 1 : -1;
  }
  // Of about this power of two, at most twice too large.
  [[nodiscard]] int exponent() const noexcept {
    if (sign() == 0) return 0;
    return std::ilogb(static_cast<double>(digits_[last_ - 1])) + exponent_of(last_ - 1);
  }
  // Times 2^exponent, to 2^-104.
  [[nodiscard]] DoubleDouble scaled(int exponent) const noexcept {
    DoubleDouble out;
    for (std::size_t i = std::max(first_, last_ - std::min<std::size_t>(last_, 5)); i < last_;
         ++i) {
      out = out +
            DoubleDouble(std::ldexp(static_cast<double>(digits_[i]), exponent_of(i) + exponent));
    }
    return out;
  }

 private:
  template <int kOther>
  friend class LongSum;

  // A double has its digits in 68; of a product the places add up.
  static constexpr int kPoint = -kLowest / 32;
  static constexpr std::size_t kDigits = (kHighest - kLowest) / 32 + 3;
  static constexpr std::int64_t kHalf = std::int64_t{1} << 31;

  static int exponent_of(std::size_t digit) noexcept {
    return 32 * (static_cast<int>(digit) - kPoint);
  }
  // Digits in [from, to) are some, those not used before zero.
  void cover(std::size_t from, std::size_t to) noexcept {
    if (first_ >= last_) first_ = last_ = from;
    while (from < first_) digits_[--first_] = 0;
    while (last_ < to) digits_[last_++] = 0;
  }
  // Digits from -2^31 to 2^31 - 1, so that the highest one has the sign of the sum. Those in
  // [from, to) may have grown.
  void carry(std::size_t from, std::size_t to) noexcept {
    std::int64_t over = 0;
    for (std::size_t i = from; i < to || over != 0; ++i) {
      cover(i, i + 1);
      const std::int64_t digit = digits_[i] + over;
      over = (digit + kHalf) >> 32;
      digits_[i] = digit - over * (2 * kHalf);
    }
    while (last_ > first_ && digits_[last_ - 1] == 0) --last_;
    while (first_ < last_ && digits_[first_] == 0) ++first_;
  }

  std::array<std::int64_t, kDigits> digits_;  // the lowest first
  std::size_t first_ = 0, last_ = 0;          // of those that are in use; all others are zero
};

template <int kFactors>
using LongVec = std::array<LongSum<kFactors>, 3>;

template <int kOfA, int kOfB>
[[nodiscard]] LongSum<kOfA + kOfB> dot(const LongVec<kOfA>& a, const LongVec<kOfB>& b) noexcept {
  LongSum<kOfA + kOfB> out;
  for (std::size_t i = 0; i < 3; ++i) out.add_product(a[i], b[i]);
  return out;
}

template <int kOfA, int kOfB>
[[nodiscard]] LongVec<kOfA + kOfB> cross(const LongVec<kOfA>& a, const LongVec<kOfB>& b) noexcept {
  LongVec<kOfA + kOfB> out;
  for (std::size_t x = 0; x < 3; ++x) {
    const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
    out[x].add_product(a[y], b[z]);
    out[x].add_product(a[z], b[y], -1);
  }
  return out;
}

}  // namespace clearance
