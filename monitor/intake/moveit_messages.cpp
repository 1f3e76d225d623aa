#include "monitor/intake/moveit_messages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>

#include "monitor/wire/moveit_types.hpp"

namespace clearance {
namespace {

using Type = moveit::RawScene::Type;

// A row an input: the port is its place.
struct Input {
  std::string MoveItInputs::*topic;
  std::string_view type;
  const RosType* delivery;
  Type of;
};
constexpr std::array<Input, 3> kInputs = {{
    {&MoveItInputs::collision_object, "moveit_msgs/msg/CollisionObject", &kRosCollisionObject,
     Type::kCollisionObject},
    {&MoveItInputs::attached_collision_object, "moveit_msgs/msg/AttachedCollisionObject",
     &kRosAttachedCollisionObject, Type::kAttachedCollisionObject},
    {&MoveItInputs::planning_scene, "moveit_msgs/msg/PlanningScene", &kRosPlanningScene,
     Type::kPlanningScene},
}};

}  // namespace

MoveItMessages::MoveItMessages(const Cell& cell, Use use, bool is_log, Outlet& out)
    : inputs_(&cell.ros.moveit),
      use_(std::move(use)),
      out_(out),
      waits_(!is_log && !named().empty()) {}

std::optional<Decoder::Wanted> MoveItMessages::wants(const TopicName& topic) {
  for (std::uint32_t port = 0; port < kInputs.size(); ++port) {
    const Input& input = kInputs[port];
    if (topic.type != input.type || topic.name != inputs_->*input.topic) continue;
    out_.tell(use_ ? News(lines::kTopicHeard, "the scene of MoveIt", topic.name)
                   : News(lines::kTopicNotUsed, topic.name));
    if (!use_) return std::nullopt;
    waits_ = false;
    return Wanted{port, input.delivery};
  }
  return std::nullopt;
}

std::vector<NamedTopic> MoveItMessages::named() const {
  std::vector<NamedTopic> named;
  for (const Input& input : kInputs) {
    const std::string& topic = inputs_->*input.topic;
    if (use_ && !topic.empty()) named.push_back({topic, input.delivery});
  }
  return named;
}

bool MoveItMessages::decode(std::uint32_t port, const RawMessage& message, const Now&,
                            TopicCounts&) {
  const Input& input = kInputs[port];
  use_({input.of,
        inputs_->*input.topic,
        {message.cdr.begin(), message.cdr.end()},
        message.bytes,
        message.sent_ns});
  return true;
}

void MoveItMessages::settle(const Now& now) {
  if (!waits_) return;
  if (since_ns_ < 0) since_ns_ = now.monotonic_ns;
  if (now.monotonic_ns - since_ns_ < kMissingNs) return;
  waits_ = false;
  std::vector<std::string> topics;
  for (const NamedTopic& each : named()) topics.push_back(each.name);
  out_.tell(News(
      lines::kMoveItSilent,
      fmt::format("there is no publisher of {} with a type of MoveIt", fmt::join(topics, " or "))));
}

std::int64_t MoveItMessages::patience_ns() const {
  return waits_ ? kMissingNs / 10 : Decoder::patience_ns();
}

}  // namespace clearance
