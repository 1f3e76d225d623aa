// Depth images of convex bodies, without noise.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/convex_body.hpp"
#include "core/pose.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "tools/rendering/visible_body.hpp"

namespace clearance::rendering {

inline constexpr std::uint32_t kNoLabel = std::numeric_limits<std::uint32_t>::max();

// The shape must outlive its use.
struct PlacedBody {
  const ConvexBody* shape = nullptr;
  Pose world_from_body;
  std::uint32_t label = 0;  // the caller's
};

// One ray through the centre of each pixel, as PinholeCamera has it. Memory is kept between images.
class DepthRenderer {
 public:
  explicit DepthRenderer(const PinholeCamera& camera);

  // The camera has z forward, x right, y down. A body that contains the camera is not drawn.
  void render(const Pose& world_from_camera, std::span<const PlacedBody> bodies);

  [[nodiscard]] const PinholeCamera& camera() const noexcept { return camera_; }
  // By row, then column. The depth is z, m; infinity where no body is met.
  [[nodiscard]] std::span<const double> depth() const noexcept { return depth_; }
  // The label of the body that is seen, or kNoLabel.
  [[nodiscard]] std::span<const std::uint32_t> labels() const noexcept { return labels_; }
  // The point that a pixel sees, in the camera's frame; not finite where its depth is infinite.
  [[nodiscard]] Vec3 point(std::size_t pixel) const noexcept;

 private:
  struct Pixels {
    std::uint32_t left = 0, right = 0, top = 0, bottom = 0;  // up to but without right and bottom
  };

  [[nodiscard]] Pixels pixels_of(const ViewRange& range) const noexcept;
  void draw_polyhedron(const VisibleBody& body, const Pixels& pixels, std::uint32_t label);
  void draw_by_rays(const VisibleBody& body, const Pixels& pixels, std::uint32_t label);

  PinholeCamera camera_;
  std::vector<double> x_, y_;         // of columns and rows, at a depth of 1
  std::vector<double> nearness_;      // 1 / z; 0: nothing
  std::vector<double> most_, least_;  // of 1 / z, for a row
  std::vector<double> depth_;
  std::vector<std::uint32_t> labels_;
};

}  // namespace clearance::rendering
