// Logarithmic bins with 64 linear sub-bins for each power of two, as in HdrHistogram: the error of
// a percentile is below 1/64.
#include "monitor/loop/histogram.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {

// The highest set bit selects the octave, the six bits below it the sub-bin.
std::size_t Histogram::bin_of(std::uint64_t ns) noexcept {
  constexpr std::uint64_t kLinear = std::uint64_t{1} << kSubBits;
  if (ns < kLinear) return ns;
  const int octave = static_cast<int>(std::bit_width(ns)) - 1;  // ns is in [2^octave, 2^(octave+1))
  const std::uint64_t sub = (ns >> (octave - kSubBits)) - kLinear;
  const std::size_t bin = ((static_cast<std::size_t>(octave - kSubBits) + 1) << kSubBits) + sub;
  return std::min(bin, kBins - 1);
}

// The largest value that bin_of puts into this bin.
std::int64_t Histogram::upper_edge_ns(std::size_t bin) noexcept {
  constexpr std::size_t kLinear = std::size_t{1} << kSubBits;
  if (bin < kLinear) return static_cast<std::int64_t>(bin);
  const std::size_t shift = (bin >> kSubBits) - 1;
  const std::size_t sub = (bin & (kLinear - 1)) + kLinear;
  return static_cast<std::int64_t>(((sub + 1) << shift) - 1);
}

// A clock may step back between two readings; the duration then counts as 0.
void Histogram::add(std::int64_t ns) noexcept {
  const std::int64_t value = std::max<std::int64_t>(ns, 0);
  ++bins_[bin_of(static_cast<std::uint64_t>(value))];
  ++count_;
  max_ns_ = std::max(max_ns_, value);
}

std::uint64_t Histogram::count_up_to(std::int64_t ns) const noexcept {
  std::uint64_t count = 0;
  for (std::size_t bin = 0; bin < kBins && upper_edge_ns(bin) <= ns; ++bin) count += bins_[bin];
  return count;
}

std::int64_t Histogram::sum_ns() const noexcept {
  std::int64_t sum = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin)
    sum += static_cast<std::int64_t>(bins_[bin]) * std::min(upper_edge_ns(bin), max_ns_);
  return sum;
}

// The nearest-rank definition: the smallest edge below which at least this share lies.
std::int64_t Histogram::percentile_ns(double share) const noexcept {
  if (count_ == 0) return 0;
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    seen += bins_[bin];
    if (seen >= wanted && seen > 0) return std::min(upper_edge_ns(bin), max_ns_);
  }
  return max_ns_;
}

}  // namespace clearance
