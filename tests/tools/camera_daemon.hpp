// A daemon with a camera above a ball and an arm.
#pragma once

#include <string>

#include "tests/shared/ros_camera.hpp"
#include "tests/tools/watched_daemon.hpp"

namespace clearance::test {

inline constexpr double kError = 0.002;  // of the depth, m
inline constexpr double kRadius = 0.1;   // of the objects before the camera, m
inline constexpr double kHeight = 3.0;   // of the camera above the origin of the world, m
inline constexpr double kRounding =
    2.5e-7;  // of float32 between 2 and 4 m, in which depths are kept
inline constexpr int kPeriodMs = 20;

inline const std::string kImage =
    "depth_image: /cam/image, size: [65, 49], depth_error: {constant: 0.002}, range: [0.3, 4]";
inline const std::string kPoints =
    "points: /cam/points, most_points: 4000, depth_error: {constant: 0.002}, range: [0.3, 4]";
// The camera looks down along the z axis of the world.
inline const std::string kAbove =
    ", mount: {pose: {xyz: [0, 0, 3], rpy: [3.141592653589793, 0, 0]}}";

// A ball fixed 1 m below the camera, and the arm of scara.urdf at the origin.
class DaemonCameras : public WatchedDaemon {
 protected:
  void start(const std::string& sensor, const std::vector<std::string>& more = {},
             const std::string& ball = "pose: {xyz: [0, 0, 2]}") {
    watch("name: cameras\nunits: {length: m, angle: rad}\nrate_hz: " + std::to_string(rate_hz) +
              "\nros2: {world_frame: map}\n"
              "robots: [{name: arm, urdf: scara.urdf}]\n"
              "objects: [{name: ball, fixed: true, sphere: {radius: 0.1}, " +
              ball + "}]\nsensors: [{name: eye, " + sensor +
              "}]\npairs: [{between: [ball, eye]}, {between: [arm, eye]}]\n",
          more);
  }
  // The one pair of the ball.
  const clearance_msg_PairDistance& ball_pair() { return pair("ball"); }
  bool is_measured() { return is("ball", PairStatus::kConverged); }

  int rate_hz = 200;
  MadeScene scene_of_wall{.wall = 2.5, .ball = {}};
};

}  // namespace clearance::test
