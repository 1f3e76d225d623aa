// The clock of a simulation, /clock of ROS 2.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "monitor/inputs/simulated_time.hpp"
#include "monitor/intake/decoder.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

class RosClock final : public Decoder {
 public:
  // `time` must outlive this. Without it, the topic is not wanted.
  RosClock(SimulatedTime* time, Outlet& out) : time_(time), out_(out) {}

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] std::vector<NamedTopic> named() const override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  void settle(const Now& now) override;
  [[nodiscard]] std::int64_t patience_ns() const override;
  void keep(std::span<const std::uint64_t> writers) override;

 private:
  SimulatedTime* time_;
  Outlet& out_;
  CdrDecoder decoder_;
  Sample<rosgraph_msgs_msg_dds__Clock_> message_;
  // The only writer that counts while it is there: the times of two simulations exclude each other.
  std::optional<std::uint64_t> writer_;
  bool is_rival_said_ = false;
  bool is_waiting_said_ = false;  // for the first message, or in a silence
};

}  // namespace clearance
