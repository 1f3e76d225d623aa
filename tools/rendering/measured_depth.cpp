#include "tools/rendering/measured_depth.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace clearance::rendering {
namespace {

constexpr double kStep = 0.001;  // m, of 16UC1
constexpr double kMost16 = 65535.0 * kStep;

// A depth in a format, as a number and as its bytes.
struct Millimetres {
  using Pixel = std::uint16_t;
  static constexpr Pixel kMissing = 0;
  static double half_step(double) noexcept { return 0.5 * kStep; }
  static Pixel pixel(double z) noexcept {
    return static_cast<Pixel>(std::lround(std::clamp(z, 0.0, kMost16) / kStep));
  }
  static double depth(Pixel pixel) noexcept { return pixel * kStep; }
};
struct Metres {
  using Pixel = float;
  static constexpr Pixel kMissing = std::numeric_limits<float>::quiet_NaN();
  static double half_step(double z) noexcept { return 0x1p-24 * z; }
  static Pixel pixel(double z) noexcept { return static_cast<float>(z); }
  static double depth(Pixel pixel) noexcept { return double{pixel}; }
};

template <class Format>
typename Format::Pixel measured(double z, const DepthNoise& noise, NoiseSource& random) noexcept {
  const double chance = random.next(), uniform = 2.0 * random.next() - 1.0;
  if (!(z >= noise.range.least && z <= noise.range.greatest) || chance < noise.missing_share)
    return Format::kMissing;
  const auto is_within = [&](typename Format::Pixel pixel) {
    const double found = Format::depth(pixel);
    const double most = std::min(noise.bound.at(z), noise.bound.at(found));
    return found > 0.0 && std::abs(found - z) <= most * (1.0 - 1e-12);
  };
  const double width = std::max(0.0, noise.bound.at(z) - Format::half_step(z)) * noise.share;
  for (const double candidate : {z + uniform * width, z}) {
    const typename Format::Pixel pixel = Format::pixel(candidate);
    if (is_within(pixel)) return pixel;
  }
  return Format::kMissing;
}

template <class Format>
void measure_as(std::span<const double> depth, const DepthNoise& noise, std::uint64_t frame,
                std::vector<std::byte>& bytes) {
  NoiseSource random(noise.seed, frame);
  bytes.resize(depth.size() * sizeof(typename Format::Pixel));
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const auto pixel = measured<Format>(depth[i], noise, random);
    std::memcpy(&bytes[i * sizeof pixel], &pixel, sizeof pixel);
  }
}

}  // namespace

double NoiseSource::next() noexcept {
  std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
}

void measure(std::span<const double> depth, DepthImage::Format format, const DepthNoise& noise,
             std::uint64_t frame, std::vector<std::byte>& bytes) {
  if (format == DepthImage::Format::kMillimetres16) {
    measure_as<Millimetres>(depth, noise, frame, bytes);
  } else {
    measure_as<Metres>(depth, noise, frame, bytes);
  }
}

}  // namespace clearance::rendering
