// Durations of many repetitions, as percentiles from fixed bins.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace clearance {

// Bins are 1 ns wide up to 64 ns, and at most 1/64 of their value above, up to 2^34 ns (17 s).
// Longer durations count in the last bin. The maximum is exact. Adding allocates nothing.
class Histogram {
 public:
  void add(std::int64_t ns) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::int64_t max_ns() const noexcept { return max_ns_; }
  // These two count each value as the upper edge of its bin, at most 1/64 above it.
  [[nodiscard]] std::uint64_t count_up_to(std::int64_t ns) const noexcept;
  [[nodiscard]] std::int64_t sum_ns() const noexcept;
  // The upper edge of the bin that ends the given share of all values (0.999: p99.9), never above
  // the maximum; 0 when empty.
  [[nodiscard]] std::int64_t percentile_ns(double share) const noexcept;
  // Calls visit(upper edge in ns, count) for each bin that is not empty, in ascending order.
  template <class Visit>
  void each_bin(const Visit& visit) const {
    for (std::size_t bin = 0; bin < kBins; ++bin)
      if (bins_[bin] > 0) visit(upper_edge_ns(bin), bins_[bin]);
  }

 private:
  static constexpr int kSubBits = 6;
  static constexpr int kOctaves = 34;
  static constexpr std::size_t kBins = std::size_t{kOctaves - kSubBits + 1} << kSubBits;

  [[nodiscard]] static std::size_t bin_of(std::uint64_t ns) noexcept;
  [[nodiscard]] static std::int64_t upper_edge_ns(std::size_t bin) noexcept;

  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

}  // namespace clearance
