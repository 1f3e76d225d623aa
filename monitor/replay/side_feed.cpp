#include "monitor/replay/side_feed.hpp"

#include <algorithm>

namespace clearance {
namespace {

bool is_of(SideTopic topic, const McapChannel& channel) {
  return channel.encoding == kCdrEncoding && channel.schema.name == side_schema(topic).name;
}

// A file without a summary may have such messages.
bool may_have(SideTopic topic, const McapReader& reader) {
  if (!reader.summary()) return true;
  return std::ranges::any_of(reader.summary()->channels,
                             [topic](const auto& channel) { return is_of(topic, channel.second); });
}

}  // namespace

template <class Message>
const Message* SideFeed<Message>::front() {
  while (!is_there_) {
    if (!read_one()) return nullptr;
  }
  return &*message_;
}

// Damage is told by the reader of everything else.
template <class Message>
bool SideFeed<Message>::read_one() {
  McapMessage message;
  while (reader_ == nullptr || !reader_->next(message)) {
    if (next_file_ == files_.size()) return false;
    reader_ = std::make_unique<McapReader>(files_[next_file_++], window_);
    change_ = {};
    if (!may_have(topic_, *reader_)) reader_ = nullptr;
  }
  log_ns_ = static_cast<std::int64_t>(message.log_time);
  is_there_ = is_of(topic_, *message.channel) &&
              decoder_.decode(in_our_layout(*message.channel, message.payload), message_);
  return true;
}

// Fields that the recording's build did not know are 0. A layout that cannot be read has no bytes.
template <class Message>
std::span<const std::byte> SideFeed<Message>::in_our_layout(const McapChannel& channel,
                                                            std::span<const std::byte> payload) {
  const McapSchema& ours = side_schema(topic_);
  if (channel.schema.text == ours.text) return payload;
  if (!change_) {
    const std::string_view type = std::string_view(ours.name).substr(ours.name.rfind(':') + 1);
    change_.emplace(channel.schema.text, ours.text, type);
  }
  return change_->error().empty() ? change_->apply(payload) : std::span<const std::byte>();
}

template class SideFeed<clearance_msg_SensorFrame>;
template class SideFeed<clearance_msg_PartnerState>;

}  // namespace clearance
