#include "monitor/intake/sensor_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "monitor/intake/frame_decoders.hpp"
#include "monitor/wire/camera_types.hpp"

namespace clearance {
namespace {

using MessageType = RawSensorMessage::Type;

}  // namespace

bool needs_transforms(const Scene& scene) noexcept {
  return std::ranges::any_of(scene.sensors, [](const Sensor& sensor) { return sensor.is_on_tf(); });
}

std::vector<NamedTopic> transform_topics() {
  return {{"/tf", &kRosTf}, {"/tf_static", &kRosTfStatic}};
}

std::optional<Decoder::Wanted> SensorMessages::wants(const TopicName& topic) {
  if (!use_) return std::nullopt;
  if (topic.type == kTransformsType) return wants_transforms(topic.name);
  for (const FrameDecoder& each : frame_decoders()) {
    if (topic.type != each.type) continue;
    if (auto wanted = wants(topic, each.kind, &Sensor::topic, each.message, *each.delivery))
      return wanted;
  }
  if (topic.type != "sensor_msgs/msg/CameraInfo") return std::nullopt;
  return wants(topic, SensorKind::kDepthImage, &Sensor::camera_info, MessageType::kCameraInfo,
               kRosCameraInfo);
}

// Points and maps have one of two types: the first one of the kind is awaited.
std::vector<NamedTopic> SensorMessages::named() const {
  std::vector<NamedTopic> named;
  if (!use_) return named;
  for (const Sensor& sensor : scene_->sensors) {
    const auto decoder = std::ranges::find(frame_decoders(), sensor.kind, &FrameDecoder::kind);
    named.push_back({sensor.topic, decoder->delivery});
    if (!sensor.camera_info.empty()) named.push_back({sensor.camera_info, &kRosCameraInfo});
  }
  if (needs_transforms(*scene_)) std::ranges::move(transform_topics(), std::back_inserter(named));
  return named;
}

std::optional<Decoder::Wanted> SensorMessages::wants(const TopicName& topic, SensorKind kind,
                                                     std::string Sensor::*key, MessageType type,
                                                     const RosType& delivery) {
  const auto sensor = std::ranges::find_if(scene_->sensors, [&](const Sensor& each) {
    return each.kind == kind && each.*key == topic.name;
  });
  if (sensor == scene_->sensors.end()) return std::nullopt;
  const std::size_t before = topics_.size();
  const std::uint32_t port = port_of({type, topic.name});
  if (port == before) {
    out_.tell(News(lines::kTopicHeard, fmt::format("sensor '{}'", sensor->name), topic.name));
  }
  return Wanted{port, &delivery};
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
