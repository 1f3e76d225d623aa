// Hands on the lists of tracked bodies of ROS4HRI, hri_msgs/msg/IdsList, as messages that change
// the scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "monitor/intake/decoder.hpp"
#include "monitor/intake/moveit_messages.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// Trackers send the list with every picture. One that is silent may have died, and then a person
// may come in unseen.
class TrackedBodies final : public Decoder {
 public:
  static constexpr std::int64_t kSilentNs = 1'000'000'000;

  // Without `use`, no topic is wanted.
  TrackedBodies(const Cell& cell, MoveItMessages::Use use, Outlet& out)
      : out_(out), use_(std::move(use)) {
    change(cell);
  }

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] std::vector<NamedTopic> named() const override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  void change(const Cell& cell) override;
  // After a second without a list, hands on a message without bytes.
  void settle(const Now& now) override;
  [[nodiscard]] std::int64_t patience_ns() const override;

 private:
  [[nodiscard]] bool is_used() const { return use_ && !topic_.empty(); }

  Outlet& out_;
  MoveItMessages::Use use_;
  std::string topic_;
  std::size_t persons_ = 0;
  CdrDecoder decoder_;
  Sample<hri_msgs_msg_dds__IdsList_> list_;
  std::vector<std::string> bodies_;       // of the last message that was handed on
  std::int64_t handed_on_ns_ = 0;         // its time of arrival; 0: there was none
  std::optional<std::int64_t> heard_ns_;  // the last message, or the first settle()
  bool is_silent_ = false, too_many_said_ = false;
};

}  // namespace clearance
