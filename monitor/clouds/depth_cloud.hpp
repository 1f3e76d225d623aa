// A depth image as the union of its pixels' slabs, in a pyramid for the nearest-element query.
//
// The slab of a pixel is the part of its square cone between the depths z - e(z) and z + e(z): a
// convex body of eight vertices. Coordinates are in the optical frame, where z leads forward, x to
// the right and y down. Depth is z, not the length of the ray. A tile (depth_tiling.hpp) spans the
// least and the greatest depth of its pixels, so it is a slab as well. All memory is allocated by
// the constructor.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.hpp"
#include "monitor/clouds/depth_tiling.hpp"

namespace clearance {

// The stated bound of a depth's error: |measured - true| <= constant + quadratic z^2, m. It must
// hold for the measured z, and includes quantisation.
struct DepthError {
  double constant = 0.0, quadratic = 0.0;

  [[nodiscard]] double at(double z) const noexcept { return constant + quadratic * z * z; }
};

// The pixels of an image, row by row, in the byte order of this machine.
struct DepthImage {
  enum class Format : std::uint8_t {
    kMillimetres16,  // uint16, 0: missing
    // float32, NaN, infinity, 0 or negative: missing. -infinity: nearer than the least depth (REP
    // 117), so that the slab of its pixel ends there.
    kMetres32,
  };
  Format format = Format::kMetres32;
  std::uint32_t width = 0, height = 0;
  std::size_t step = 0;  // bytes from one row to the next
  std::span<const std::byte> bytes;
};

struct DepthRange {
  double least = 0.0, greatest = 0.0;  // m; depths outside of it count as missing
};

enum class DepthBuild : std::uint8_t {
  kBuilt,
  kBadCamera,  // a focal length is not positive or finite, or a side ray is over 51 degrees off the
               // axis
  kWrongSize,  // the image and the camera differ, or have more pixels than the capacity
  kShortImage,  // fewer bytes than rows
  kBadRange,    // not 0 < least <= greatest <= kGreatestDepth, or e(z) is negative or reaches z
};

inline constexpr double kGreatestDepth = 1e4;  // m
// The largest sine between a side ray and the optical axis. Up to it, no corner of a slab is so
// sharp that queries lose digits.
inline constexpr double kWidestSine = 7.0 / 9.0;

class DepthCloud {
 public:
  static constexpr std::size_t kFanOut = DepthTiling::kFanOut;

  // A tile of columns [column, column + width), rows likewise; the sizes follow from its level. It
  // is empty if low > high.
  struct Node {
    float low = 0.0F, high = 0.0F;  // m, rounded outward
    std::uint16_t column = 0, row = 0;
  };
  // The depths of the eight pixels of a tile, row by row, or of the eight tiles in a larger one. An
  // empty lane has low > high.
  struct Block {
    std::array<float, kFanOut> low{}, high{};  // m, rounded outward
  };
  // The eight children of a tile as vector lanes: between these rays and depths.
  struct Lanes : DepthTiling::RayLanes {
    const float *low, *high;
  };
  // A slab between rays: x from x0 z to x1 z, y likewise, z from low to high.
  struct Slab : DepthTiling::Rays {
    double low = 0.0, high = 0.0;

    // min n.p over the slab: it is attained at a vertex.
    [[nodiscard]] double least_along(const Vec3& n) const noexcept {
      const double at_unit_depth =
          std::min(n.x() * x0, n.x() * x1) + std::min(n.y() * y0, n.y() * y1) + n.z();
      return std::min(low * at_unit_depth, high * at_unit_depth);
    }
    // The vertex with the least n.p, as a corner: bit k is set on the upper side of axis k.
    [[nodiscard]] unsigned corner_along(const Vec3& n) const noexcept {
      const unsigned x = n.x() * x1 < n.x() * x0 ? 1U : 0U, y = n.y() * y1 < n.y() * y0 ? 2U : 0U;
      const double at_unit_depth =
          std::min(n.x() * x0, n.x() * x1) + std::min(n.y() * y0, n.y() * y1) + n.z();
      return x | y | (at_unit_depth < 0.0 ? 4U : 0U);
    }
    [[nodiscard]] Vec3 vertex(unsigned corner) const noexcept {
      const double z = (corner & 4U) != 0 ? high : low;
      return {((corner & 1U) != 0 ? x1 : x0) * z, ((corner & 2U) != 0 ? y1 : y0) * z, z};
    }
    // No two of its points are farther apart: a convex function of two points is largest at two
    // vertices.
    [[nodiscard]] double diameter() const noexcept {
      const double x = std::max(std::abs(x0), std::abs(x1)) * (high - low) + (x1 - x0) * high;
      const double y = std::max(std::abs(y0), std::abs(y1)) * (high - low) + (y1 - y0) * high;
      return std::hypot(x, y, high - low) * (1.0 + 0x1p-40);
    }
    [[nodiscard]] Vec3 middle() const noexcept {
      const double z = 0.5 * (low + high);
      return {0.5 * (x0 + x1) * z, 0.5 * (y0 + y1) * z, z};
    }
  };

  // Allocates the memory for images of up to this size, each 1 to 65535.
  DepthCloud(std::uint32_t most_columns, std::uint32_t most_rows);

  // Replaces the cloud by the pixels of the image. Any other result than kBuilt leaves the previous
  // cloud as it is. Deterministic to the bit; allocates nothing.
  [[nodiscard]] DepthBuild build(const PinholeCamera& camera, const DepthImage& image,
                                 const DepthError& error, const DepthRange& range) noexcept;

  // Replaces the cloud by the places of another one's picture that it has not seen: behind each of
  // its pixels, and the whole cone of a pixel that it does not have, both within the range. Returns
  // false, and changes nothing, if the picture is larger than the capacity, or the range is bad.
  [[nodiscard]] bool build_unseen(const DepthCloud& seen, const DepthRange& range) noexcept;
  // After that: leaves out the places behind the pixels that `seen` has lost since. Those that
  // `others` has lost as well were taken out for other bodies, and stay unseen. `others` is a copy
  // of the picture without the images of those; null: nothing was taken out for others.
  void leave_out_behind(const DepthCloud& seen, const DepthCloud* others) noexcept;
  // After that: the whole cone of this pixel is unseen. Call refit() afterwards.
  void leave_open(std::size_t block, std::size_t lane) noexcept;

  // Leaves out a pixel from now on. The tiles above stay as they are, so bounds stay true, but
  // queries look into them in vain until refit().
  void remove(std::size_t block, std::size_t lane) noexcept;
  // Fits all tiles to the pixels that are left.
  void refit() noexcept;
  // Leaves out the pixels whose slabs lie outside of the ball, unless that were all. Returns how
  // many. Call refit() afterwards.
  std::size_t crop(const Vec3& centre, double radius) noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return size_; }  // pixels with a slab
  // Pixels without one: missing, or out of range.
  [[nodiscard]] std::size_t missing() const noexcept { return missing_; }
  // No vertex is farther from the origin of the frame, m.
  [[nodiscard]] double extent() const noexcept { return extent_; }
  // Another number after each build, of any cloud. Copies of a cloud share it.
  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

  [[nodiscard]] std::size_t blocks() const noexcept { return levels_ == 0 ? 0 : tiling_.tiles(0); }
  [[nodiscard]] const Block& block(std::size_t i) const noexcept { return blocks_[i]; }
  [[nodiscard]] std::size_t levels() const noexcept { return levels_; }
  [[nodiscard]] std::size_t nodes(std::size_t level) const noexcept { return tiling_.tiles(level); }
  [[nodiscard]] Node node(std::size_t level, std::size_t i) const noexcept {
    const Block& group = tiles_[tiling_.first_group(level) + i / kFanOut];
    const DepthTiling::Place& place = tiling_.place(level, i);
    return {group.low[i % kFanOut], group.high[i % kFanOut], place.column, place.row};
  }
  [[nodiscard]] static bool is_empty(const Node& node) noexcept { return node.low > node.high; }
  // The children of a tile: pixels if `level` is 0.
  [[nodiscard]] Lanes lanes(std::size_t level, std::size_t i) const noexcept;
  // The slabs of a tile and of a pixel. Neither may be empty.
  [[nodiscard]] Slab slab(std::size_t level, std::size_t i) const noexcept;
  [[nodiscard]] Slab pixel_slab(std::size_t block, std::size_t lane) const noexcept;
  // row * width + column of a pixel.
  [[nodiscard]] std::uint32_t source(std::size_t block, std::size_t lane) const noexcept;

 private:
  struct Depths {
    float low = 0.0F, high = 0.0F;  // m, rounded outward
  };

  [[nodiscard]] DepthBuild judge(const PinholeCamera& camera, const DepthImage& image,
                                 const DepthError& error, const DepthRange& range) const noexcept;
  template <class DepthsOf>
  void fill(const DepthsOf& depths_of) noexcept;
  template <class Pixel>
  void fill_from(const DepthImage& image, const DepthError& error,
                 const DepthRange& range) noexcept;
  void add_levels() noexcept;
  void finish() noexcept;

  DepthTiling tiling_;
  std::vector<Block> blocks_, tiles_;  // the pixels, and the tiles level by level
  std::size_t levels_ = 0;             // 0 if no pixel has a slab
  std::size_t size_ = 0, missing_ = 0;
  std::uint64_t revision_ = 0;
  double extent_ = 0.0;
  // Depths of unseen places, m: where they begin if their pixel was not seen, and where they end.
  float near_ = 0.0F, far_ = 0.0F;
};

}  // namespace clearance
