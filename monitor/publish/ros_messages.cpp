#include "monitor/publish/ros_messages.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace clearance {
namespace {

template <class Ours, class Theirs>
constexpr bool kSameLayout = sizeof(Ours) == sizeof(Theirs) && alignof(Ours) == alignof(Theirs);
static_assert(kSameLayout<clearance_msg_Catalogue, clearance_msgs_msg_dds__Catalogue_>);
static_assert(kSameLayout<clearance_msg_Distances, clearance_msgs_msg_dds__Distances_>);
static_assert(kSameLayout<clearance_msg_ZoneState, clearance_msgs_msg_dds__ZoneState_>);
static_assert(kSameLayout<clearance_msg_Health, clearance_msgs_msg_dds__Health_>);
static_assert(kSameLayout<clearance_msg_Separation, clearance_msgs_msg_dds__Separation_>);
static_assert(kSameLayout<clearance_msg_Gradients, clearance_msgs_msg_dds__Gradients_>);
static_assert(kRosMessageTypes.size() == kRosMessages.size());

bool is_latched(TopicKind kind) noexcept { return topic(kind).delivery == Delivery::kLatched; }

bool has_reader(dds_entity_t writer) {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer, &status);
  return status.current_count > 0;
}

}  // namespace

RosMessages::RosMessages(const Cell& cell, Participant& participant) {
  const std::string& space = cell.ros.outputs.messages;
  if (space.empty()) return;
  for (const RosMessage& message : kRosMessageTypes) {
    const std::string name = space + "/" + std::string(topic(message.kind).key);
    writers_[index(message.kind)] = participant.ros_writer(message.type, ros_dds_name(name));
  }
}

void RosMessages::published(TopicKind kind, const void* sample) {
  const dds_entity_t to = writer(kind);
  if (to == 0) return;
  if (kind == TopicKind::kZones) {
    const auto& state = *static_cast<const clearance_msg_ZoneState*>(sample);
    zones_[state.zone] = state;
    zones_changed_ = true;
    return;
  }
  // All states of a cell follow its catalogue.
  if (kind == TopicKind::kCatalogue) {
    zones_.clear();
    zones_changed_ = true;
  }
  if (is_latched(kind) || has_reader(to)) writes_.write(to, sample);
}

void RosMessages::report_ended() {
  const dds_entity_t to = writer(TopicKind::kZones);
  if (to == 0 || !zones_changed_) return;
  zones_changed_ = false;
  clearance_msgs_msg_dds__ZoneStates_ states{};
  std::vector<clearance_msg_ZoneState> known;
  for (const auto& [zone, state] : zones_) known.push_back(state);
  states.zones._length = states.zones._maximum = static_cast<std::uint32_t>(known.size());
  states.zones._buffer = reinterpret_cast<clearance_msgs_msg_dds__ZoneState_*>(known.data());
  writes_.write(to, &states);
}

}  // namespace clearance
