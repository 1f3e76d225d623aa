#include "monitor/participant/ros_node.hpp"

#include <algorithm>
#include <utility>

#include "monitor/participant/dds_options.hpp"
#include "ros2.h"

namespace clearance {
namespace {

using Gid = rmw_dds_common_msg_dds__Gid_;

// Returns the ids of endpoints that exist, and erases the others.
std::vector<Gid> ids_of(std::vector<dds_entity_t>& endpoints) {
  std::vector<Gid> ids;
  std::erase_if(endpoints, [&](dds_entity_t endpoint) {
    dds_guid_t guid;
    if (dds_get_guid(endpoint, &guid) != DDS_RETCODE_OK) return true;
    std::ranges::copy(guid.v, ids.emplace_back().data);
    return false;
  });
  return ids;
}

template <class Sequence>
void point_to(Sequence& sequence, std::vector<Gid>& ids) {
  sequence._buffer = ids.data();
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(ids.size());
}

}  // namespace

RosNode::RosNode(dds_entity_t participant, std::string name,
                 std::function<dds_entity_t()> make_writer)
    : participant_(participant), name_(std::move(name)), make_writer_(std::move(make_writer)) {}

void RosNode::add(std::vector<dds_entity_t> RosNode::*to, dds_entity_t endpoint) {
  const Lock lock(mutex_);
  (this->*to).push_back(endpoint);
  try {
    if (const auto make = std::exchange(make_writer_, nullptr)) writer_ = make();
  } catch (const DdsError&) {
  }
  if (writer_ <= 0) return;
  std::vector<Gid> readers = ids_of(readers_), writers = ids_of(writers_);
  rmw_dds_common_msg_dds__NodeEntitiesInfo_ node{};
  node.node_namespace[0] = '/';
  name_.copy(node.node_name, sizeof node.node_name - 1);
  point_to(node.reader_gid_seq, readers);
  point_to(node.writer_gid_seq, writers);
  rmw_dds_common_msg_dds__ParticipantEntitiesInfo_ message{};
  dds_guid_t own;
  dds_get_guid(participant_, &own);
  std::ranges::copy(own.v, message.gid.data);
  message.node_entities_info_seq = {
      ._maximum = 1, ._length = 1, ._buffer = &node, ._release = false};
  dds_write(writer_, &message);
}

std::string ros_node_name(const std::vector<std::string>& parts) {
  std::string name;
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    if (!name.empty()) name += '_';
    for (const char each : part) {
      const bool is_of_ascii = (each >= 'a' && each <= 'z') || (each >= 'A' && each <= 'Z') ||
                               (each >= '0' && each <= '9');
      name += is_of_ascii ? each : '_';
    }
  }
  return name;
}

}  // namespace clearance
