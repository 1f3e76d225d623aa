#include "tools/rendering/depth_renderer.hpp"

#include <algorithm>
#include <cmath>

namespace clearance::rendering {
namespace {

Pose inverse(const Pose& pose) {
  const Eigen::Quaterniond turned = pose.orientation.conjugate().normalized();
  return {turned * -pose.position, turned};
}

}  // namespace

DepthRenderer::DepthRenderer(const PinholeCamera& camera) : camera_(camera) {
  for (std::uint32_t u = 0; u < camera.width; ++u)
    x_.push_back((static_cast<double>(u) - camera.cx) / camera.fx);
  for (std::uint32_t v = 0; v < camera.height; ++v)
    y_.push_back((static_cast<double>(v) - camera.cy) / camera.fy);
  const std::size_t pixels = std::size_t{camera.width} * camera.height;
  nearness_.resize(pixels);
  depth_.resize(pixels);
  labels_.resize(pixels);
  most_.resize(camera.width);
  least_.resize(camera.width);
}

Vec3 DepthRenderer::point(std::size_t pixel) const noexcept {
  const double z = depth_[pixel];
  return {x_[pixel % camera_.width] * z, y_[pixel / camera_.width] * z, z};
}

// A pixel more on each side covers the rounding of the range.
DepthRenderer::Pixels DepthRenderer::pixels_of(const ViewRange& range) const noexcept {
  if (range.is_empty()) return {};
  const auto first = [](double tangent, double f, double c, std::uint32_t size) {
    const double at = std::floor(tangent * f + c) - 1.0;
    return static_cast<std::uint32_t>(std::clamp(at, 0.0, static_cast<double>(size)));
  };
  const auto last = [](double tangent, double f, double c, std::uint32_t size) {
    const double at = std::ceil(tangent * f + c) + 2.0;
    return static_cast<std::uint32_t>(std::clamp(at, 0.0, static_cast<double>(size)));
  };
  return {first(range.left, camera_.fx, camera_.cx, camera_.width),
          last(range.right, camera_.fx, camera_.cx, camera_.width),
          first(range.top, camera_.fy, camera_.cy, camera_.height),
          last(range.bottom, camera_.fy, camera_.cy, camera_.height)};
}

void DepthRenderer::render(const Pose& world_from_camera, std::span<const PlacedBody> bodies) {
  std::ranges::fill(nearness_, 0.0);
  std::ranges::fill(labels_, kNoLabel);
  const Pose camera_from_world = inverse(world_from_camera);
  for (const PlacedBody& each : bodies) {
    const VisibleBody body(*each.shape, compose(camera_from_world, each.world_from_body));
    const Pixels pixels = pixels_of(body.range());
    if (pixels.left >= pixels.right || pixels.top >= pixels.bottom) continue;
    if (body.first_hit(Vec3::UnitZ()) == 0.0) continue;
    if (body.is_polyhedron()) {
      draw_polyhedron(body, pixels, each.label);
    } else {
      draw_by_rays(body, pixels, each.label);
    }
  }
  std::ranges::transform(nearness_, depth_.begin(),
                         [](double each) { return each > 0.0 ? 1.0 / each : kInfinity; });
}

// Along a row, 1/z of a plane is a linear function of the column: no divisions, and vector code.
void DepthRenderer::draw_polyhedron(const VisibleBody& body, const Pixels& pixels,
                                    std::uint32_t label) {
  const std::size_t count = pixels.right - pixels.left;
  const double* const x = &x_[pixels.left];
  double *const most = most_.data(), *const least = least_.data();
  for (std::uint32_t v = pixels.top; v < pixels.bottom; ++v) {
    std::fill_n(most, count, kInfinity);
    std::fill_n(least, count, 0.0);
    for (const Vec3& plane : body.front_planes()) {
      const double slope = plane.x(), begin = plane.y() * y_[v] + plane.z();
      for (std::size_t i = 0; i < count; ++i) most[i] = std::min(most[i], begin + slope * x[i]);
    }
    for (const Vec3& plane : body.back_planes()) {
      const double slope = plane.x(), begin = plane.y() * y_[v] + plane.z();
      for (std::size_t i = 0; i < count; ++i) least[i] = std::max(least[i], begin + slope * x[i]);
    }
    const std::size_t first = std::size_t{v} * camera_.width + pixels.left;
    for (std::size_t i = 0; i < count; ++i) {
      if (most[i] < least[i] || most[i] <= nearness_[first + i]) continue;
      nearness_[first + i] = most[i];
      labels_[first + i] = label;
    }
  }
}

void DepthRenderer::draw_by_rays(const VisibleBody& body, const Pixels& pixels,
                                 std::uint32_t label) {
  for (std::uint32_t v = pixels.top; v < pixels.bottom; ++v) {
    for (std::uint32_t u = pixels.left; u < pixels.right; ++u) {
      const double z = body.first_hit({x_[u], y_[v], 1.0});
      const std::size_t pixel = std::size_t{v} * camera_.width + u;
      if (z * nearness_[pixel] >= 1.0 || z == kInfinity) continue;
      nearness_[pixel] = 1.0 / z;
      labels_[pixel] = label;
    }
  }
}

}  // namespace clearance::rendering
