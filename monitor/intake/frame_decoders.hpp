// The types of messages that show obstacles: a row each.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "monitor/intake/message_cloud.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

struct FrameDecoder {
  RawSensorMessage::Type message;
  SensorKind kind;  // of the sensors whose topics have it
  std::string_view type;
  const RosType* delivery;
  // Null: the message says nothing of what the sensor sees. If the bytes are no such message, the
  // fault is kUndecodable.
  std::unique_ptr<MessageCloud> (*decode)(const RawSensorMessage& message, const Sensor& sensor,
                                          CdrDecoder& decoder);
};

[[nodiscard]] std::span<const FrameDecoder> frame_decoders() noexcept;

// Null if messages of this type are no frames: they place a sensor, or describe it.
[[nodiscard]] const FrameDecoder* frame_decoder(RawSensorMessage::Type type) noexcept;

// True if messages of this type are frames of such a sensor.
[[nodiscard]] bool is_frame_type(SensorKind kind, std::string_view type) noexcept;

}  // namespace clearance
