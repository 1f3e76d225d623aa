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

  // Without `use`, no topic is wanted; then, messages that the cell would use are named once.
  MoveItMessages(const Cell& cell, Use use, Outlet& out)
      : inputs_(&cell.ros.moveit), use_(std::move(use)), out_(out) {}

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] std::vector<NamedTopic> named() const override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  void change(const Cell& cell) override { inputs_ = &cell.ros.moveit; }

 private:
  const MoveItInputs* inputs_;
  Use use_;
  Outlet& out_;
};

}  // namespace clearance
