#include "monitor/clouds/depth_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "monitor/clouds/revision.hpp"

namespace clearance {
namespace {

constexpr float kEmptyLow = std::numeric_limits<float>::infinity();
constexpr double kTooNear = -std::numeric_limits<double>::infinity();
// The least depth of what is nearer than can be measured, in least depths of the range. Nearer
// places are in the camera.
constexpr double kNearest = 0x1p-10;

float rounded_down(double x) noexcept {
  const auto f = static_cast<float>(x);
  return double{f} > x ? std::nextafterf(f, 0.0F) : f;  // positive
}
float rounded_up(double x) noexcept {
  const auto f = static_cast<float>(x);
  return double{f} < x ? std::nextafterf(f, kEmptyLow) : f;
}

struct Millimetres {
  static constexpr std::size_t kBytes = 2;
  static double read(const std::byte* from) noexcept {
    std::uint16_t value = 0;
    std::memcpy(&value, from, sizeof value);
    return 0.001 * value;
  }
};
struct Metres {
  static constexpr std::size_t kBytes = 4;
  static double read(const std::byte* from) noexcept {
    float value = 0.0F;
    std::memcpy(&value, from, sizeof value);
    return value;
  }
};

std::size_t pixel_bytes(DepthImage::Format format) noexcept {
  return format == DepthImage::Format::kMillimetres16 ? Millimetres::kBytes : Metres::kBytes;
}

// The negated comparisons refuse NaN.
bool is_good(const PinholeCamera& c) noexcept {
  const auto narrow = [](double side, double other) {
    // The side ray is (side, other, 1), along a corner of the image.
    return std::abs(side) <= kWidestSine * std::sqrt(1.0 + side * side + other * other);
  };
  if (!(c.fx > 0.0 && c.fy > 0.0 && std::isfinite(c.fx + c.fy + c.cx + c.cy))) return false;
  const double left = (-0.5 - c.cx) / c.fx, right = (c.width - 0.5 - c.cx) / c.fx;
  const double top = (-0.5 - c.cy) / c.fy, bottom = (c.height - 0.5 - c.cy) / c.fy;
  return narrow(left, 0.0) && narrow(right, 0.0) && narrow(top, 0.0) && narrow(bottom, 0.0);
}

bool is_lost(const DepthCloud::Block& block, std::size_t lane) noexcept {
  return block.low[lane] > block.high[lane];
}

}  // namespace

DepthCloud::DepthCloud(std::uint32_t most_columns, std::uint32_t most_rows)
    : tiling_(most_columns, most_rows),
      blocks_(tiling_.most_tiles()),
      tiles_(tiling_.most_groups()) {}

DepthCloud::Lanes DepthCloud::lanes(std::size_t level, std::size_t i) const noexcept {
  const Block& depths = level == 0 ? blocks_[i] : tiles_[tiling_.first_group(level - 1) + i];
  return {tiling_.ray_lanes(level, i), depths.low.data(), depths.high.data()};
}

DepthCloud::Slab DepthCloud::slab(std::size_t level, std::size_t i) const noexcept {
  const Node n = node(level, i);
  return {tiling_.rays(level, i), n.low, n.high};
}

DepthCloud::Slab DepthCloud::pixel_slab(std::size_t block, std::size_t lane) const noexcept {
  return {tiling_.pixel_rays(block, lane), blocks_[block].low[lane], blocks_[block].high[lane]};
}

DepthBuild DepthCloud::judge(const PinholeCamera& camera, const DepthImage& image,
                             const DepthError& error, const DepthRange& range) const noexcept {
  if (image.width != camera.width || image.height != camera.height ||
      !tiling_.fits(image.width, image.height)) {
    return DepthBuild::kWrongSize;
  }
  if (!is_good(camera)) return DepthBuild::kBadCamera;
  const std::size_t row = image.width * pixel_bytes(image.format);
  if (image.step < row || image.bytes.size() < row ||
      (image.bytes.size() - row) / image.step < image.height - 1) {
    return DepthBuild::kShortImage;
  }
  // e(z) / z is convex, so it is largest at an end of the range.
  const bool good_error = error.constant >= 0.0 && error.quadratic >= 0.0 &&
                          error.at(range.least) < range.least &&
                          error.at(range.greatest) < range.greatest;
  if (!(range.least > 0.0 && range.least <= range.greatest && range.greatest <= kGreatestDepth &&
        good_error)) {
    return DepthBuild::kBadRange;
  }
  return DepthBuild::kBuilt;
}

// Gives each pixel of the image its depths, if `depths_of` says that it has any, and fits the tiles
// to them.
template <class DepthsOf>
void DepthCloud::fill(const DepthsOf& depths_of) noexcept {
  const std::uint32_t width = tiling_.camera().width, height = tiling_.camera().height;
  levels_ = tiling_.levels();
  size_ = 0;
  for (std::size_t b = 0; b < tiling_.tiles(0); ++b) {
    Block& tile = tiles_[b / kFanOut];
    float &least = tile.low[b % kFanOut], &greatest = tile.high[b % kFanOut];
    least = kEmptyLow;
    greatest = -kEmptyLow;
    const std::uint32_t column = tiling_.place(0, b).column, row = tiling_.place(0, b).row;
    if (column >= width || row >= height) continue;
    Block& block = blocks_[b];
    block.low.fill(kEmptyLow);
    block.high.fill(-kEmptyLow);
    const std::uint32_t columns = std::min(4U, width - column), rows = std::min(2U, height - row);
    for (std::uint32_t v = 0; v < rows; ++v) {
      for (std::uint32_t u = 0; u < columns; ++u) {
        const std::size_t lane = v * 4 + u;
        Depths depths;
        if (!depths_of(b, lane, column + u, row + v, depths)) continue;
        block.low[lane] = depths.low;
        block.high[lane] = depths.high;
        least = std::min(least, depths.low);
        greatest = std::max(greatest, depths.high);
        ++size_;
      }
    }
  }
  missing_ = std::size_t{width} * height - size_;
  finish();
}

template <class Pixel>
void DepthCloud::fill_from(const DepthImage& image, const DepthError& error,
                           const DepthRange& range) noexcept {
  // Two roundings of the sum and one of e(z): far below 2^-40 of z.
  const auto error_at = [&](double z) { return error.at(z) + 0x1p-40 * z; };
  const Depths too_near = {rounded_down(kNearest * range.least),
                           rounded_up(range.least + error_at(range.least))};
  fill([&](std::size_t, std::size_t, std::uint32_t u, std::uint32_t v, Depths& depths) {
    const double z = Pixel::read(image.bytes.data() + v * image.step + u * Pixel::kBytes);
    if (z == kTooNear) {
      depths = too_near;
      return true;
    }
    if (!(z >= range.least && z <= range.greatest)) return false;
    const double e = error_at(z);
    depths = {rounded_down(z - e), rounded_up(z + e)};
    return true;
  });
}

DepthBuild DepthCloud::build(const PinholeCamera& camera, const DepthImage& image,
                             const DepthError& error, const DepthRange& range) noexcept {
  const DepthBuild refused = judge(camera, image, error, range);
  if (refused != DepthBuild::kBuilt) return refused;
  tiling_.set(camera);
  if (image.format == DepthImage::Format::kMillimetres16) {
    fill_from<Millimetres>(image, error, range);
  } else {
    fill_from<Metres>(image, error, range);
  }
  return DepthBuild::kBuilt;
}

bool DepthCloud::build_unseen(const DepthCloud& seen, const DepthRange& range) noexcept {
  const PinholeCamera& camera = seen.tiling_.camera();
  const bool good_range =
      range.least > 0.0 && range.least <= range.greatest && range.greatest <= kGreatestDepth;
  if (!good_range || !tiling_.fits(camera.width, camera.height)) return false;
  tiling_.set(camera);
  near_ = rounded_down(range.least);
  far_ = rounded_up(range.greatest);
  fill([&](std::size_t b, std::size_t lane, std::uint32_t, std::uint32_t, Depths& depths) {
    const Block& before = seen.blocks_[b];
    const bool is_seen = before.low[lane] <= before.high[lane];
    // The unseen place begins where the slab of the pixel ends, so no place is between the two.
    depths = {is_seen ? std::max(near_, before.high[lane]) : near_, far_};
    return depths.low < far_;
  });
  return true;
}

void DepthCloud::leave_out_behind(const DepthCloud& seen, const DepthCloud* others) noexcept {
  for (std::size_t b = 0; b < tiling_.tiles(0); ++b) {
    const DepthTiling::Place& at = tiling_.place(0, b);
    if (at.column >= tiling_.camera().width || at.row >= tiling_.camera().height) continue;
    for (std::size_t lane = 0; lane < kFanOut; ++lane) {
      const bool was_seen = blocks_[b].low[lane] > near_;
      const bool is_of_others = others != nullptr && is_lost(others->blocks_[b], lane);
      if (was_seen && is_lost(seen.blocks_[b], lane) && !is_of_others) remove(b, lane);
    }
  }
  refit();
}

void DepthCloud::leave_open(std::size_t block, std::size_t lane) noexcept {
  if (levels_ == 0)
    return;  // no place was unseen, which a picture that is full to its end may have
  if (blocks_[block].low[lane] > blocks_[block].high[lane]) ++size_;
  blocks_[block].low[lane] = near_;
  blocks_[block].high[lane] = far_;
  tiles_[block / kFanOut].low[block % kFanOut] = near_;
  tiles_[block / kFanOut].high[block % kFanOut] = far_;
}

std::size_t DepthCloud::crop(const Vec3& centre, double radius) noexcept {
  const auto is_outside = [&](const Slab& slab) {
    return (slab.middle() - centre).norm() - slab.diameter() > radius * (1.0 + 0x1p-40);
  };
  const auto pixels = [&](const auto& visit) {
    for (std::size_t b = 0; levels_ > 0 && b < tiling_.tiles(0); ++b) {
      if (is_empty(node(0, b))) continue;
      const bool all_outside = is_outside(slab(0, b));
      for (std::size_t lane = 0; lane < kFanOut; ++lane) {
        if (blocks_[b].low[lane] > blocks_[b].high[lane]) continue;
        if (!visit(b, lane, all_outside || is_outside(pixel_slab(b, lane)))) return;
      }
    }
  };
  bool any_stays = false;
  pixels([&](std::size_t, std::size_t, bool outside) {
    any_stays = !outside;
    return outside;
  });
  const std::size_t before = size_;
  if (!any_stays) return 0;
  pixels([&](std::size_t b, std::size_t lane, bool outside) {
    if (outside) remove(b, lane);
    return true;
  });
  return before - size_;
}

void DepthCloud::finish() noexcept {
  add_levels();
  revision_ = next_revision();
  const Node all = node(levels_ - 1, 0);
  extent_ = 0.0;
  if (is_empty(all)) {
    levels_ = 0;
  } else {
    const auto widest = [](double low, double high) { return std::max(std::abs(low), high); };
    const DepthTiling::Rays outer = tiling_.outer_rays();
    const double x = widest(outer.x0, outer.x1), y = widest(outer.y0, outer.y1);
    extent_ = all.high * std::sqrt(1.0 + x * x + y * y) * (1.0 + 0x1p-40);
  }
}

void DepthCloud::add_levels() noexcept {
  for (std::size_t level = 0; level < levels_; ++level) {
    // Lanes without a tile are empty.
    Block* const tiles = &tiles_[tiling_.first_group(level)];
    const std::size_t groups = (tiling_.tiles(level) + kFanOut - 1) / kFanOut;
    for (std::size_t lane = tiling_.tiles(level); lane < groups * kFanOut; ++lane) {
      tiles[lane / kFanOut].low[lane % kFanOut] = kEmptyLow;
      tiles[lane / kFanOut].high[lane % kFanOut] = -kEmptyLow;
    }
    if (level + 1 == levels_) break;
    Block* const above = &tiles_[tiling_.first_group(level + 1)];
    for (std::size_t i = 0; i < groups; ++i) {
      const Block& of = tiles[i];
      above[i / kFanOut].low[i % kFanOut] = *std::min_element(of.low.begin(), of.low.end());
      above[i / kFanOut].high[i % kFanOut] = *std::max_element(of.high.begin(), of.high.end());
    }
  }
}

void DepthCloud::remove(std::size_t block, std::size_t lane) noexcept {
  if (blocks_[block].low[lane] > blocks_[block].high[lane]) return;
  blocks_[block].low[lane] = kEmptyLow;
  blocks_[block].high[lane] = -kEmptyLow;
  --size_;
}

void DepthCloud::refit() noexcept {
  if (levels_ == 0) return;
  for (std::size_t b = 0; b < tiling_.tiles(0); ++b) {
    Block& tile = tiles_[b / kFanOut];
    float &least = tile.low[b % kFanOut], &greatest = tile.high[b % kFanOut];
    if (least > greatest) continue;
    least = *std::min_element(blocks_[b].low.begin(), blocks_[b].low.end());
    greatest = *std::max_element(blocks_[b].high.begin(), blocks_[b].high.end());
  }
  add_levels();
}

std::uint32_t DepthCloud::source(std::size_t block, std::size_t lane) const noexcept {
  const DepthTiling::Place& at = tiling_.place(0, block);
  return static_cast<std::uint32_t>((at.row + lane / 4) * tiling_.camera().width + at.column +
                                    lane % 4);
}

}  // namespace clearance
