// Hands on the lists of tracked bodies of ROS4HRI, hri_msgs/msg/IdsList, as messages that change
// the scene.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "monitor/intake/decoder.hpp"
#include "monitor/intake/moveit_messages.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// Trackers send the list with every picture. One that is silent may have died, and then a person
// may come in unseen. Several trackers each see a part of the cell: the bodies are those of all
// lists. A tracker that starts after another has fallen silent stands in for it.
class TrackedBodies final : public Decoder {
 public:
  static constexpr std::int64_t kSilentNs = 1'000'000'000;
  // After this time without too many bodies, the next excess is logged again.
  static constexpr std::int64_t kNewAgainNs = 10 * kSilentNs;

  // Without `use`, no topic is wanted.
  TrackedBodies(const Cell& cell, MoveItMessages::Use use, Outlet& out)
      : out_(out), use_(std::move(use)) {
    change(cell);
  }

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] std::vector<NamedTopic> named() const override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  // Hands on the next list, since the changed cell may say otherwise.
  void change(const Cell& cell) override;
  // After a second without a list of one of the trackers, hands on a message without bytes.
  void settle(const Now& now) override;
  [[nodiscard]] std::int64_t patience_ns() const override;

 private:
  struct Tracker {
    std::vector<std::string> bodies = {};
    std::int64_t first_ns = 0, last_ns = 0;  // when it was heard
    bool replaces = false;                   // it stands in for one that has fallen silent
    [[nodiscard]] bool is_silent(const Now& now) const noexcept {
      return now.monotonic_ns - last_ns >= kSilentNs;
    }
  };
  [[nodiscard]] bool is_used() const { return use_ && !topic_.empty(); }
  void forget_replaced(const Now& now);
  [[nodiscard]] bool is_one_silent(const Now& now) const noexcept;
  [[nodiscard]] std::vector<std::string> bodies_of_all() const;
  void hand_on(std::vector<std::string> bodies, const RawMessage& message, const Now& now);

  Outlet& out_;
  MoveItMessages::Use use_;
  std::string topic_;
  std::size_t persons_ = 0;
  CdrDecoder decoder_;
  Sample<hri_msgs_msg_dds__IdsList_> list_;
  CdrEncoder encoder_;
  std::map<std::uint64_t, Tracker> trackers_;  // by writer
  std::vector<std::string> bodies_;            // of the last message that was handed on
  std::int64_t handed_on_ns_ = 0;              // its time of arrival; 0: there was none
  std::optional<std::int64_t> begun_ns_;       // the first settle()
  std::optional<std::int64_t> too_many_ns_;    // the last list with more bodies than persons
  bool is_silent_ = false;
};

}  // namespace clearance
