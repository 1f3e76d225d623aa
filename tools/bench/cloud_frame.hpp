// The frame and the boxes of the rows of clouds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/pose.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "monitor/clouds/point_cloud.hpp"

namespace clearance::bench {

inline constexpr PinholeCamera kCloudCamera{640, 480, 571.7, 568.9, 320.9, 238.7};
inline constexpr DepthError kCloudError{0.001, 0.0025};
inline constexpr DepthRange kCloudRange{0.25, 4.0};
inline constexpr float kBallRadius = 0.004F;    // m
inline const Vec3 kCloudBox(0.05, 0.06, 0.12);  // half extents, m

// A floor 0.8 m below the camera, a wall 2.5 m away, a disc and a slanted step in front of it, with
// noise of 80 % of the stated error.
struct CloudFrame {
  std::vector<float> metres;
  std::vector<std::uint16_t> millimetres;
  std::vector<MeasuredPoint> points;

  [[nodiscard]] DepthImage image(DepthImage::Format format) const;
};
[[nodiscard]] CloudFrame make_cloud_frame(std::uint64_t seed);
// The frame of all rows: made once.
[[nodiscard]] const CloudFrame& cloud_frame();

// Balls that fill a cube of half a metre around a place: 300,000 of them.
[[nodiscard]] std::vector<MeasuredPoint> dense_points(const Vec3& middle);

// Places of a box among the scene.
[[nodiscard]] std::vector<Pose> cloud_places(std::size_t count);

}  // namespace clearance::bench
