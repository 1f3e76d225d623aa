// SplitMix64 (Steele, Lea, Flood 2014): the same numbers with every standard library.
#pragma once

#include <cstdint>

namespace clearance {

// The distributions of <random> differ between standard libraries; this sequence is the same
// everywhere.
class SeededDraw {
 public:
  explicit SeededDraw(std::uint64_t seed) : state_(seed) {}
  // Returns a number in [low, high).
  double uniform(double low, double high) { return low + (high - low) * unit(); }

 private:
  // Returns a number in [0, 1): the upper 53 bits, one double for each.
  double unit() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  std::uint64_t state_;
};

}  // namespace clearance
