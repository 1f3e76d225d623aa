// The least depth in each tile of a picture: whether a place of the world was seen free in it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/pose.hpp"
#include "monitor/clouds/depth_cloud.hpp"

namespace clearance {

class TileDepths {
 public:
  enum class Sight : std::uint8_t {
    kUnseen,   // outside of the picture, or without depth there
    kHidden,   // something nearer is in front of it
    kSurface,  // something is there
    kFree,     // all that is seen of its tile is behind it
  };

  // For pictures of up to this size.
  TileDepths(std::uint32_t most_columns, std::uint32_t most_rows)
      : low_((most_columns / kWide + std::size_t{1}) * (most_rows / kHigh + std::size_t{1})) {}

  // Replaces them by those of another picture of this camera. Allocates nothing.
  void set(const DepthCloud& picture, const PinholeCamera& camera,
           const Pose& world_from_camera) noexcept {
    camera_ = camera;
    camera_from_world_ = relative_pose(world_from_camera, Pose{});
    across_ = camera.width / kWide + 1;
    low_.assign(across_ * (camera.height / kHigh + std::size_t{1}), kNothing);
    for (std::size_t i = 0; i < picture.nodes(0); ++i) {
      const DepthCloud::Node tile = picture.node(0, i);
      if (!DepthCloud::is_empty(tile))
        low_[tile.row / kHigh * across_ + tile.column / kWide] = tile.low;
    }
  }
  // What the picture shows of a place in the world; depths are equal to within `margin`, m.
  [[nodiscard]] Sight at(const Vec3& place, double margin) const noexcept {
    const Vec3 seen = camera_from_world_.rotation * place + camera_from_world_.translation;
    if (!(seen.z() > 0.0)) return Sight::kUnseen;
    const double column = std::round(camera_.fx * seen.x() / seen.z() + camera_.cx),
                 row = std::round(camera_.fy * seen.y() / seen.z() + camera_.cy);
    if (!(column >= 0.0 && column < camera_.width && row >= 0.0 && row < camera_.height))
      return Sight::kUnseen;
    const double low = low_[static_cast<std::uint32_t>(row) / kHigh * across_ +
                            static_cast<std::uint32_t>(column) / kWide];
    if (!(low < kNothing)) return Sight::kUnseen;
    if (low > seen.z() + margin) return Sight::kFree;
    return low < seen.z() - margin ? Sight::kHidden : Sight::kSurface;
  }

 private:
  static constexpr std::uint32_t kWide = 4, kHigh = 2;  // pixels of a tile (DepthTiling)
  static constexpr float kNothing = std::numeric_limits<float>::infinity();
  PinholeCamera camera_;
  RelativePose camera_from_world_;
  std::size_t across_ = 0;
  std::vector<float> low_;  // m, row by row
};

}  // namespace clearance
