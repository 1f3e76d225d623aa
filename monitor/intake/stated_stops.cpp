#include "monitor/intake/stated_stops.hpp"

#include <algorithm>

#include "monitor/inputs/input_record.hpp"

namespace clearance {
namespace {

constexpr std::string_view kType = "std_msgs/msg/Bool";

}  // namespace

bool StatedStops::is_named(const std::string& topic) const {
  return std::ranges::any_of(scene_->robots, [&](const Robot& robot) {
    return !topic.empty() && robot.stopping.stated_on == topic;
  });
}

std::optional<Decoder::Wanted> StatedStops::wants(const TopicName& topic) {
  if (topic.type != kType || !is_named(topic.name)) return std::nullopt;
  const auto known = std::ranges::find(topics_, topic.name, &Topic::name);
  const Wanted wanted{static_cast<std::uint32_t>(known - topics_.begin()), &kRosBool};
  if (known == topics_.end()) {
    topics_.push_back({topic.name, {}});
    out_.tell(News(lines::kTopicHeard, "stated stops", ros_dds_name(topic.name)));
  }
  return wanted;
}

std::vector<NamedTopic> StatedStops::named() const {
  std::vector<NamedTopic> named;
  for (const Robot& robot : scene_->robots) {
    const std::string& topic = robot.stopping.stated_on;
    if (!topic.empty() && std::ranges::find(named, topic, &NamedTopic::name) == named.end())
      named.push_back({topic, &kRosBool});
  }
  return named;
}

void StatedStops::keep(std::span<const std::uint64_t> writers) {
  for (Topic& topic : topics_) {
    std::erase_if(topic.of_writers, [&](const auto& statement) {
      return !std::ranges::binary_search(writers, statement.first);
    });
  }
}

std::int64_t StatedStops::age_limit_ns(const std::string& topic) const {
  std::int64_t limit = kAnyAge;
  for (const JointVariable& variable : scene_->variables)
    if (scene_->robots[variable.robot].stopping.stated_on == topic)
      limit = std::min(limit, variable.age_limit_ns);
  return limit;
}

// After a gap, the brakes may have been released meanwhile: they act since the end of the gap. The
// clock of the writer may be ahead.
bool StatedStops::decode(std::uint32_t port, const RawMessage& message, const Now& now,
                         TopicCounts&) {
  if (!decoder_.decode(message.cdr, message_, message.bytes)) return false;
  Topic& topic = topics_[port];
  Statement& statement = topic.of_writers[message.writer];
  const std::int64_t sent_ns = std::min(message.sent_ns, now.realtime_ns);
  const bool goes_on = statement.is_stopping && sent_ns >= statement.last_ns &&
                       sent_ns - statement.last_ns <= age_limit_ns(topic.name);
  if (!goes_on) statement.since_ns = sent_ns;
  statement.last_ns = sent_ns;
  statement.is_stopping = message_->data;
  return true;
}

bool StatedStops::is_stopping(std::uint32_t variable, std::int64_t stamp_ns, const Now& now) const {
  const JointVariable& of = scene_->variables[variable];
  const auto topic =
      std::ranges::find(topics_, scene_->robots[of.robot].stopping.stated_on, &Topic::name);
  if (topic == topics_.end()) return false;
  bool is_stated = false;
  for (const auto& [writer, statement] : topic->of_writers) {
    const std::int64_t age_ns = now.realtime_ns - statement.last_ns;
    if (age_ns < 0 || age_ns > of.age_limit_ns) continue;  // below 0: the clock was set back
    if (!statement.is_stopping || statement.since_ns > stamp_ns) return false;
    is_stated = true;
  }
  return is_stated;
}

}  // namespace clearance
