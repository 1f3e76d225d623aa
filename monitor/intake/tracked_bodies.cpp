#include "monitor/intake/tracked_bodies.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <string_view>

namespace clearance {

void TrackedBodies::change(const Cell& cell) {
  topic_ = cell.ros.moveit.tracked_bodies;
  persons_ = static_cast<std::size_t>(std::ranges::count_if(
      cell.scene.robots, [](const Robot& robot) { return robot.person.has_value(); }));
  handed_on_ns_ = 0;
}

std::optional<Decoder::Wanted> TrackedBodies::wants(const TopicName& topic) {
  if (!is_used() || topic.name != topic_ || topic.type != "hri_msgs/msg/IdsList")
    return std::nullopt;
  out_.tell(News(lines::kTopicHeard, "the bodies of ROS4HRI", topic.name));
  return Wanted{0, &kRosIdsList};
}

std::vector<NamedTopic> TrackedBodies::named() const {
  if (!is_used()) return {};
  return {NamedTopic{topic_, &kRosIdsList}};
}

// Each tracker stands in for one other, whose last list is older than its own first one.
void TrackedBodies::forget_replaced(const Now& now) {
  std::erase_if(trackers_, [&](const auto& former) {
    if (!former.second.is_silent(now)) return false;
    const auto successor = std::ranges::find_if(trackers_, [&](const auto& each) {
      return !each.second.is_silent(now) && !each.second.replaces &&
             each.second.first_ns > former.second.last_ns;
    });
    if (successor == trackers_.end()) return false;
    successor->second.replaces = true;
    return true;
  });
}

bool TrackedBodies::is_one_silent(const Now& now) const noexcept {
  if (trackers_.empty()) return now.monotonic_ns - *begun_ns_ >= kSilentNs;
  return std::ranges::any_of(trackers_,
                             [&](const auto& each) { return each.second.is_silent(now); });
}

// A body that several trackers see counts once. An id that stands twice in one list is of two.
std::vector<std::string> TrackedBodies::bodies_of_all() const {
  std::vector<std::string> all;
  std::set<std::string_view> of_others;
  for (const auto& [writer, tracker] : trackers_) {
    for (const std::string& body : tracker.bodies)
      if (!of_others.contains(body)) all.push_back(body);
    of_others.insert(tracker.bodies.begin(), tracker.bodies.end());
  }
  return all;
}

bool TrackedBodies::decode(std::uint32_t, const RawMessage& message, const Now& now, TopicCounts&) {
  if (!decoder_.decode(message.cdr, list_, message.bytes)) return false;
  if (!begun_ns_) begun_ns_ = now.monotonic_ns;
  const auto [tracker, is_new] =
      trackers_.try_emplace(message.writer, Tracker{.first_ns = now.monotonic_ns});
  tracker->second.bodies.assign(list_->ids._buffer, list_->ids._buffer + list_->ids._length);
  tracker->second.last_ns = now.monotonic_ns;
  forget_replaced(now);
  if (!is_one_silent(now)) hand_on(bodies_of_all(), message, now);
  return true;
}

// The same list is handed on again after a while: the change that it asked for may have been
// refused.
void TrackedBodies::hand_on(std::vector<std::string> bodies, const RawMessage& message,
                            const Now& now) {
  const bool is_news = std::exchange(is_silent_, false) || bodies != bodies_ ||
                       handed_on_ns_ == 0 || now.monotonic_ns - handed_on_ns_ >= kSilentNs;
  if (!is_news) return;
  if (bodies.size() > persons_) {
    const bool is_new = !too_many_ns_ || now.monotonic_ns - *too_many_ns_ >= kNewAgainNs;
    if (is_new) out_.tell(News(lines::kTooManyBodies, topic_, bodies.size(), persons_));
    too_many_ns_ = now.monotonic_ns;
  }
  bodies_ = std::move(bodies);
  handed_on_ns_ = now.monotonic_ns;
  Sample<hri_msgs_msg_dds__IdsList_> list;
  list->header.frame_id = dds_string_dup("");
  reserve_sequence(list->ids, bodies_.size());
  for (const std::string& body : bodies_)
    list->ids._buffer[list->ids._length++] = dds_string_dup(body.c_str());
  const auto bytes = encoder_.encode(*list);
  use_({.type = moveit::RawScene::Type::kTrackedBodies,
        .topic = topic_,
        .cdr = {bytes.begin(), bytes.end()},
        .sent_ns = message.sent_ns});
}

void TrackedBodies::settle(const Now& now) {
  if (!is_used()) return;
  if (!begun_ns_) begun_ns_ = now.monotonic_ns;
  forget_replaced(now);
  if (!is_one_silent(now)) return;
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
