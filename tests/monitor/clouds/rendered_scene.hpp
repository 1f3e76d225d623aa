// A scene of simple bodies, and the depth images that a camera has of it, with exact answers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

// A sphere or a box, at a pose in the world. Rays meet it by closed forms.
struct RenderedBody {
  Pose world_from_body;
  Vec3 half = Vec3::Zero();  // half extents of a box
  double radius = 0.0;       // of a sphere, whose half extents are 0
  int number = 0;            // what a pixel sees

  [[nodiscard]] ConvexBody shape() const {
    return radius > 0.0 ? made(point(Vec3::Zero(), radius)) : made(box(half));
  }
  // The ray parameter at which the ray enters the body; infinite: it does not.
  [[nodiscard]] double hit(const Vec3& origin, const Vec3& ray) const {
    const Vec3 o = world_from_body.orientation.conjugate() * (origin - world_from_body.position);
    const Vec3 d = world_from_body.orientation.conjugate() * ray;
    constexpr double kNone = std::numeric_limits<double>::infinity();
    if (radius > 0.0) {
      const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - radius * radius;
      const double root = b * b - a * c;
      if (root < 0.0) return kNone;
      const double t = (-b - std::sqrt(root)) / a;
      return t > 0.0 ? t : kNone;
    }
    double in = 0.0, out = kNone;
    for (int k = 0; k < 3; ++k) {
      if (d[k] == 0.0) {
        if (std::abs(o[k]) > half[k]) return kNone;
        continue;
      }
      const double a = (-half[k] - o[k]) / d[k], b = (half[k] - o[k]) / d[k];
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    return in > 0.0 && in <= out ? in : kNone;
  }
};

struct RenderedPixel {
  double depth = 0.0;  // exact, of the pixel's centre; 0: nothing is hit
  Vec3 in_world = Vec3::Zero();
  int number = -1;  // of the body
};

// The centre of each pixel, row by row.
[[nodiscard]] inline std::vector<RenderedPixel> render(const std::vector<RenderedBody>& bodies,
                                                       const PinholeCamera& c,
                                                       const Pose& world_from_camera) {
  std::vector<RenderedPixel> out;
  for (std::uint32_t v = 0; v < c.height; ++v) {
    for (std::uint32_t u = 0; u < c.width; ++u) {
      const Vec3 ray =
          world_from_camera.orientation * Vec3((u - c.cx) / c.fx, (v - c.cy) / c.fy, 1.0);
      RenderedPixel pixel;
      double nearest = std::numeric_limits<double>::infinity();
      for (const RenderedBody& body : bodies) {
        const double t = body.hit(world_from_camera.position, ray);
        if (t >= nearest) continue;
        nearest = t;
        pixel.number = body.number;
      }
      if (std::isfinite(nearest)) {
        pixel.depth = nearest;
        pixel.in_world = world_from_camera.position + nearest * ray;
      }
      out.push_back(pixel);
    }
  }
  return out;
}

// Depths with an error of at most `share` of the stated one; 1 % are missing (NaN).
[[nodiscard]] inline std::vector<float> measured(const std::vector<RenderedPixel>& pixels,
                                                 const DepthError& error, double share,
                                                 Random& random) {
  std::vector<float> out;
  for (const RenderedPixel& pixel : pixels) {
    const double z = pixel.depth + share * error.at(pixel.depth) * random.uniform(-1.0, 1.0);
    const bool is_missing = pixel.depth == 0.0 || random.chance(0.01);
    out.push_back(is_missing ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(z));
  }
  return out;
}

[[nodiscard]] inline RenderedBody rendered_box(const Vec3& centre, const Vec3& half, int number) {
  RenderedBody body;
  body.world_from_body.position = centre;
  body.half = half;
  body.number = number;
  return body;
}
[[nodiscard]] inline RenderedBody rendered_sphere(const Vec3& centre, double radius, int number) {
  RenderedBody body;
  body.world_from_body.position = centre;
  body.radius = radius;
  body.number = number;
  return body;
}

}  // namespace clearance::test
