// A sensor with its frames: the inside of Sensors.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "monitor/sensors/info_pairing.hpp"
#include "monitor/sensors/persistence.hpp"
#include "monitor/sensors/sensors.hpp"
#include "monitor/wire/camera_types.hpp"
#include "monitor/wire/moveit_types.hpp"

namespace clearance {

inline SeenCloud cloud_of(const Sensor& sensor) {
  return sensor.kind == SensorKind::kDepthImage ? SeenCloud::of_images(sensor.columns, sensor.rows)
                                                : SeenCloud::of_points(sensor.most_points);
}

// Returns the kind of sensor that sends such messages; CameraInfo and transforms count as those of
// images.
inline SensorKind kind_of(RawSensorMessage::Type type) noexcept {
  using Type = RawSensorMessage::Type;
  switch (type) {
    case Type::kPoints:
      return SensorKind::kPoints;
    case Type::kOctomap:
    case Type::kPlanningScene:
      return SensorKind::kOctomap;
    case Type::kImage:
    case Type::kCameraInfo:
    case Type::kTransforms:
    case Type::kStaticTransforms:
      return SensorKind::kDepthImage;
  }
  return SensorKind::kDepthImage;
}

// A frame that was judged and is not built yet. The views are of the sample's memory.
struct Sensors::Waiting {
  Sample<sensor_msgs_msg_dds__Image_> image_sample;
  Sample<sensor_msgs_msg_dds__PointCloud2_> points_sample;
  Sample<octomap_msgs_msg_dds__Octomap_> map_sample;
  Sample<moveit_msgs_msg_dds__PlanningScene_> scene_sample;
  DepthImage image;
  PointsView points;
  OctomapView map;
  Pose frame_from_sensor;  // of a map of MoveIt
  PinholeCamera camera;
  std::string frame;         // of tf
  RawSensorMessage message;  // if it is kept
  std::int64_t stamp_ns = 0, came_ns = 0;

  [[nodiscard]] auto& sample(const sensor_msgs_msg_dds__Image_*) noexcept { return image_sample; }
  [[nodiscard]] auto& sample(const sensor_msgs_msg_dds__PointCloud2_*) noexcept {
    return points_sample;
  }
  [[nodiscard]] auto& sample(const octomap_msgs_msg_dds__Octomap_*) noexcept { return map_sample; }
  [[nodiscard]] auto& sample(const moveit_msgs_msg_dds__PlanningScene_*) noexcept {
    return scene_sample;
  }
  [[nodiscard]] DepthImage& view(const sensor_msgs_msg_dds__Image_*) noexcept { return image; }
  [[nodiscard]] PointsView& view(const sensor_msgs_msg_dds__PointCloud2_*) noexcept {
    return points;
  }
  [[nodiscard]] OctomapView& view(const octomap_msgs_msg_dds__Octomap_*) noexcept { return map; }
};

struct Sensors::State {
  State(std::uint32_t the_index, const Sensor& the_sensor, const Object& object)
      : index(the_index),
        sensor(the_sensor),
        age_limit_ns(object.age_limit_ns),
        stream({.most_pixels = the_sensor.most_points,
                .least_interval_ns = the_sensor.least_interval_ns}) {
    for (std::size_t i = 0; i < kClouds; ++i)
      clouds.push_back(std::make_unique<SeenCloud>(cloud_of(sensor)));
    if (sensor.persist_frames > 1) persistence.emplace(sensor, object.max_speed);
  }
  std::uint32_t index;
  const Sensor& sensor;
  std::int64_t age_limit_ns;
  CameraStream stream;
  InfoPairing pairing;
  std::vector<std::unique_ptr<SeenCloud>> clouds;
  std::deque<std::unique_ptr<Waiting>> waiting;
  // The last image before the first CameraInfo: drivers publish the info of a frame after its
  // image. It counts as refused once another one replaces it.
  RawSensorMessage without_info;
  std::optional<Persistence> persistence;  // none: all elements stay
  std::array<std::uint64_t, kFrameFaults> not_built{};
  SensorStatus status;
};

}  // namespace clearance
