// The depth that a camera measures: noise within a stated bound, missing pixels, and the numbers of
// a message.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "monitor/clouds/depth_cloud.hpp"

namespace clearance::rendering {

struct DepthNoise {
  // |measured - true| is at most this, quantisation included, with the true and with the measured
  // z.
  DepthError bound;
  DepthRange range;            // true depths outside of it are missing
  double share = 0.9;          // of the bound that noise uses, 0 to 1; uniformly distributed
  double missing_share = 0.0;  // of pixels that are missing by chance, 0 to 1
  std::uint64_t seed = 1;
};

// The random numbers of one image: equal seeds and frame numbers give equal images.
class NoiseSource {
 public:
  NoiseSource(std::uint64_t seed, std::uint64_t frame) noexcept
      : state_((seed << 32U) ^ (frame * 0x9E3779B97F4A7C15U)) {}
  // In [0, 1): splitmix64 of Steele, Lea and Flood.
  [[nodiscard]] double next() noexcept;

 private:
  std::uint64_t state_;
};

// Replaces `bytes` by the pixels of an image in the byte order of this machine. `depth` is that of
// DepthRenderer. A pixel whose bound is smaller than the step of the format is missing.
void measure(std::span<const double> depth, DepthImage::Format format, const DepthNoise& noise,
             std::uint64_t frame, std::vector<std::byte>& bytes);

}  // namespace clearance::rendering
