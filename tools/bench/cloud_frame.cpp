#include "tools/bench/cloud_frame.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "tools/bench/random.hpp"

namespace clearance::bench {
namespace {

double depth_of(double x, double y) {
  double z = y > 0.0 ? std::min(2.5, 0.8 / y) : 2.5;
  if (std::hypot(x - 0.1, y + 0.05) < 0.1) z = 1.2;
  return x < -0.2 && y > -0.1 ? std::min(z, 1.6 + x) : z;
}

}  // namespace

DepthImage CloudFrame::image(DepthImage::Format format) const {
  const bool is_metres = format == DepthImage::Format::kMetres32;
  return {format, kCloudCamera.width, kCloudCamera.height,
          kCloudCamera.width * (is_metres ? 4U : 2U),
          is_metres ? std::as_bytes(std::span(metres)) : std::as_bytes(std::span(millimetres))};
}

CloudFrame make_cloud_frame(std::uint64_t seed) {
  constexpr PinholeCamera kCamera = kCloudCamera;
  CloudFrame out;
  Random random(seed);
  for (std::uint32_t v = 0; v < kCamera.height; ++v) {
    for (std::uint32_t u = 0; u < kCamera.width; ++u) {
      const double x = (u - kCamera.cx) / kCamera.fx, y = (v - kCamera.cy) / kCamera.fy;
      const double exact = depth_of(x, y);
      const double z = exact + 0.8 * kCloudError.at(exact) * random.uniform(-1.0, 1.0);
      out.metres.push_back(static_cast<float>(z));
      out.millimetres.push_back(static_cast<std::uint16_t>(std::lround(1000.0 * z)));
      out.points.push_back({static_cast<float>(x * z), static_cast<float>(y * z),
                            static_cast<float>(z), kBallRadius});
    }
  }
  return out;
}

const CloudFrame& cloud_frame() {
  static const CloudFrame made = make_cloud_frame(1);
  return made;
}

std::vector<MeasuredPoint> dense_points(const Vec3& middle) {
  Random random(3);
  std::vector<MeasuredPoint> points(300'000);
  const auto along = [&](int axis) {
    return static_cast<float>(middle[axis] + random.uniform(-0.25, 0.25));
  };
  for (MeasuredPoint& point : points) {
    point.x = along(0);
    point.y = along(1);
    point.z = along(2);
    point.radius = kBallRadius;
  }
  return points;
}

std::vector<Pose> cloud_places(std::size_t count) {
  Random random(2);
  std::vector<Pose> places(count);
  for (Pose& place : places) {
    place.position = Vec3(0, 0, 1) + random.uniform(0.1, 0.5) * random.direction();
    place.orientation = random.turn();
  }
  return places;
}

}  // namespace clearance::bench
