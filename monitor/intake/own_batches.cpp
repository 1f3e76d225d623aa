#include "monitor/intake/own_batches.hpp"

#include <algorithm>

#include "monitor/wire/convert.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance {
namespace {

std::optional<Decoder::Wanted> wanted(const TopicName& name, TopicKind kind, const Scene& scene) {
  const bool is_it =
      name.name == scene.topics.*topic(kind).name && name.type == topic(kind).type->m_typename;
  return is_it ? std::optional(Decoder::Wanted{}) : std::nullopt;
}

}  // namespace

std::optional<Decoder::Wanted> OwnPoses::wants(const TopicName& topic) {
  return wanted(topic, TopicKind::kPoses, scene_);
}

bool OwnPoses::decode(std::uint32_t, const RawMessage& message, const Now&, TopicCounts&) {
  if (!decoder_.decode(message.cdr, message_)) return false;
  const std::size_t sent = message_->poses._length;
  message_->poses._length = static_cast<std::uint32_t>(std::min(sent, most_));
  from_wire(*message_, batch_);
  out_.give(batch_, message.writer, sent - message_->poses._length);
  return true;
}

std::optional<Decoder::Wanted> OwnJointStates::wants(const TopicName& topic) {
  return wanted(topic, TopicKind::kJointStates, scene_);
}

bool OwnJointStates::decode(std::uint32_t, const RawMessage& message, const Now&, TopicCounts&) {
  if (!decoder_.decode(message.cdr, message_)) return false;
  from_wire(*message_, names_, batch_);
  const std::size_t used = std::min(batch_.joints.size(), most_);
  const std::size_t cut = batch_.joints.size() - used;
  batch_.joints.resize(used);
  out_.give(batch_, message.writer, cut);
  return true;
}

}  // namespace clearance
