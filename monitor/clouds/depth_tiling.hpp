// The tiles of an image: the place of each tile of each level, and the rays at its edges.
//
// Pixels are sorted in tiles of four by two, and eight tiles make the next larger one. All memory
// is allocated by the constructor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace clearance {

// A pinhole without distortion (sensor_msgs/CameraInfo: K). The centre of column u and row v has
// the ray ((u - cx) / fx, (v - cy) / fy, 1). Lengths are in pixels.
struct PinholeCamera {
  std::uint32_t width = 0, height = 0;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;

  friend bool operator==(const PinholeCamera&, const PinholeCamera&) = default;
};

class DepthTiling {
 public:
  static constexpr std::size_t kFanOut = 8;  // pixels per tile, and tiles per larger tile

  // The first column and row of a tile.
  struct Place {
    std::uint16_t column = 0, row = 0;
  };
  // The rays at the edges of a tile: x from x0 z to x1 z, y likewise.
  struct Rays {
    double x0 = 0.0, x1 = 0.0, y0 = 0.0, y1 = 0.0;
  };
  // The edge rays of a tile's eight children, one child per vector lane.
  struct RayLanes {
    const double *x0, *x1, *y0, *y1;
  };

  // For images of up to this size, each 1 to 65535.
  DepthTiling(std::uint32_t most_columns, std::uint32_t most_rows);

  // True if an image of this size fits, and is not empty.
  [[nodiscard]] bool fits(std::uint32_t width, std::uint32_t height) const noexcept {
    return width > 0 && height > 0 && width <= most_columns_ && height <= most_rows_;
  }
  // Requires that the image fits. It allocates nothing.
  void set(const PinholeCamera& camera) noexcept;
  [[nodiscard]] const PinholeCamera& camera() const noexcept { return camera_; }

  // The numbers of tiles of level 0, and of groups of eight tiles in all levels, of the largest
  // image.
  [[nodiscard]] std::size_t most_tiles() const noexcept { return most_tiles_; }
  [[nodiscard]] std::size_t most_groups() const noexcept { return most_groups_; }
  // These describe the camera's image: the number of levels, the number of tiles of a level, and
  // the first group of a level. The last level has one tile.
  [[nodiscard]] std::size_t levels() const noexcept { return levels_; }
  [[nodiscard]] std::size_t tiles(std::size_t level) const noexcept { return count_[level]; }
  [[nodiscard]] std::size_t first_group(std::size_t level) const noexcept {
    return first_groups_[level];
  }
  // A tile outside of the image is placed at the image's edge.
  [[nodiscard]] const Place& place(std::size_t level, std::size_t tile) const noexcept {
    return places_[first_[level] + tile];
  }
  [[nodiscard]] Rays rays(std::size_t level, std::size_t tile) const noexcept;
  [[nodiscard]] Rays pixel_rays(std::size_t tile, std::size_t lane) const noexcept;
  [[nodiscard]] RayLanes ray_lanes(std::size_t level, std::size_t tile) const noexcept;
  // The rays at the edges of the whole image.
  [[nodiscard]] Rays outer_rays() const noexcept;

 private:
  static constexpr std::size_t kMostLevels = 12;

  // The edges of eight children, as vector lanes.
  struct EdgeLanes {
    std::array<double, kFanOut> low{}, high{};
  };

  void set_places() noexcept;
  void set_edge_lanes() noexcept;

  std::uint32_t most_columns_, most_rows_;
  std::size_t most_tiles_ = 0, most_groups_ = 0;
  PinholeCamera camera_;
  std::vector<double> column_edges_, row_edges_;  // (u - 1/2 - cx) / fx for u = 0 .. width
  std::vector<Place> places_;
  std::vector<EdgeLanes> column_lanes_, row_lanes_;
  // By level: the first place, the first group of tiles, the first lanes of a column and of a row.
  std::array<std::size_t, kMostLevels> first_{}, first_groups_{}, first_columns_{}, first_rows_{};
  std::array<std::size_t, kMostLevels> count_{};
  std::size_t levels_ = 0;
};

}  // namespace clearance
