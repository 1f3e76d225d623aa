// Cyclone reports endpoints as samples of a built-in topic, one instance for each endpoint.
#include "monitor/dds/present_topics.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <string_view>

#include "config/text/sentences.hpp"

namespace clearance {
namespace {

constexpr std::size_t kListed = 10;

std::string text_of(const dds_guid_t& guid) {
  std::string text;
  for (const std::uint8_t byte : guid.v) text += fmt::format("{:02x}", byte);
  return text;
}

// ROS 2 sets no partition. If there are several partitions, the first is shown.
std::string first_partition(const dds_qos_t* qos) {
  std::uint32_t count = 0;
  char** names = nullptr;
  if (!dds_qget_partition(qos, &count, &names)) return "";
  const std::string first = count > 0 ? names[0] : "";
  for (std::uint32_t i = 0; i < count; ++i) dds_free(names[i]);
  dds_free(names);
  return first;
}

bool is_latched(const dds_qos_t* qos) {
  dds_durability_kind_t kind = DDS_DURABILITY_VOLATILE;
  return dds_qget_durability(qos, &kind) && kind != DDS_DURABILITY_VOLATILE;
}

// True for topics that every node of ROS 2 publishes: services, parameters, its log.
bool is_of_ros_itself(std::string_view topic) {
  for (const std::string_view prefix : {"rq/", "rr/", "rs/"})
    if (topic.starts_with(prefix)) return true;
  return topic == "ros_discovery_info" || topic == "rt/rosout" || topic == "rt/parameter_events";
}

// The domain that a ROS 2 node started from the same shell would join.
std::string ros_domain() {
  const char* const id = std::getenv("ROS_DOMAIN_ID");
  return id == nullptr || *id == '\0' ? "" : fmt::format(" (ROS_DOMAIN_ID is {} here)", id);
}

PresentWriter writer_of(const dds_builtintopic_endpoint_t& endpoint) {
  return {.topic = endpoint.topic_name,
          .type = endpoint.type_name,
          .partition = first_partition(endpoint.qos),
          .participant = text_of(endpoint.participant_key),
          .is_latched = is_latched(endpoint.qos)};
}

}  // namespace

PresentTopics::PresentTopics(Participant& participant)
    : participant_(participant.handle()),
      reader_(check_dds(
          dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
          "making a reader of discovery")) {}

PresentTopics::~PresentTopics() { dds_delete(reader_); }

bool PresentTopics::poll() {
  dds_guid_t own{};
  dds_get_guid(participant_, &own);
  bool changed = false;
  for (;;) {
    void* sample = nullptr;
    dds_sample_info_t info;
    const dds_return_t count = dds_take(reader_, &sample, &info, 1, 1);
    if (count <= 0) return changed;
    const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(sample);
    const bool is_there = info.valid_data && info.instance_state == DDS_IST_ALIVE;
    if (is_there && std::memcmp(own.v, endpoint.participant_key.v, sizeof own.v) != 0) {
      changed = true;
      writers_[info.instance_handle] = writer_of(endpoint);
    } else if (!is_there) {
      changed = writers_.erase(info.instance_handle) > 0 || changed;
    }
    dds_return_loan(reader_, &sample, count);
  }
}

std::string PresentTopics::listed() const {
  std::map<std::string, std::size_t> counts;
  for (const auto& [handle, writer] : writers_) {
    if (!is_of_ros_itself(writer.topic)) ++counts[writer.topic];
  }
  if (writers_.empty()) return "no other program";
  if (counts.empty()) return "no topic but ROS 2's own";
  std::vector<std::string> topics;
  for (const auto& [topic, count] : counts) {
    topics.push_back(count > 1 ? fmt::format("{} ({} writers)", topic, count) : topic);
  }
  return clearance::listed(topics, kListed);
}

std::string PresentTopics::instead_on(const std::string& where) const {
  return fmt::format(
      "on {}; there is: {}. Nothing is heard across domains{}, networks (--interface; ros meets "
      "ROS 2 nodes, also those with ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST) or from an rmw that "
      "is no DDS (rmw_zenoh)",
      where, listed(), where.find("ROS_DOMAIN_ID") == std::string::npos ? ros_domain() : "");
}

}  // namespace clearance
