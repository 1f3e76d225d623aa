#include "monitor/clouds/depth_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace clearance {
namespace {

constexpr float kEmptyLow = std::numeric_limits<float>::infinity();

// A tile of level 0 has four columns and two rows. Each further level alternates: two columns and
// four rows of tiles, then four columns and two rows. Bits of a number, from the least: a tile's
// place among eight.
struct Tiling {
  // The size of a tile, as powers of two.
  static std::uint32_t column_bits(std::size_t level) noexcept {
    return static_cast<std::uint32_t>(2 + level / 2 * 3 + level % 2);
  }
  static std::uint32_t row_bits(std::size_t level) noexcept {
    return static_cast<std::uint32_t>(1 + level / 2 * 3 + level % 2 * 2);
  }
};

// The place of tile `i` of level 0.
void place_of(std::size_t i, std::uint32_t& column, std::uint32_t& row) noexcept {
  column = row = 0;
  for (std::size_t level = 0; i != 0; ++level, i >>= 3) {
    const auto place = static_cast<std::uint32_t>(i & 7);
    const std::uint32_t wide = level % 2 == 0 ? 1 : 2;  // bits for columns among the three
    column += (place & ((1U << wide) - 1)) << Tiling::column_bits(level);
    row += (place >> wide) << Tiling::row_bits(level);
  }
}

std::size_t levels_for(std::uint32_t width, std::uint32_t height) noexcept {
  std::size_t level = 0;
  while ((1U << Tiling::column_bits(level)) < width || (1U << Tiling::row_bits(level)) < height) {
    ++level;
  }
  return level + 1;
}

// The number of tiles of level 0: whole children of the last level, up to the last that the image
// touches.
std::size_t tiles_for(std::uint32_t width, std::uint32_t height, std::size_t levels) noexcept {
  if (levels == 1) return 1;
  const std::size_t below = levels - 2;
  const std::uint32_t wide = below % 2 == 0 ? 1 : 2;
  const std::size_t column = (width - 1) >> Tiling::column_bits(below);
  const std::size_t row = (height - 1) >> Tiling::row_bits(below);
  return ((row << wide | column) + 1) << 3 * below;
}

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

}  // namespace

DepthCloud::DepthCloud(std::uint32_t most_columns, std::uint32_t most_rows)
    : most_columns_(std::clamp(most_columns, 1U, 65535U)),
      most_rows_(std::clamp(most_rows, 1U, 65535U)) {
  column_edges_.resize(most_columns_ + 1);
  row_edges_.resize(most_rows_ + 1);
  const std::size_t levels = levels_for(most_columns_, most_rows_);
  std::size_t nodes = tiles_for(most_columns_, most_rows_, levels);
  blocks_.resize(nodes);
  std::size_t all = 1;  // the last level
  for (; nodes > 1; nodes = (nodes + kFanOut - 1) / kFanOut) all += nodes;
  nodes_.resize(all);
}

DepthBuild DepthCloud::judge(const PinholeCamera& camera, const DepthImage& image,
                             const DepthError& error, const DepthRange& range) const noexcept {
  if (image.width != camera.width || image.height != camera.height || image.width == 0 ||
      image.height == 0 || image.width > most_columns_ || image.height > most_rows_) {
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

void DepthCloud::set_camera(const PinholeCamera& camera) noexcept {
  if (camera == camera_) return;
  camera_ = camera;
  for (std::uint32_t u = 0; u <= camera.width; ++u) {
    column_edges_[u] = (u - 0.5 - camera.cx) / camera.fx;
  }
  for (std::uint32_t v = 0; v <= camera.height; ++v) {
    row_edges_[v] = (v - 0.5 - camera.cy) / camera.fy;
  }
}

DepthBuild DepthCloud::build(const PinholeCamera& camera, const DepthImage& image,
                             const DepthError& error, const DepthRange& range) noexcept {
  const DepthBuild refused = judge(camera, image, error, range);
  if (refused != DepthBuild::kBuilt) return refused;
  set_camera(camera);
  if (image.format == DepthImage::Format::kMillimetres16) {
    fill_blocks<Millimetres>(image, error, range);
  } else {
    fill_blocks<Metres>(image, error, range);
  }
  add_levels();
  const Node& all = nodes_[first_[levels_ - 1]];
  extent_ = 0.0;
  if (is_empty(all)) {
    levels_ = 0;
  } else {
    const auto widest = [](double low, double high) { return std::max(std::abs(low), high); };
    const double x = widest(column_edges_[0], column_edges_[camera_.width]);
    const double y = widest(row_edges_[0], row_edges_[camera_.height]);
    extent_ = all.high * std::sqrt(1.0 + x * x + y * y) * (1.0 + 0x1p-40);
  }
  return DepthBuild::kBuilt;
}

template <class Pixel>
void DepthCloud::fill_blocks(const DepthImage& image, const DepthError& error,
                             const DepthRange& range) noexcept {
  levels_ = levels_for(image.width, image.height);
  std::size_t first = 0, count = tiles_for(image.width, image.height, levels_);
  for (std::size_t level = 0; level < levels_; ++level) {
    count_[level] = count;
    first_[level] = first;
    first += count;
    count = (count + kFanOut - 1) / kFanOut;
  }
  size_ = 0;
  for (std::size_t b = 0; b < count_[0]; ++b) {
    Node& node = nodes_[b];
    std::uint32_t column = 0, row = 0;
    place_of(b, column, row);
    node = {kEmptyLow, -kEmptyLow, static_cast<std::uint16_t>(column),
            static_cast<std::uint16_t>(row)};
    if (column >= image.width || row >= image.height) continue;
    Block& block = blocks_[b];
    block.low.fill(kEmptyLow);
    block.high.fill(-kEmptyLow);
    const std::uint32_t columns = std::min(4U, image.width - column);
    const std::uint32_t rows = std::min(2U, image.height - row);
    for (std::uint32_t v = 0; v < rows; ++v) {
      const std::byte* const line =
          image.bytes.data() + (row + v) * image.step + column * Pixel::kBytes;
      for (std::uint32_t u = 0; u < columns; ++u) {
        const double z = Pixel::read(line + u * Pixel::kBytes);
        if (!(z >= range.least && z <= range.greatest)) continue;
        // Two roundings of the sum and one of e(z): far below 2^-40 of z.
        const double e = error.at(z) + 0x1p-40 * z;
        const std::size_t lane = v * 4 + u;
        block.low[lane] = rounded_down(z - e);
        block.high[lane] = rounded_up(z + e);
        node.low = std::min(node.low, block.low[lane]);
        node.high = std::max(node.high, block.high[lane]);
        ++size_;
      }
    }
  }
  missing_ = std::size_t{image.width} * image.height - size_;
}

void DepthCloud::add_levels() noexcept {
  for (std::size_t level = 1; level < levels_; ++level) {
    for (std::size_t i = 0; i < count_[level]; ++i) {
      const Node* const children = &nodes_[first_[level - 1] + i * kFanOut];
      Node node = children[0];
      const std::size_t children_here = std::min(kFanOut, count_[level - 1] - i * kFanOut);
      for (std::size_t k = 1; k < children_here; ++k) {
        node.low = std::min(node.low, children[k].low);
        node.high = std::max(node.high, children[k].high);
      }
      nodes_[first_[level] + i] = node;
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
  for (std::size_t b = 0; b < count_[0]; ++b) {
    Node& node = nodes_[b];
    if (is_empty(node)) continue;
    node.low = *std::min_element(blocks_[b].low.begin(), blocks_[b].low.end());
    node.high = *std::max_element(blocks_[b].high.begin(), blocks_[b].high.end());
  }
  add_levels();
}

DepthCloud::Slab DepthCloud::slab(std::size_t level, std::size_t i) const noexcept {
  const Node& n = node(level, i);
  const std::uint32_t right =
      std::min(n.column + (1U << Tiling::column_bits(level)), camera_.width);
  const std::uint32_t below = std::min(n.row + (1U << Tiling::row_bits(level)), camera_.height);
  return {column_edges_[n.column],
          column_edges_[right],
          row_edges_[n.row],
          row_edges_[below],
          n.low,
          n.high};
}

DepthCloud::Slab DepthCloud::pixel_slab(std::size_t block, std::size_t lane) const noexcept {
  const Node& n = nodes_[block];
  const std::size_t u = n.column + lane % 4, v = n.row + lane / 4;
  return {column_edges_[u],  column_edges_[u + 1],     row_edges_[v],
          row_edges_[v + 1], blocks_[block].low[lane], blocks_[block].high[lane]};
}

std::uint32_t DepthCloud::source(std::size_t block, std::size_t lane) const noexcept {
  const Node& n = nodes_[block];
  return static_cast<std::uint32_t>((n.row + lane / 4) * camera_.width + n.column + lane % 4);
}

}  // namespace clearance
