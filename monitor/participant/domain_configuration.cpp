// Configures Cyclone by text, since CYCLONEDDS_URI is text, too, and has the last word.
#include "monitor/participant/domain_configuration.hpp"

#include <fmt/format.h>

#include <ifaddrs.h>
#include <net/if.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <vector>

namespace clearance {
namespace {

// A reliable reader hands out samples in order: behind a lost one, newer ones wait. Cyclone's
// readers ask for the lost one only 100 ms later. That is longer than a deep history of a writer at
// 1 kHz keeps it, so everything arrives late by that history. This setting makes them ask at once.
constexpr const char* kAskAtOnce = "<NackDelay>0 ms</NackDelay>";

// All packets leave through one socket. Linux keeps up to 208 KiB for a machine that does not say
// where it is, for up to 3 s, in the send buffer, which has just that size by default: then no
// other reader is sent anything. This asks for more, and takes what net.core.wmem_max allows: by
// default twice as much.
constexpr const char* kSendBuffer = "<SocketSendBufferSize max=\"8 MiB\"/>";

// Cyclone's default allows 9 programs on a machine without multicast.
constexpr const char* kIndices =
    "<ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>100</MaxAutoParticipantIndex>";

// The card of every program without a configuration, and lo for programs that know only lo. Cyclone
// takes multicast from all cards unless each has it; Linux denies that lo has it, and carries it.
constexpr const char* kCardAndLo =
    "<NetworkInterface autodetermine=\"true\"/><NetworkInterface name=\"lo\" multicast=\"true\" "
    "priority=\"-1\"/>";
constexpr const char* kLo = "<NetworkInterface name=\"lo\"/>";

// The programs that are met, and the cards, in Cyclone's terms.
struct Network {
  std::string interfaces = {}, multicast = {};  // empty: Cyclone's choice
  std::vector<std::string> peers = {};
  std::string tag = {};  // only programs of one tag meet
};

// The largest sizes of a datagram, and of a fragment of a sample with its headers.
struct DatagramSizes {
  int message, fragment;
};

// True if a card other than lo is up and has an IPv4 address.
bool has_card() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return false;
  bool found = false;
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    found = found || (each->ifa_addr != nullptr && each->ifa_addr->sa_family == AF_INET &&
                      (each->ifa_flags & IFF_UP) != 0 && (each->ifa_flags & IFF_LOOPBACK) == 0);
  }
  freeifaddrs(first);
  return found;
}

// Listens on lo, too. Tried with Cyclone 0.10.2, Fast DDS 2.9 and the settings of Jazzy's and
// Humble's nodes: SUBNET meets SUBNET, LOCALHOST, ROS_LOCALHOST_ONLY=1 of either and programs on
// lo.
Network network_of_ros(const RosDiscovery& ros) {
  if (ros.range == RosRange::kSystemDefault) return {};
  if (ros.range == RosRange::kOff)
    return {.multicast = "false", .tag = fmt::format("ros_discovery_off_{}", getpid())};
  Network network{.interfaces = kLo, .multicast = "false", .peers = ros.static_peers};
  if (has_card()) {
    network.interfaces = kCardAndLo;
    if (ros.range == RosRange::kSubnet) network.multicast = "spdp";
  }
  network.peers.insert(network.peers.begin(), "127.0.0.1");
  return network;
}

Network network_of(const DdsOptions& options) {
  const std::string name = interface_of(options).name;
  Network network;
  if (name == "ros") {
    network = network_of_ros(ros_discovery());
  } else if (name == "default") {
    network.peers = {"127.0.0.1"};  // a node with LOCALHOST is met there, and not by multicast
  } else {
    network.interfaces = fmt::format("<NetworkInterface name=\"{}\"/>", name);
    network.multicast = name == "lo" ? "false" : "spdp";
    if (name == "lo") network.peers = {"127.0.0.1"};
  }
  network.peers.insert(network.peers.end(), options.peers.begin(), options.peers.end());
  return network;
}

// Omits empty elements: Cyclone accepts them, but a person has to read the text.
std::string element(const char* name, const std::string& content) {
  return content.empty() ? "" : fmt::format("<{0}>{1}</{0}>", name, content);
}

std::string general_xml(const Network& network) {
  return element("Interfaces", network.interfaces) + element("AllowMulticast", network.multicast);
}

std::string discovery_xml(const Network& network) {
  std::string peers;
  for (const std::string& peer : network.peers)
    peers += fmt::format("<Peer Address=\"{}\"/>", peer);
  return kIndices + element("Peers", peers) + element("Tag", network.tag);
}

// The person's own settings for Cyclone. They may be a text, or name a file.
std::string own_settings() {
  const char* const uri = std::getenv("CYCLONEDDS_URI");
  return uri == nullptr ? "" : uri;
}

// Returns those settings with the text of the files that they name. A comma ends the name of a
// file, and more settings may follow it.
std::string own_settings_with_files() {
  constexpr std::string_view kFile = "file://";
  const std::string settings = own_settings();
  std::string text = settings;
  for (std::size_t at = 0; (at = settings.find(kFile, at)) != std::string::npos;) {
    at += kFile.size();
    std::ifstream file(settings.substr(at, settings.find(',', at) - at));
    text.append(std::istreambuf_iterator<char>(file), {});
  }
  return text;
}

// True if those settings choose the cards: Cyclone adds up the cards of all settings, and refuses
// one that is named twice.
bool choose_cards() {
  return own_settings_with_files().find("NetworkInterface") != std::string::npos;
}

// Cyclone's default of 14,720 B cuts a batch of 100 poses in two on loopback, and needs ten IP
// fragments on a network.
DatagramSizes datagram_sizes(const DdsOptions& options) {
  return interface_of(options).name == "lo" ? DatagramSizes{.message = 65'000, .fragment = 64'000}
                                            : DatagramSizes{.message = 1'400, .fragment = 1'300};
}

std::string describe_interface(const Interface& interface) {
  if (interface.name == "default") return "as Cyclone chooses";
  if (interface.name != "ros") return interface.name;
  return fmt::format("ros (discovery range {}{})", name_of(ros_discovery().range),
                     interface.variable.empty() ? "" : ", as " + interface.variable + " is set");
}

// Says which programs need no configuration to reach it; empty if there are none.
std::string who_reaches(const DdsOptions& options) {
  const std::string name = interface_of(options).name;
  if (name == "default" && options.peers.empty()) {
    return "every program without a configuration reaches it, and ROS 2 nodes of this machine on "
           "rmw_cyclonedds or rmw_fastrtps with ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST; those of "
           "Humble on rmw_cyclonedds with ROS_LOCALHOST_ONLY=1 need --interface ros here";
  }
  if (name != "ros") return "";
  switch (ros_discovery().range) {
    case RosRange::kOff:
      return "ROS_AUTOMATIC_DISCOVERY_RANGE=OFF: no other program reaches it";
    case RosRange::kLocalhost:
      return "programs of this machine reach it with ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST, with "
             "ROS_LOCALHOST_ONLY=1 or with --interface lo; of ROS 2 nodes without these, those on "
             "rmw_fastrtps do, and those on rmw_cyclonedds need "
             "ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET here";
    case RosRange::kSubnet:
      return "every program without a configuration reaches it, and every ROS 2 node of this "
             "machine on rmw_cyclonedds or rmw_fastrtps unless it has "
             "ROS_AUTOMATIC_DISCOVERY_RANGE=OFF";
    case RosRange::kSystemDefault:
      return "every program without a configuration reaches it";
  }
  return "";
}

}  // namespace

std::string domain_configuration(const DdsOptions& options) {
  const DatagramSizes sizes = datagram_sizes(options);
  const std::string settings = own_settings();
  Network network = network_of(options);
  if (choose_cards()) network.interfaces.clear();
  std::string xml = fmt::format(
      "<CycloneDDS><Domain id=\"any\"><General>{}"
      "<MaxMessageSize>{}B</MaxMessageSize><FragmentSize>{}B</FragmentSize></General>"
      "{}{}</Domain></CycloneDDS>",
      general_xml(network), sizes.message, sizes.fragment,
      element("Discovery", discovery_xml(network)),
      element("Internal", std::string(kAskAtOnce) + kSendBuffer));
  return settings.empty() ? xml : xml + "," + settings;  // what comes last wins
}

std::string second_domain_configuration(const DdsOptions& options, std::uint32_t domain) {
  return fmt::format(
      "<CycloneDDS><Domain id=\"any\"><Discovery><ExternalDomainId>{}</ExternalDomainId>"
      "</Discovery></Domain></CycloneDDS>,{}",
      domain, domain_configuration(options));
}

std::string describe_partition(const std::string& partition) {
  return partition.empty() ? "default partition" : fmt::format("partition {}", partition);
}

std::uint32_t domain_on_the_wire(std::uint32_t domain) {
  constexpr std::string_view kElement = "<ExternalDomainId>";
  const std::string settings = own_settings_with_files();
  const std::size_t at = settings.rfind(kElement);
  domain %= kSecondDomain;
  if (at == std::string::npos) return domain;
  const char* const text = settings.data() + at + kElement.size();
  std::uint32_t stated = 0;
  return std::from_chars(text, settings.data() + settings.size(), stated).ec == std::errc{}
             ? stated
             : domain;
}

std::string where_joined(const DdsOptions& options, const Domain& domain) {
  return fmt::format("domain {}{}, {}, interface {}, datagrams of up to {} B{}", domain.id,
                     domain.is_of_ros ? " (of ROS_DOMAIN_ID)" : "",
                     describe_partition(options.partition),
                     describe_interface(interface_of(options)), datagram_sizes(options).message,
                     own_settings().empty() ? "" : ", then CYCLONEDDS_URI");
}

// Proposes settings without datagram sizes, which clients need not share. For our own programs, the
// name of the interface is enough.
std::string how_to_reach(const DdsOptions& options, std::uint32_t domain) {
  const std::string on = fmt::format("in domain {} (ROS_DOMAIN_ID)", domain);
  const std::string who = who_reaches(options);
  if (!options.partition.empty()) {
    return fmt::format("{} {}, in partition {}; ROS 2 nodes, which are in none, do not reach it",
                       who.empty() ? "programs with the same interface reach it" : who + ",", on,
                       options.partition);
  }
  if (!who.empty()) return fmt::format("{}, {}", who, on);
  const Network network = network_of(options);
  // Humble's nodes with ROS_LOCALHOST_ONLY=1 name lo themselves, and Cyclone refuses an interface
  // that is named twice. Fast DDS does not read the variable.
  const bool is_on_lo = interface_of(options).name == "lo";
  return fmt::format(
      "other programs reach it with CYCLONEDDS_URI='<CycloneDDS><Domain>{}{}</Domain></CycloneDDS>'"
      ", {}{}",
      element("General", general_xml(network)), element("Discovery", discovery_xml(network)), on,
      is_on_lo
          ? "; nodes of Humble with ROS_LOCALHOST_ONLY=1 reach it without this, and on "
            "rmw_cyclonedds terminate with it. No other node on rmw_fastrtps reaches it: start "
            "clearanced with --interface ros"
          : "");
}

}  // namespace clearance
