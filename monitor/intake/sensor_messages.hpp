// Hands on the messages of cameras and other sensors, and the transforms that place them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "monitor/intake/decoder.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// A message as it came. Decoding an image takes longer than a reading thread should wait.
struct RawSensorMessage {
  enum class Type : std::uint8_t {
    kImage,
    kCameraInfo,
    kPoints,
    kOctomap,
    kPlanningScene,  // of MoveIt, with an octomap
    kTransforms,
    kStaticTransforms,
    kLaserScan,
  };
  Type type = Type::kImage;
  std::string topic = {};  // of all but transforms
  std::int64_t sent_ns = 0;
  std::uint64_t writer = 0;
  std::vector<std::byte> cdr = {};
  CdrBytes bytes = CdrBytes::kUnchecked;
};
using UseSensorMessage = std::function<void(RawSensorMessage message)>;

// The type of /tf and /tf_static. Where an intake has ros_transforms, these come through it.
inline constexpr std::string_view kTransformsType = "tf2_msgs/msg/TFMessage";

// The names and types of /tf and /tf_static.
[[nodiscard]] std::vector<NamedTopic> transform_topics();

// True if a sensor of the cell stands in a frame of tf.
[[nodiscard]] bool needs_transforms(const Scene& scene) noexcept;

class SensorMessages final : public Decoder {
 public:
  // Without `use`, no topic is wanted.
  SensorMessages(const Cell& cell, UseSensorMessage use, Outlet& out)
      : scene_(&cell.scene), use_(std::move(use)), out_(out) {}

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] std::vector<NamedTopic> named() const override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  void change(const Cell& cell) override { scene_ = &cell.scene; }

 private:
  struct Topic {
    RawSensorMessage::Type type;
    std::string name;
  };
  [[nodiscard]] std::optional<Wanted> wants_transforms(const std::string& name);
  // The topic is that of a sensor of the kind, under this key.
  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic, SensorKind kind,
                                            std::string Sensor::*key, RawSensorMessage::Type type,
                                            const RosType& delivery);
  [[nodiscard]] std::uint32_t port_of(const Topic& topic);

  const Scene* scene_;
  UseSensorMessage use_;
  Outlet& out_;
  std::vector<Topic> topics_;  // by port
};

}  // namespace clearance
