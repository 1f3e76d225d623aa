// Hands on MoveIt's messages that keep the scene.
#pragma once

#include <functional>

#include "monitor/intake/decoder.hpp"
#include "monitor/intake/scene_keeper.hpp"

namespace clearance {

class MoveItMessages final : public Decoder {
 public:
  // Receives each message of the topics that the cell names.
  using Use = std::function<void(moveit::RawScene message)>;

  // Without `use`, no topic is wanted; then, messages that the cell would use are named once. A
  // missing publisher is not reported for a log.
  MoveItMessages(const Cell& cell, Use use, bool is_log, Outlet& out);

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] std::vector<NamedTopic> named() const override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  void change(const Cell& cell) override { inputs_ = &cell.ros.moveit; }
  void settle(const Now& now) override;
  [[nodiscard]] std::int64_t patience_ns() const override;

  static constexpr std::int64_t kMissingNs =
      5'000'000'000;  // then, the log names missing publishers

 private:
  const MoveItInputs* inputs_;
  Use use_;
  Outlet& out_;
  bool waits_;                  // no topic has had a publisher yet
  std::int64_t since_ns_ = -1;  // CLOCK_MONOTONIC; -1: never settled
};

}  // namespace clearance
