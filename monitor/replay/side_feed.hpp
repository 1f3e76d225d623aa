// The messages of a side topic of a recording, in their order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "monitor/files/reader.hpp"
#include "monitor/recording/layout_change.hpp"
#include "monitor/recording/topic_schema.hpp"
#include "monitor/sensors/built_frames.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Reads the files beside the reader of everything else, and only where their summaries say that
// they have such messages. `Message`: the type of the topic.
template <class Message>
class SideFeed {
 public:
  // The next message; null at the end or the damage. Valid until pop() or take().
  [[nodiscard]] const Message* front();
  // The log time of front(), ns.
  [[nodiscard]] std::int64_t front_ns() const noexcept { return log_ns_; }
  void pop() noexcept { is_there_ = false; }
  // The front, which goes.
  [[nodiscard]] Sample<Message> take() noexcept {
    pop();
    return std::exchange(message_, {});
  }

 protected:
  SideFeed(SideTopic topic, std::vector<std::filesystem::path> files, const McapWindow& window)
      : topic_(topic), files_(std::move(files)), window_(window) {}

 private:
  [[nodiscard]] bool read_one();
  [[nodiscard]] std::span<const std::byte> in_our_layout(const McapChannel& channel,
                                                         std::span<const std::byte> payload);

  SideTopic topic_;
  std::vector<std::filesystem::path> files_;
  McapWindow window_;
  std::int64_t log_ns_ = 0;
  std::size_t next_file_ = 0;
  std::unique_ptr<McapReader> reader_;
  std::optional<LayoutChange> change_;  // of this file's channel; none: not looked at yet
  CdrDecoder decoder_;
  Sample<Message> message_;
  bool is_there_ = false;
};

class FrameFeed final : public SideFeed<clearance_msg_SensorFrame> {
 public:
  explicit FrameFeed(std::vector<std::filesystem::path> files, const McapWindow& window = {})
      : SideFeed(SideTopic::kFrames, std::move(files), window) {}
};
class StateFeed final : public SideFeed<clearance_msg_PartnerState> {
 public:
  explicit StateFeed(std::vector<std::filesystem::path> files)
      : SideFeed(SideTopic::kStates, std::move(files), {}) {}
};

}  // namespace clearance
