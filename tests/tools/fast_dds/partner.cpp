// A partner on Fast DDS, the middleware that ROS 2 uses by default: it shares no code with Cyclone
// DDS or with us. It writes joint states and reads Clearance's messages for ROS 2, whose layouts
// are written down here once more, by hand, from the published definitions.
//
// usage: fast_dds_partner NETWORK DOMAIN PARTITION JOINT=POSITION...
//   NETWORK: lo; or what rmw_fastrtps asks of Fast DDS: subnet, localhost (of Jazzy), humble (its
//            ROS_LOCALHOST_ONLY=1)
//   PARTITION: may be empty, as ROS 2's is
// It prints one line of JSON for each message that it hears, until it is ended.
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/tools/fast_dds/wire_type.hpp"

namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using nlohmann::json;

template <class T>
T take(Cdr& cdr) {
  T value{};
  cdr.deserialize(value);
  return value;
}
// JSON has no infinities.
json number(Cdr& cdr) {
  const auto value = take<double>(cdr);
  return std::isfinite(value) ? json(value) : json(std::to_string(value));
}
json vector3(Cdr& cdr) {
  json all = json::array();
  for (int i = 0; i < 3; ++i) all.push_back(number(cdr));
  return all;
}

// clearance_msgs/PairDistance
json pair_distance(Cdr& cdr) {
  json out;
  for (const char* name : {"pair", "part_a", "part_b"}) out[name] = take<std::uint32_t>(cdr);
  out["status"] = take<std::uint8_t>(cdr);
  for (const char* name :
       {"distance", "lower", "upper", "swept_lower", "model_error", "stop_lower"})
    out[name] = number(cdr);
  for (const char* name : {"witness_a", "witness_b", "normal"}) out[name] = vector3(cdr);
  for (const char* name : {"closing_speed", "time_to_contact"}) out[name] = number(cdr);
  for (const char* name : {"age_a_ns", "age_b_ns"}) out[name] = take<std::int64_t>(cdr);
  for (const char* name : {"evaluated_cycle", "refresh_age_cycles"})
    out[name] = take<std::uint64_t>(cdr);
  return out;
}

// clearance_msgs/Distances
json distances(Cdr& cdr) {
  json out;
  for (const char* name : {"daemon", "cycle"}) out[name] = take<std::uint64_t>(cdr);
  for (const char* name : {"now_ns", "clock_offset_ns", "report_delay_ns", "newest_pose_ns",
                           "oldest_pose_ns", "publish_ns"})
    out[name] = take<std::int64_t>(cdr);
  out["scene_revision"] = take<std::uint64_t>(cdr);
  for (const char* name : {"minimum_known", "minimum_certified"}) out[name] = take<bool>(cdr);
  for (const char* name : {"lower_all", "swept_lower_all"}) out[name] = number(cdr);
  out["minimum"] = pair_distance(cdr);
  for (const char* name : {"pairs_total", "evaluated", "carried", "stale", "unknown", "queries"})
    out[name] = take<std::uint32_t>(cdr);
  out["oldest_evaluation_cycles"] = take<std::uint64_t>(cdr);
  out["sources"] = json::array();
  for (auto n = take<std::uint32_t>(cdr); n > 0; --n) {
    const auto source = take<std::string>(cdr);
    out["sources"].push_back({{"source", source}, {"sequence_number", take<std::uint64_t>(cdr)}});
  }
  out["pairs"] = json::array();
  for (auto n = take<std::uint32_t>(cdr); n > 0; --n) out["pairs"].push_back(pair_distance(cdr));
  out["contacts"] = take<std::uint32_t>(cdr);  // the number of them
  out["partner"] = take<std::string>(cdr);
  for (const char* field : {"lineage", "checksum", "state_checksum"})
    out[field] = take<std::uint64_t>(cdr);
  out["hidden"] = take<std::uint32_t>(cdr);  // the number of them: the cell has no sensors
  for (const char* field : {"changes_since", "delivery_checksum"})
    out[field] = take<std::uint64_t>(cdr);
  out["active_zones"] = json::array();
  for (auto n = take<std::uint32_t>(cdr); n > 0; --n)
    out["active_zones"].push_back(take<std::uint32_t>(cdr));
  out["period_ns"] = take<std::int64_t>(cdr);
  out["address"] = take<std::uint64_t>(cdr);
  out["source_contents"] = json::array();
  for (auto n = take<std::uint32_t>(cdr); n > 0; --n)
    out["source_contents"].push_back(take<std::uint64_t>(cdr));
  return out;
}

// clearance_msgs/ZoneStates
json zone_states(Cdr& cdr) {
  json out = json::array();
  for (auto n = take<std::uint32_t>(cdr); n > 0; --n) {
    json zone;
    zone["zone"] = take<std::uint32_t>(cdr);
    zone["daemon"] = take<std::uint64_t>(cdr);
    zone["name"] = take<std::string>(cdr);
    for (const char* name : {"active", "certified"}) zone[name] = take<bool>(cdr);
    zone["cause"] = take<std::uint8_t>(cdr);
    for (const char* name : {"cause_object", "pair"}) zone[name] = take<std::uint32_t>(cdr);
    for (const char* name : {"clearance", "swept_clearance"}) zone[name] = number(cdr);
    for (const char* name : {"since_cycle", "cycle"}) zone[name] = take<std::uint64_t>(cdr);
    zone["now_ns"] = take<std::int64_t>(cdr);
    for (const char* name : {"delivery_checksum", "address"}) zone[name] = take<std::uint64_t>(cdr);
    out.push_back(zone);
  }
  return out;
}

// diagnostic_msgs/DiagnosticArray
json diagnostics(Cdr& cdr) {
  json out;
  out["sec"] = take<std::int32_t>(cdr);
  out["nanosec"] = take<std::uint32_t>(cdr);
  out["frame_id"] = take<std::string>(cdr);
  out["status"] = json::array();
  for (auto n = take<std::uint32_t>(cdr); n > 0; --n) {
    json status;
    status["level"] = take<std::uint8_t>(cdr);
    for (const char* name : {"name", "message", "hardware_id"})
      status[name] = take<std::string>(cdr);
    status["values"] = json::object();
    for (auto k = take<std::uint32_t>(cdr); k > 0; --k) {
      const auto key = take<std::string>(cdr);
      status["values"][key] = take<std::string>(cdr);
    }
    out["status"].push_back(status);
  }
  return out;
}

// std_msgs/Float64
json float64(Cdr& cdr) { return number(cdr); }

struct Heard {
  const char *topic, *type;
  json (*read)(Cdr&);
  bool is_latched;
};
constexpr std::array kHeard = {
    Heard{"rt/clearance/distances", "clearance_msgs::msg::dds_::Distances_", distances, false},
    Heard{"rt/clearance/zones", "clearance_msgs::msg::dds_::ZoneStates_", zone_states, true},
    Heard{"rt/clearance/minimum_distance", "std_msgs::msg::dds_::Float64_", float64, false},
    Heard{"rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_", diagnostics, false}};

// sensor_msgs/JointState
Bytes joint_state(const std::vector<std::string>& names, const std::vector<double>& positions) {
  using namespace std::chrono;
  const auto now = duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
  Bytes bytes(4096);
  FastBuffer buffer(bytes.data(), bytes.size());
  Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, kCdr);
  cdr.serialize_encapsulation();
  cdr.serialize(static_cast<std::int32_t>(now / 1'000'000'000));
  cdr.serialize(static_cast<std::uint32_t>(now % 1'000'000'000));
  cdr.serialize(std::string());
  cdr.serialize(names);
  cdr.serialize(positions);
  cdr.serialize(std::vector<double>(positions.size(), 0.0));
  cdr.serialize(std::vector<double>());
  bytes.resize(length_of(cdr));
  return bytes;
}

// The datagrams and the shared memory that take the place of Fast DDS's own choice.
std::shared_ptr<Udp> use_own_transports(fdds::DomainParticipantQos& qos, bool shares_memory) {
  const auto udp = std::make_shared<Udp>();
  qos.transport().use_builtin_transports = false;
  if (shares_memory) qos.transport().user_transports.push_back(std::make_shared<SharedMemory>());
  qos.transport().user_transports.push_back(udp);
  return udp;
}

// On loopback only. The first ports of the domain are those of the other programs.
void join_loopback(fdds::DomainParticipantQos& qos, std::uint32_t domain) {
  use_own_transports(qos, false)->interfaceWhiteList.emplace_back("127.0.0.1");
  constexpr std::uint32_t kFirst = 7400, kOfADomain = 250, kUnicast = 10, kOfAProgram = 2;
  for (std::uint32_t i = 0; i < 20; ++i) {
    rtps::Locator_t peer(LOCATOR_KIND_UDPv4,
                         kFirst + kOfADomain * domain + kUnicast + kOfAProgram * i);
    rtps::IPLocator::setIPv4(peer, "127.0.0.1");
    qos.wire_protocol().builtin.initialPeersList.push_back(peer);
  }
}

// Jazzy's ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST. The locator without a kind stands for no
// multicast, the peer without a port for the first 32 programs of the domain.
void join_localhost(fdds::DomainParticipantQos& qos) {
  auto& discovery = qos.wire_protocol().builtin;
  discovery.metatrafficMulticastLocatorList.clear();
  discovery.metatrafficUnicastLocatorList.push_back(rtps::Locator_t());
  use_own_transports(qos, true)->maxInitialPeersRange = 32;
  rtps::Locator_t peer;
  rtps::IPLocator::setIPv4(peer, "127.0.0.1");
  discovery.initialPeersList.push_back(peer);
}

// Returns null for a network that is none.
fdds::DomainParticipant* join(const std::string& network, std::uint32_t domain) {
  fdds::DomainParticipantQos qos = fdds::PARTICIPANT_QOS_DEFAULT;
  if (network == "lo") {
    join_loopback(qos, domain);
  } else if (network == "localhost") {
    join_localhost(qos);
  } else if (network == "humble") {
    use_own_transports(qos, true)->interfaceWhiteList.emplace_back("127.0.0.1");
  } else if (network != "subnet") {
    return nullptr;
  }
  return fdds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
}

fdds::Topic* make_topic(fdds::DomainParticipant* participant, const char* name, const char* type) {
  fdds::TypeSupport(new WireType(type)).register_type(participant);
  return participant->create_topic(name, type, fdds::TOPIC_QOS_DEFAULT);
}

fdds::DataReader* make_reader(fdds::DomainParticipant* participant, const std::string& partition,
                              const Heard& of) {
  fdds::SubscriberQos subscriber = fdds::SUBSCRIBER_QOS_DEFAULT;
  if (!partition.empty()) subscriber.partition().push_back(partition.c_str());
  fdds::DataReaderQos qos = fdds::DATAREADER_QOS_DEFAULT;
  qos.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind =
      of.is_latched ? fdds::TRANSIENT_LOCAL_DURABILITY_QOS : fdds::VOLATILE_DURABILITY_QOS;
  qos.history().depth = 10;
  return participant->create_subscriber(subscriber)
      ->create_datareader(make_topic(participant, of.topic, of.type), qos);
}

fdds::DataWriter* make_writer(fdds::DomainParticipant* participant, const std::string& partition) {
  fdds::PublisherQos publisher = fdds::PUBLISHER_QOS_DEFAULT;
  if (!partition.empty()) publisher.partition().push_back(partition.c_str());
  fdds::DataWriterQos qos = fdds::DATAWRITER_QOS_DEFAULT;
  qos.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = fdds::VOLATILE_DURABILITY_QOS;
  return participant->create_publisher(publisher)->create_datawriter(
      make_topic(participant, "rt/joint_states", "sensor_msgs::msg::dds_::JointState_"), qos);
}

void print_new(fdds::DataReader* reader, const Heard& of) {
  Bytes bytes;
  fdds::SampleInfo info;
  while (reader->take_next_sample(&bytes, &info) == kOk) {
    if (!info.valid_data) continue;
    FastBuffer buffer(bytes.data(), bytes.size());
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, kCdr);
    json line{{"topic", of.topic}};
    try {
      cdr.read_encapsulation();
      line["message"] = of.read(cdr);
      line["left"] = bytes.size() - length_of(cdr);
    } catch (const eprosima::fastcdr::exception::Exception& error) {
      line["error"] = error.what();
    }
    std::printf("%s\n", line.dump().c_str());
  }
}

volatile std::sig_atomic_t ended = 0;

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  fdds::DomainParticipant* const participant =
      join(argv[1], static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10)));
  if (participant == nullptr) return 1;
  // Fast DDS removes its files of /dev/shm only as it leaves.
  std::signal(SIGTERM, [](int) { ended = 1; });
  const std::string partition = argv[3];
  std::vector<std::string> names;
  std::vector<double> positions;
  for (int i = 4; i < argc; ++i) {
    const std::string given = argv[i];
    const std::size_t value = given.find('=') + 1;
    names.push_back(given.substr(0, value - 1));
    positions.push_back(std::strtod(&given[value], nullptr));
  }
  std::vector<std::pair<fdds::DataReader*, const Heard*>> readers;
  for (const Heard& each : kHeard)
    readers.emplace_back(make_reader(participant, partition, each), &each);
  fdds::DataWriter* const writer = names.empty() ? nullptr : make_writer(participant, partition);
  while (ended == 0) {
    if (writer != nullptr) {
      Bytes bytes = joint_state(names, positions);
      writer->write(&bytes);
    }
    for (const auto& [reader, of] : readers) print_new(reader, *of);
    std::fflush(stdout);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  participant->delete_contained_entities();
  fdds::DomainParticipantFactory::get_instance()->delete_participant(participant);
}
