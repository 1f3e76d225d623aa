#include "monitor/intake/tracked_bodies.hpp"

#include <algorithm>
#include <limits>

namespace clearance {

void TrackedBodies::change(const Cell& cell) {
  topic_ = cell.ros.moveit.tracked_bodies;
  persons_ = static_cast<std::size_t>(std::ranges::count_if(
      cell.scene.robots, [](const Robot& robot) { return robot.person.has_value(); }));
}

std::optional<Decoder::Wanted> TrackedBodies::wants(const TopicName& topic) {
  if (!is_used() || topic.name != topic_ || topic.type != "hri_msgs/msg/IdsList")
    return std::nullopt;
  out_.tell(News(lines::kTopicHeard, "the bodies of ROS4HRI", topic.name));
  return Wanted{0, &kRosIdsList};
}

std::vector<NamedTopic> TrackedBodies::named() const {
  return is_used() ? std::vector<NamedTopic>{{topic_, &kRosIdsList}} : std::vector<NamedTopic>();
}

// The same list is handed on again after a while: the change that it asked for may have been
// refused.
bool TrackedBodies::decode(std::uint32_t, const RawMessage& message, const Now& now, TopicCounts&) {
  if (!decoder_.decode(message.cdr, list_, message.bytes)) return false;
  std::vector<std::string> bodies(list_->ids._buffer, list_->ids._buffer + list_->ids._length);
  heard_ns_ = now.monotonic_ns;
  const bool is_news = std::exchange(is_silent_, false) || bodies != bodies_ ||
                       handed_on_ns_ == 0 || now.monotonic_ns - handed_on_ns_ >= kSilentNs;
  if (!is_news) return true;
  const bool too_many = bodies.size() > persons_;
  if (too_many && !too_many_said_)
    out_.tell(News(lines::kTooManyBodies, topic_, bodies.size(), persons_));
  too_many_said_ = too_many;
  bodies_ = std::move(bodies);
  handed_on_ns_ = now.monotonic_ns;
  use_({moveit::RawScene::Type::kTrackedBodies,
        topic_,
        {message.cdr.begin(), message.cdr.end()},
        message.bytes,
        message.sent_ns});
  return true;
}

void TrackedBodies::settle(const Now& now) {
  if (!is_used()) return;
  if (!heard_ns_) heard_ns_ = now.monotonic_ns;
  if (now.monotonic_ns - *heard_ns_ < kSilentNs) return;
  // Silence is handed on again after a while, for the same reason as a list.
  if (is_silent_ && now.monotonic_ns - handed_on_ns_ < kSilentNs) return;
  if (!std::exchange(is_silent_, true)) out_.tell(News(lines::kBodiesSilent, topic_));
  handed_on_ns_ = now.monotonic_ns;
  use_({.type = moveit::RawScene::Type::kTrackedBodies,
        .topic = topic_,
        .sent_ns = now.realtime_ns});
}

std::int64_t TrackedBodies::patience_ns() const {
  return is_used() ? kSilentNs / 10 : std::numeric_limits<std::int64_t>::max();
}

}  // namespace clearance
