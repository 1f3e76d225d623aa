#include "monitor/clouds/depth_tiling.hpp"

#include <algorithm>

namespace clearance {
namespace {

// A tile of level 0 has four columns and two rows. Each further level alternates: two columns and
// four rows of tiles, then four columns and two rows. Each three bits of a tile's number, the
// lowest first, are its place among eight.
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

// Returns the number of tiles of level 0 in the children of the last level's tile, up to the last
// child that the image touches.
std::size_t tiles_for(std::uint32_t width, std::uint32_t height, std::size_t levels) noexcept {
  if (levels == 1) return 1;
  const std::size_t below = levels - 2;
  const std::size_t column = (width - 1) >> Tiling::column_bits(below);
  const std::size_t row = (height - 1) >> Tiling::row_bits(below);
  return ((row << Tiling::wide(levels - 1) | column) + 1) << 3 * below;
}

}  // namespace

DepthTiling::DepthTiling(std::uint32_t most_columns, std::uint32_t most_rows)
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
  most_tiles_ = tiles_for(most_columns_, most_rows_, levels);
  std::size_t tiles = most_tiles_, all = 0;
  for (std::size_t level = 0; level < levels; ++level) {
    all += tiles;
    tiles = (tiles + kFanOut - 1) / kFanOut;
    most_groups_ += tiles;
  }
  places_.resize(all);
}

void DepthTiling::set(const PinholeCamera& camera) noexcept {
  if (camera == camera_) return;
  camera_ = camera;
  for (std::uint32_t u = 0; u <= camera.width; ++u) {
    column_edges_[u] = (u - 0.5 - camera.cx) / camera.fx;
  }
  for (std::uint32_t v = 0; v <= camera.height; ++v) {
    row_edges_[v] = (v - 0.5 - camera.cy) / camera.fy;
  }
  set_places();
  set_edge_lanes();
}

// The places of all tiles of an image of this size.
void DepthTiling::set_places() noexcept {
  levels_ = levels_for(camera_.width, camera_.height);
  std::size_t first = 0, group = 0;
  std::size_t count = tiles_for(camera_.width, camera_.height, levels_);
  for (std::size_t level = 0; level < levels_; ++level) {
    count_[level] = count;
    first_[level] = first;
    first_groups_[level] = group;
    first += count;
    count = (count + kFanOut - 1) / kFanOut;
    group += count;
  }
  places_[first_[levels_ - 1]] = {0, 0};
  for (std::size_t level = levels_ - 1; level > 0; --level) {
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

void DepthTiling::set_edge_lanes() noexcept {
  std::size_t columns = 0, rows = 0;
  for (std::size_t level = 0; level < levels_; ++level) {
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

DepthTiling::RayLanes DepthTiling::ray_lanes(std::size_t level, std::size_t tile) const noexcept {
  const Place& at = place(level, tile);
  const EdgeLanes& x =
      column_lanes_[first_columns_[level] + (at.column >> Tiling::column_bits(level))];
  const EdgeLanes& y = row_lanes_[first_rows_[level] + (at.row >> Tiling::row_bits(level))];
  return {x.low.data(), x.high.data(), y.low.data(), y.high.data()};
}

DepthTiling::Rays DepthTiling::rays(std::size_t level, std::size_t tile) const noexcept {
  const Place& at = place(level, tile);
  const std::uint32_t right =
      std::min(at.column + (1U << Tiling::column_bits(level)), camera_.width);
  const std::uint32_t below = std::min(at.row + (1U << Tiling::row_bits(level)), camera_.height);
  return {column_edges_[at.column], column_edges_[right], row_edges_[at.row], row_edges_[below]};
}

DepthTiling::Rays DepthTiling::pixel_rays(std::size_t tile, std::size_t lane) const noexcept {
  const Place& at = places_[tile];
  const std::size_t u = at.column + lane % 4, v = at.row + lane / 4;
  return {column_edges_[u], column_edges_[u + 1], row_edges_[v], row_edges_[v + 1]};
}

DepthTiling::Rays DepthTiling::outer_rays() const noexcept {
  return {column_edges_[0], column_edges_[camera_.width], row_edges_[0],
          row_edges_[camera_.height]};
}

}  // namespace clearance
