// The messages of a depth camera, for bags.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
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
