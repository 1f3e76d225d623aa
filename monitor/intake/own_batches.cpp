#include "monitor/intake/own_batches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

std::optional<Decoder::Wanted> wanted(const TopicName& name, const std::string& ours,
                                      TopicKind kind) {
  const bool is_it = name.name == ours && name.type == topic(kind).type->m_typename;
  return is_it ? std::optional(Decoder::Wanted{}) : std::nullopt;
}

}  // namespace

std::optional<Decoder::Wanted> OwnPoses::wants(const TopicName& topic) {
  return wanted(topic, topic_, TopicKind::kPoses);
}

// Empty for the scenes of most cells, which read all.
void OwnPoses::note_unread(const Scene& scene) {
  revision_ = scene.revision;
  is_unread_.clear();
  if (std::ranges::all_of(scene.objects, &Object::is_read)) return;
  for (const Object& object : scene.objects) is_unread_.push_back(!object.is_read);
}

bool OwnPoses::decode(std::uint32_t, const RawMessage& message, const Now&, TopicCounts&) {
  if (!decoder_.decode(message.cdr, message_, message.bytes)) return false;
  const std::size_t sent = message_->poses._length;
  message_->poses._length = static_cast<std::uint32_t>(std::min(sent, most_));
  from_wire(*message_, batch_);
  if (!is_unread_.empty() && (batch_.scene_revision == 0 || batch_.scene_revision == revision_)) {
    std::erase_if(batch_.samples, [this](const PoseSample& sample) {
      return sample.object < is_unread_.size() && is_unread_[sample.object];
    });
  }
  out_.give(batch_, message.writer, sent - message_->poses._length);
  return true;
}

std::optional<Decoder::Wanted> OwnJointStates::wants(const TopicName& topic) {
  return wanted(topic, topic_, TopicKind::kJointStates);
}

bool OwnJointStates::decode(std::uint32_t, const RawMessage& message, const Now&, TopicCounts&) {
  if (!decoder_.decode(message.cdr, message_, message.bytes)) return false;
  from_wire(*message_, names_, batch_);
  note_unknown();
  const std::size_t used = std::min(batch_.joints.size(), most_);
  const std::size_t cut = batch_.joints.size() - used;
  batch_.joints.resize(used);
  out_.give(batch_, message.writer, cut);
  return true;
}

// The tick refuses such a joint without its name, which it does not know.
void OwnJointStates::note_unknown() {
  std::string added;
  for (std::uint32_t i = 0; i < message_->names._length; ++i) {
    const std::string_view name = message_->names._buffer[i];
    if (names_.find(name) != JointNames::kUnknown || unknown_names_.contains(name)) continue;
    if (unknown_names_.size() >= kMostUnknownNames) break;
    unknown_names_.emplace(name);
    added += (added.empty() ? "" : ", ") + std::string(name);
  }
  if (added.empty()) return;
  out_.tell(News(lines::kUnknownJoints, batch_.source.view(), added));
}

PoseBatch* OwnBatches::decode(TopicKind kind, std::span<const std::byte> cdr) {
  given_ = nullptr;
  TopicCounts counts;
  Decoder& decoder = kind == TopicKind::kPoses ? static_cast<Decoder&>(poses_) : joint_states_;
  static_cast<void>(decoder.decode(0, {.cdr = cdr}, {}, counts));
  return given_;
}

}  // namespace clearance
