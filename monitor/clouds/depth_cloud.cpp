#include "monitor/clouds/depth_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "monitor/clouds/revision.hpp"

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
  // The same of a child. Pixels are the children of level 0.
  static std::uint32_t child_column_bits(std::size_t level) noexcept {
    return level == 0 ? 0 : column_bits(level - 1);
  }
  static std::uint32_t child_row_bits(std::size_t level) noexcept {
    return level == 0 ? 0 : row_bits(level - 1);
  }
  // The number of bits, of the three of a child's place, that choose its column.
  static std::uint32_t wide(std::size_t level) noexcept {
    return column_bits(level) - child_column_bits(level);
  }
  static std::size_t columns(std::size_t level, std::uint32_t width) noexcept {
    return ((width - 1) >> column_bits(level)) + 1;
  }
  static std::size_t rows(std::size_t level, std::uint32_t height) noexcept {
    return ((height - 1) >> row_bits(level)) + 1;
  }
};

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
  const std::size_t column = (width - 1) >> Tiling::column_bits(below);
  const std::size_t row = (height - 1) >> Tiling::row_bits(below);
  return ((row << Tiling::wide(levels - 1) | column) + 1) << 3 * below;
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
  std::size_t columns = 0, rows = 0;
  for (std::size_t level = 0; level < levels; ++level) {
    columns += Tiling::columns(level, most_columns_);
    rows += Tiling::rows(level, most_rows_);
  }
  column_lanes_.resize(columns);
  row_lanes_.resize(rows);
  std::size_t nodes = tiles_for(most_columns_, most_rows_, levels), all = 0, groups = 0;
  blocks_.resize(nodes);
  for (std::size_t level = 0; level < levels; ++level) {
    all += nodes;
    nodes = (nodes + kFanOut - 1) / kFanOut;
    groups += nodes;
  }
  places_.resize(all);
  tiles_.resize(groups);
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
  set_tiling();
  set_edge_lanes();
}

// The places of all tiles of an image of this size.
void DepthCloud::set_tiling() noexcept {
  tree_levels_ = levels_for(camera_.width, camera_.height);
  std::size_t first = 0, group = 0;
  std::size_t count = tiles_for(camera_.width, camera_.height, tree_levels_);
  for (std::size_t level = 0; level < tree_levels_; ++level) {
    count_[level] = count;
    first_[level] = first;
    first_tiles_[level] = group;
    first += count;
    count = (count + kFanOut - 1) / kFanOut;
    group += count;
  }
  places_[first_[tree_levels_ - 1]] = {0, 0};
  for (std::size_t level = tree_levels_ - 1; level > 0; --level) {
    const std::uint32_t wide = Tiling::wide(level);
    for (std::size_t i = 0; i < count_[level - 1]; ++i) {
      const Place& parent = places_[first_[level] + i / kFanOut];
      const auto lane = static_cast<std::uint32_t>(i % kFanOut);
      const std::uint32_t column = (lane & ((1U << wide) - 1)) << Tiling::child_column_bits(level);
      const std::uint32_t row = (lane >> wide) << Tiling::child_row_bits(level);
      // A tile outside of the image stays at its edge, and is empty.
      places_[first_[level - 1] + i] = {
          static_cast<std::uint16_t>(std::min(parent.column + column, camera_.width)),
          static_cast<std::uint16_t>(std::min(parent.row + row, camera_.height))};
    }
  }
}

void DepthCloud::set_edge_lanes() noexcept {
  std::size_t columns = 0, rows = 0;
  for (std::size_t level = 0; level < tree_levels_; ++level) {
    first_columns_[level] = columns;
    first_rows_[level] = rows;
    const std::uint32_t wide = Tiling::wide(level);
    // Lane `lane` of the parent at `place`: its child's edges, within the image.
    const auto set = [](EdgeLanes& edges, std::size_t lane, const std::vector<double>& of,
                        std::size_t place, std::uint32_t bits, std::uint32_t end) {
      edges.low[lane] = of[std::min<std::size_t>(place << bits, end)];
      edges.high[lane] = of[std::min<std::size_t>((place + 1) << bits, end)];
    };
    for (std::size_t i = 0; i < Tiling::columns(level, camera_.width); ++i, ++columns) {
      for (std::size_t lane = 0; lane < kFanOut; ++lane) {
        set(column_lanes_[columns], lane, column_edges_, (i << wide) + (lane & ((1U << wide) - 1)),
            Tiling::child_column_bits(level), camera_.width);
      }
    }
    for (std::size_t i = 0; i < Tiling::rows(level, camera_.height); ++i, ++rows) {
      for (std::size_t lane = 0; lane < kFanOut; ++lane) {
        set(row_lanes_[rows], lane, row_edges_, (i << (3 - wide)) + (lane >> wide),
            Tiling::child_row_bits(level), camera_.height);
      }
    }
  }
}

DepthCloud::Lanes DepthCloud::lanes(std::size_t level, std::size_t i) const noexcept {
  const Place& place = places_[first_[level] + i];
  const EdgeLanes& x =
      column_lanes_[first_columns_[level] + (place.column >> Tiling::column_bits(level))];
  const EdgeLanes& y = row_lanes_[first_rows_[level] + (place.row >> Tiling::row_bits(level))];
  const Block& depths = level == 0 ? blocks_[i] : tiles_[first_tiles_[level - 1] + i];
  return {x.low.data(),  x.high.data(),     y.low.data(),
          y.high.data(), depths.low.data(), depths.high.data()};
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
  finish();
  return DepthBuild::kBuilt;
}

bool DepthCloud::build_unseen(const DepthCloud& seen, const DepthRange& range) noexcept {
  const PinholeCamera& camera = seen.camera_;
  const bool good_range =
      range.least > 0.0 && range.least <= range.greatest && range.greatest <= kGreatestDepth;
  if (camera.width == 0 || camera.width > most_columns_ || camera.height > most_rows_ ||
      !good_range) {
    return false;
  }
  set_camera(camera);
  near_ = rounded_down(range.least);
  far_ = rounded_up(range.greatest);
  levels_ = tree_levels_;
  size_ = 0;
  for (std::size_t b = 0; b < count_[0]; ++b) {
    Block& tile = tiles_[b / kFanOut];
    float &least = tile.low[b % kFanOut], &greatest = tile.high[b % kFanOut];
    least = kEmptyLow;
    greatest = -kEmptyLow;
    const std::uint32_t column = places_[b].column, row = places_[b].row;
    if (column >= camera.width || row >= camera.height) continue;
    const Block& before = seen.blocks_[b];
    Block& block = blocks_[b];
    for (std::size_t lane = 0; lane < kFanOut; ++lane) {
      const bool is_inside = column + lane % 4 < camera.width && row + lane / 4 < camera.height;
      const bool is_seen = before.low[lane] <= before.high[lane];
      // The unseen place begins where the slab of the pixel ends, so no place is between the two.
      const float low = is_seen ? std::max(near_, before.high[lane]) : near_;
      const bool is_there = is_inside && low < far_;
      block.low[lane] = is_there ? low : kEmptyLow;
      block.high[lane] = is_there ? far_ : -kEmptyLow;
      if (!is_there) continue;
      least = std::min(least, low);
      greatest = far_;
      ++size_;
    }
  }
  missing_ = std::size_t{camera.width} * camera.height - size_;
  finish();
  return true;
}

void DepthCloud::leave_out_behind(const DepthCloud& seen) noexcept {
  for (std::size_t b = 0; b < count_[0]; ++b) {
    if (places_[b].column >= camera_.width || places_[b].row >= camera_.height) continue;
    for (std::size_t lane = 0; lane < kFanOut; ++lane) {
      const bool was_seen = blocks_[b].low[lane] > near_;
      if (was_seen && seen.blocks_[b].low[lane] > seen.blocks_[b].high[lane]) remove(b, lane);
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
    for (std::size_t b = 0; levels_ > 0 && b < count_[0]; ++b) {
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
    const double x = widest(column_edges_[0], column_edges_[camera_.width]);
    const double y = widest(row_edges_[0], row_edges_[camera_.height]);
    extent_ = all.high * std::sqrt(1.0 + x * x + y * y) * (1.0 + 0x1p-40);
  }
}

template <class Pixel>
void DepthCloud::fill_blocks(const DepthImage& image, const DepthError& error,
                             const DepthRange& range) noexcept {
  levels_ = tree_levels_;
  size_ = 0;
  for (std::size_t b = 0; b < count_[0]; ++b) {
    Block& tile = tiles_[b / kFanOut];
    float &least = tile.low[b % kFanOut], &greatest = tile.high[b % kFanOut];
    least = kEmptyLow;
    greatest = -kEmptyLow;
    const std::uint32_t column = places_[b].column, row = places_[b].row;
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
        least = std::min(least, block.low[lane]);
        greatest = std::max(greatest, block.high[lane]);
        ++size_;
      }
    }
  }
  missing_ = std::size_t{image.width} * image.height - size_;
}

void DepthCloud::add_levels() noexcept {
  for (std::size_t level = 0; level < levels_; ++level) {
    // Lanes without a tile are empty.
    Block* const tiles = &tiles_[first_tiles_[level]];
    const std::size_t groups = (count_[level] + kFanOut - 1) / kFanOut;
    for (std::size_t lane = count_[level]; lane < groups * kFanOut; ++lane) {
      tiles[lane / kFanOut].low[lane % kFanOut] = kEmptyLow;
      tiles[lane / kFanOut].high[lane % kFanOut] = -kEmptyLow;
    }
    if (level + 1 == levels_) break;
    Block* const above = &tiles_[first_tiles_[level + 1]];
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
  for (std::size_t b = 0; b < count_[0]; ++b) {
    Block& tile = tiles_[b / kFanOut];
    float &least = tile.low[b % kFanOut], &greatest = tile.high[b % kFanOut];
    if (least > greatest) continue;
    least = *std::min_element(blocks_[b].low.begin(), blocks_[b].low.end());
    greatest = *std::max_element(blocks_[b].high.begin(), blocks_[b].high.end());
  }
  add_levels();
}

DepthCloud::Slab DepthCloud::slab(std::size_t level, std::size_t i) const noexcept {
  const Node n = node(level, i);
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
  const Place& n = places_[block];
  const std::size_t u = n.column + lane % 4, v = n.row + lane / 4;
  return {column_edges_[u],  column_edges_[u + 1],     row_edges_[v],
          row_edges_[v + 1], blocks_[block].low[lane], blocks_[block].high[lane]};
}

std::uint32_t DepthCloud::source(std::size_t block, std::size_t lane) const noexcept {
  const Place& n = places_[block];
  return static_cast<std::uint32_t>((n.row + lane / 4) * camera_.width + n.column + lane % 4);
}

}  // namespace clearance
