// A sensor with its frames: the inside of Sensors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "monitor/intake/frame_decoders.hpp"
#include "monitor/sensors/info_pairing.hpp"
#include "monitor/sensors/persistence.hpp"
#include "monitor/sensors/seen_share.hpp"
#include "monitor/sensors/sensors.hpp"

namespace clearance {

inline SeenCloud cloud_of(const Sensor& sensor) {
  return sensor.kind == SensorKind::kDepthImage ? SeenCloud::of_images(sensor.columns, sensor.rows)
                                                : SeenCloud::of_points(sensor.most_points);
}

// A frame that was judged and is not built yet.
struct Sensors::Waiting {
  std::unique_ptr<MessageCloud> cloud;
  PinholeCamera camera;
  RawSensorMessage message;  // if it is kept
  std::int64_t stamp_ns = 0, came_ns = 0;
  bool repeats = false;  // the depth of a frame before it
};

struct Sensors::State {
  State(std::uint32_t the_index, const Sensor& the_sensor, const Object& object)
      : index(the_index),
        sensor(the_sensor),
        age_limit_ns(object.age_limit_ns),
        stream({.least_interval_ns = the_sensor.least_interval_ns,
                .may_repeat = !the_sensor.has_noise}) {
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
  // Of an octomap: the last map that was taken, and its time. Its server may never send it again.
  RawSensorMessage map;
  std::int64_t map_ns = 0;
  SeenShare seen_share;
  std::size_t own_elements = 0;            // of bodies in the last picture that was new
  std::optional<Persistence> persistence;  // none: all elements stay
  std::array<std::uint64_t, kFrameFaults> not_built{};
  RobotsSeen robots;                        // in the last picture
  std::optional<UnknownPayloads> payloads;  // of a witness
  SensorStatus status;
};

}  // namespace clearance
