// A camera that measures depth, or another sensor that measures points. What it sees is the body of
// an object of the scene: pairs, groups and zones name that object like any other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "config/scene/reach_ball.hpp"
#include "config/scene/robot.hpp"
#include "config/scene/ros_stamps.hpp"

namespace clearance {

inline constexpr std::size_t kMaxSensors = 16;  // of a cell

enum class SensorKind : std::uint8_t {
  kDepthImage,  // sensor_msgs/Image with CameraInfo: each pixel is a slab of its cone
  kPoints,      // sensor_msgs/PointCloud2 or LaserScan: each point is a ball
  kOctomap,  // octomap_msgs/Octomap, or MoveIt's in a PlanningScene: each occupied leaf is a cube
};

// A depth camera sees at most this far to each side of its axis, per metre of depth: the tangent of
// the side rays, whose largest sine is 7/9. A corner ray of a picture is longer than its depth by
// kLongestRay at most: sqrt(1 + 2 kWidestTangent^2), rounded up.
inline constexpr double kWidestTangent = 1.2374368670764582;
inline constexpr double kLongestRay = 2.0156;

// The ball of a point with neighbours reaches at most this times its range, and this times the
// largest error (monitor/sensors/organised_points.hpp).
inline constexpr double kWidestReach = 0.2, kWidestErrors = 3.0;

// The largest speed of a frame of tf in what carries it: of its origin, m/s, and rad/s.
struct MountSpeed {
  double shift = std::numeric_limits<double>::infinity();
  double turn = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_stated() const noexcept {
    return shift < std::numeric_limits<double>::infinity();
  }
  bool operator==(const MountSpeed&) const = default;
};

struct Sensor {
  std::string name;  // also of its object
  SensorKind kind = SensorKind::kDepthImage;
  std::uint32_t object = 0;  // index into Scene::objects
  std::string topic;         // of the images, points or maps, in ROS 2's spelling
  std::string camera_info;   // of CameraInfo; of depth images only
  RosStamps stamps = RosStamps::kMessage;

  // The place of its frame, which has z forward, x right, y down for a camera. With
  // `frames_by_message`, the frame of tf that each message names; else `mount` states a frame of
  // tf, and the sensor's pose in it (frame_from_root); or a pose on the world, an object or a link
  // (base_from_root).
  bool frames_by_message = true;
  RobotBase mount;
  // Both or none are stated. Without them, the place of a frame of tf is not known after its last
  // transform.
  MountSpeed mount_speed;

  // The stated bound of its error: |measured - true depth| <= constant + quadratic z^2, m. Depth is
  // z, or for points with `along_ray` the distance from the sensor.
  double error_constant = 0.0, error_quadratic = 0.0;
  bool along_ray = false;
  // The range of depths, m; other depths count as missing. For a map, the greatest one is a
  // distance from the origin of its frame. Cubes farther away bound distances, but have none of
  // their own.
  double least_depth = 0.0, greatest_depth = 0.0;
  // The distance between neighbouring rays of points at a depth of 1 m, m. A ball of half of it
  // times the depth, and of the error, contains the surface around a point. 0: the points alone.
  double spacing = 0.0;
  // The ball of each organised point reaches to the middle between it and its neighbours on
  // the same surface instead (monitor/sensors/organised_points.hpp).
  bool by_neighbours = false;

  // The memory that is fixed: the largest image, or the most points that are kept.
  std::uint32_t columns = 0, rows = 0;
  std::uint32_t most_points = 0;

  // Elements that come within this of a part of a robot, at the stamp of the frame, are left out,
  // m. The error of the part's pose is added.
  double own_shell = 0.0;
  // However uncertain a pose is, elements farther than this from where the part is believed to be
  // are not taken for its image, m. For a ball, the centre counts, to within its own error. At
  // least own_shell.
  double most_shell = 0.3;
  // Limit of a link's shell, m, at least own_shell. Elements left out of a thicker shell count for
  // all other objects: their lower bounds do not exceed the distance to them.
  double trusted_shell = 0.1;
  // Elements that come within own_shell of a fixed or tracked body of the cell are left out, too,
  // as the images of links are.
  bool knows = false;

  // A frame whose stamp is less than this after that of the frame before is refused; 0: none is.
  std::int64_t least_interval_ns = 0;

  // False: it has no noise, so a still scene gives the same depth again. Otherwise, a frame that
  // repeats one of the last ones is frozen.
  bool has_noise = true;
  // A frame that shows depth within the range for a smaller share of its elements is refused.
  double least_seen = 0.0;

  // The true time of a frame is within this of its stamp. The poses of links and mounts at that
  // time are known accordingly less well, and what is seen counts as seen that much earlier.
  std::int64_t stamp_error_ns = 0;

  // Elements stay only if this many of the last frames have one near it (1: all stay).
  std::uint32_t persist_frames = 1, persist_of = 1;

  // Elements beyond this from everywhere that links can come to are cropped, m; infinity: none are.
  double reach = std::numeric_limits<double>::infinity();
  // The balls that contain all other elements, widened by the motion of what is seen within the age
  // limit. Empty: no element is cropped.
  std::vector<ReachBall> crop;

  // A second witness of robots (monitor/sensors/witness.hpp). A robot is not where its joints say
  // if more than `witness_share` of the rays that should meet it go through it, in
  // `witness_frames` pictures in a row.
  bool is_witness = false;
  double witness_share = 0.05;
  std::uint32_t witness_frames = 5;

  // Reports say how near each link is to a place in the picture that the frame has not seen. Only a
  // depth image has such places.
  bool unseen = false;

  [[nodiscard]] bool is_on_tf() const noexcept { return frames_by_message || !mount.frame.empty(); }
  [[nodiscard]] double error_at(double depth) const noexcept {
    return error_constant + error_quadratic * depth * depth;
  }
  // The radius of the ball that is the body of the sensor's object, m. The ball contains all that a
  // frame shows, wherever the sensor is within the error of its place. A frame whose error is too
  // large for that is refused. Nothing bounds what is beyond the range of a map, so a map's ball
  // has the largest radius.
  [[nodiscard]] double view_radius() const noexcept {
    return kind == SensorKind::kOctomap ? kLargestCoordinate : 2.0 * extent() + 0.1;
  }
  // No element is farther from the sensor than this, m.
  [[nodiscard]] double extent() const noexcept {
    if (kind == SensorKind::kOctomap) return 2.0 * greatest_depth;
    const double error = error_at(greatest_depth);
    const double farthest = kLongestRay * (greatest_depth + error);
    if (kind == SensorKind::kDepthImage) return 1.001 * farthest;
    if (by_neighbours)
      return 1.001 * ((1.0 + kWidestReach) * farthest + kWidestErrors * kLongestRay * error);
    return 1.001 * (farthest + kLongestRay * error + spacing * (greatest_depth + error));
  }
  bool operator==(const Sensor&) const = default;
};

// Returns the sentences about a sensor that a person should read at the start.
[[nodiscard]] std::vector<std::string> notes_of(const Sensor& sensor);

struct Scene;
// Fixed and tracked bodies that are no links, and that a sensor with Sensor::knows leaves out.
// Indices into Scene::objects, ascending; none without such a sensor. A body that is absent is not
// there to be seen.
[[nodiscard]] std::vector<std::uint32_t> known_bodies(const Scene& scene);

// The published pairs of a sensor and a link, what it carries, or a body that the sensor knows:
// their own image is left out of the sensor's frames. Indices into Scene::pairs, ascending.
[[nodiscard]] std::vector<std::uint32_t> hidden_pairs(const Scene& scene);

}  // namespace clearance
