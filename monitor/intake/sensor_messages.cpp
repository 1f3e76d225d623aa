#include "monitor/intake/sensor_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "monitor/wire/camera_types.hpp"
#include "monitor/wire/moveit_types.hpp"

namespace clearance {
namespace {

using MessageType = RawSensorMessage::Type;

// A row a kind of topic: the key of a sensor that names it.
struct SensorInput {
  std::string Sensor::*topic;
  SensorKind of;
  std::string_view type;
  const RosType* delivery;
  MessageType message;
};
constexpr std::array<SensorInput, 5> kSensorInputs = {{
    {&Sensor::topic, SensorKind::kDepthImage, "sensor_msgs/msg/Image", &kRosImage,
     MessageType::kImage},
    {&Sensor::camera_info, SensorKind::kDepthImage, "sensor_msgs/msg/CameraInfo", &kRosCameraInfo,
     MessageType::kCameraInfo},
    {&Sensor::topic, SensorKind::kPoints, "sensor_msgs/msg/PointCloud2", &kRosPointCloud2,
     MessageType::kPoints},
    {&Sensor::topic, SensorKind::kOctomap, "octomap_msgs/msg/Octomap", &kRosOctomap,
     MessageType::kOctomap},
    {&Sensor::topic, SensorKind::kOctomap, "moveit_msgs/msg/PlanningScene", &kRosPlanningScene,
     MessageType::kPlanningScene},
}};

}  // namespace

bool is_frame_type(SensorKind kind, std::string_view type) noexcept {
  return std::ranges::any_of(kSensorInputs, [&](const SensorInput& input) {
    return input.of == kind && input.topic == &Sensor::topic && input.type == type;
  });
}

bool needs_transforms(const Scene& scene) noexcept {
  return std::ranges::any_of(scene.sensors, [](const Sensor& sensor) { return sensor.is_on_tf(); });
}

std::optional<Decoder::Wanted> SensorMessages::wants(const TopicName& topic) {
  if (!use_) return std::nullopt;
  if (topic.type == kTransformsType) return wants_transforms(topic.name);
  for (const SensorInput& input : kSensorInputs) {
    if (topic.type != input.type) continue;
    const auto sensor = std::ranges::find_if(scene_->sensors, [&](const Sensor& each) {
      return each.kind == input.of && each.*input.topic == topic.name;
    });
    if (sensor == scene_->sensors.end()) continue;
    const std::size_t before = topics_.size();
    const std::uint32_t port = port_of({input.message, topic.name});
    if (port == before) {
      out_.tell({.cause = News::Cause::kTopicHeard,
                 .is_warning = false,
                 .text = fmt::format("sensor '{}' on {}", sensor->name, topic.name)});
    }
    return Wanted{port, input.delivery};
  }
  return std::nullopt;
}

std::optional<Decoder::Wanted> SensorMessages::wants_transforms(const std::string& name) {
  if (!needs_transforms(*scene_)) return std::nullopt;
  if (name == "/tf") return Wanted{port_of({MessageType::kTransforms, name}), &kRosTf};
  if (name == "/tf_static")
    return Wanted{port_of({MessageType::kStaticTransforms, name}), &kRosTfStatic};
  return std::nullopt;
}

std::uint32_t SensorMessages::port_of(const Topic& topic) {
  const auto known = std::ranges::find(topics_, topic.name, &Topic::name);
  const auto port = static_cast<std::uint32_t>(known - topics_.begin());
  if (known == topics_.end()) topics_.push_back(topic);
  return port;
}

bool SensorMessages::decode(std::uint32_t port, const RawMessage& message, const Now&,
                            TopicCounts&) {
  use_({topics_[port].type,
        topics_[port].name,
        message.sent_ns,
        message.writer,
        {message.cdr.begin(), message.cdr.end()},
        message.bytes});
  return true;
}

}  // namespace clearance
