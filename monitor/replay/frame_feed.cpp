#include "monitor/replay/frame_feed.hpp"

#include <algorithm>

#include "monitor/recording/topic_schema.hpp"

namespace clearance {
namespace {

bool is_of_frames(const McapChannel& channel) {
  return channel.encoding == kCdrEncoding && channel.schema.name == frames_schema().name;
}

// A file without a summary may have frames.
bool may_have_frames(const McapReader& reader) {
  if (!reader.summary()) return true;
  return std::ranges::any_of(reader.summary()->channels,
                             [](const auto& channel) { return is_of_frames(channel.second); });
}

}  // namespace

const clearance_msg_SensorFrame* FrameFeed::front() {
  while (!is_there_) {
    if (!read_one()) return nullptr;
  }
  return &*frame_;
}

// Damage is told by the reader of everything else.
bool FrameFeed::read_one() {
  McapMessage message;
  while (reader_ == nullptr || !reader_->next(message)) {
    if (next_file_ == files_.size()) return false;
    reader_ = std::make_unique<McapReader>(files_[next_file_++], window_);
    if (!may_have_frames(*reader_)) reader_ = nullptr;
  }
  log_ns_ = static_cast<std::int64_t>(message.log_time);
  is_there_ = is_of_frames(*message.channel) && decoder_.decode(message.payload, frame_);
  return true;
}

}  // namespace clearance
