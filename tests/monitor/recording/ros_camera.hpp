// The messages of a depth camera, for bags.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "monitor/clouds/depth_cloud.hpp"
#include "tests/monitor/recording/ros_bags.hpp"

namespace clearance::test {

// Depths in m, row by row, on /cam/depth.
inline RosMessage depth_image(std::int64_t stamp, const PinholeCamera& view,
                              const std::vector<float>& depth) {
  RosCdr cdr;
  cdr.header(stamp, "optical").number(view.height).number(view.width).text("32FC1");
  cdr.number(std::uint8_t{0}).number(view.width * 4);
  cdr.number(static_cast<std::uint32_t>(depth.size() * 4));
  for (const float z : depth) {
    std::array<std::uint8_t, 4> bytes{};
    std::memcpy(bytes.data(), &z, 4);
    for (const std::uint8_t byte : bytes) cdr.number(byte);
  }
  return {"/cam/depth", "sensor_msgs/msg/Image", stamp, cdr.bytes()};
}

// The same depths as points on /cam/points: in rows, with NaN where depth is missing, or in one row
// without what is missing.
inline RosMessage points_of(std::int64_t stamp, const PinholeCamera& view,
                            const std::vector<float>& depth, bool in_rows) {
  std::vector<float> numbers;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double z = depth[i];
    if (!in_rows && std::isnan(z)) continue;
    const auto column = static_cast<double>(i % view.width);
    const auto row = static_cast<double>(i / view.width);
    numbers.push_back(static_cast<float>((column - view.cx) * z / view.fx));
    numbers.push_back(static_cast<float>((row - view.cy) * z / view.fy));
    numbers.push_back(depth[i]);
  }
  const std::uint32_t height = in_rows ? view.height : 1;
  const auto width = static_cast<std::uint32_t>(numbers.size() / 3 / height);
  constexpr std::uint8_t kFloat32 = 7;
  RosCdr cdr;
  cdr.header(stamp, "optical").number(height).number(width).number(std::uint32_t{3});
  for (const std::uint32_t axis : {0U, 1U, 2U}) {
    cdr.text(std::string(1, "xyz"[axis])).number(4 * axis).number(kFloat32);
    cdr.number(std::uint32_t{1});
  }
  cdr.number(std::uint8_t{0}).number(std::uint32_t{12}).number(12 * width);
  cdr.number(static_cast<std::uint32_t>(4 * numbers.size()));
  for (const float number : numbers) cdr.number(number);
  cdr.number(static_cast<std::uint8_t>(in_rows ? 0 : 1));
  return {"/cam/points", "sensor_msgs/msg/PointCloud2", stamp, cdr.bytes()};
}

// The info of a camera without distortion, on /cam/camera_info.
inline RosMessage camera_info(std::int64_t stamp, const PinholeCamera& view) {
  RosCdr cdr;
  cdr.header(stamp, "optical").number(view.height).number(view.width).text("plumb_bob");
  cdr.numbers({0, 0, 0, 0, 0});
  for (const double k : {view.fx, 0.0, view.cx, 0.0, view.fy, view.cy, 0.0, 0.0, 1.0})
    cdr.number(k);
  for (const double r : {1, 0, 0, 0, 1, 0, 0, 0, 1}) cdr.number(static_cast<double>(r));
  for (const double p :
       {view.fx, 0.0, view.cx, 0.0, 0.0, view.fy, view.cy, 0.0, 0.0, 0.0, 1.0, 0.0})
    cdr.number(p);
  cdr.number(std::uint32_t{0}).number(std::uint32_t{0});
  for (int i = 0; i < 4; ++i) cdr.number(std::uint32_t{0});
  cdr.number(std::uint8_t{0});
  return {"/cam/camera_info", "sensor_msgs/msg/CameraInfo", stamp, cdr.bytes()};
}

}  // namespace clearance::test
