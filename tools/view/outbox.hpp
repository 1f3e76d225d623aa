// The messages that wait for one viewer. Only the newest message of every channel and key waits: a
// viewer that is slower than the reports gets fewer of them, never old ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/view/channels.hpp"

namespace clearance::view {

using Bytes = std::shared_ptr<const std::vector<std::byte>>;

// A message of a channel. Messages with different keys (zones, sources) do not replace each other.
struct Message {
  ChannelId channel = 0;
  std::uint32_t key = 0;
  std::int64_t time_ns = 0;  // time of publication; the log time in a recording
  Bytes payload = {};        // CDR
};

class Outbox {
 public:
  // False when so much waits that the viewer evidently does not read.
  [[nodiscard]] bool add_text(std::string text) {
    constexpr std::size_t kMostTexts = 64;
    texts_.push_back(std::move(text));
    return texts_.size() <= kMostTexts;
  }
  void add(const Message& message) {
    const auto place = std::pair{message.channel, message.key};
    const auto [waiting, is_new] = waiting_.try_emplace(place, message);
    if (is_new) {
      order_.push_back(place);
    } else {
      waiting->second = message;
      ++dropped_;
    }
  }
  void set_time(std::int64_t ns) { time_ns_ = ns; }

  [[nodiscard]] std::optional<std::string> take_text() {
    if (texts_.empty()) return std::nullopt;
    std::string text = std::move(texts_.front());
    texts_.pop_front();
    return text;
  }
  [[nodiscard]] std::optional<std::int64_t> take_time() {
    return std::exchange(time_ns_, std::nullopt);
  }
  // In the order in which they began to wait.
  [[nodiscard]] std::optional<Message> take_message() {
    if (order_.empty()) return std::nullopt;
    auto entry = waiting_.extract(order_.front());
    order_.pop_front();
    return std::move(entry.mapped());
  }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  using Place = std::pair<ChannelId, std::uint32_t>;
  std::deque<std::string> texts_;
  std::optional<std::int64_t> time_ns_;
  std::map<Place, Message> waiting_;
  std::deque<Place> order_;
  std::uint64_t dropped_ = 0;  // replaced before they were sent
};

}  // namespace clearance::view
