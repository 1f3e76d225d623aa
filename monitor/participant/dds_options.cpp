#include "monitor/participant/dds_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <netdb.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <sstream>

namespace clearance {
namespace {

constexpr std::uint32_t kMaxDomain = 232;  // ports: 7400 + 250 * domain

// The names of RosRange, in its order.
constexpr std::array<std::string_view, 4> kRanges{"OFF", "LOCALHOST", "SUBNET", "SYSTEM_DEFAULT"};

// An empty variable counts as not set, as for ROS 2 nodes.
std::string variable(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? "" : text;
}

// "HOST", "HOST:PORT", "[V6]:PORT" or "V6".
std::string host_of(const std::string& peer) {
  if (peer.starts_with('[')) return peer.substr(1, peer.find(']') - 1);
  const bool has_port = std::count(peer.begin(), peer.end(), ':') == 1;
  return has_port ? peer.substr(0, peer.find(':')) : peer;
}

RosRange range_of(const std::string& text) {
  if (text.empty()) return RosRange::kSubnet;
  const auto* const found = std::ranges::find(kRanges, text);
  if (found != kRanges.end()) return static_cast<RosRange>(found - kRanges.begin());
  throw DdsError(
      fmt::format("DDS: found ROS_AUTOMATIC_DISCOVERY_RANGE='{}'; expected one of {}. --interface "
                  "with another value than ros overrides it",
                  text, fmt::join(kRanges, ", ")));
}

}  // namespace

std::string_view name_of(RosRange range) noexcept {
  return kRanges[static_cast<std::size_t>(range)];
}

bool can_be_looked_up(const std::string& peer) {
  addrinfo* found = nullptr;
  if (getaddrinfo(host_of(peer).c_str(), nullptr, nullptr, &found) != 0) return false;
  freeaddrinfo(found);
  return true;
}

Interface interface_of(const DdsOptions& options) {
  if (!options.interface.empty()) return {.name = options.interface};
  for (const char* name :
       {"ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY", "ROS_STATIC_PEERS", "ROS_DISTRO"}) {
    if (!variable(name).empty()) return {.name = "ros", .variable = name};
  }
  return {.name = "lo"};
}

RosDiscovery ros_discovery() {
  if (variable("ROS_LOCALHOST_ONLY") == "1") return {.range = RosRange::kLocalhost};
  RosDiscovery ros{.range = range_of(variable("ROS_AUTOMATIC_DISCOVERY_RANGE"))};
  if (ros.range == RosRange::kOff || ros.range == RosRange::kSystemDefault) return ros;
  std::istringstream peers(variable("ROS_STATIC_PEERS"));
  for (std::string peer; std::getline(peers, peer, ';');) {
    if (peer.empty()) continue;
    if (!can_be_looked_up(peer)) {
      throw DdsError(fmt::format(
          "DDS: found '{}' in ROS_STATIC_PEERS; expected the address or the name of a machine",
          peer));
    }
    ros.static_peers.push_back(peer);
  }
  return ros;
}

// ROS 2's distributions are named in alphabetical order. Noetic is of ROS 1, and says nothing of
// nodes of ROS 2.
std::string why_no_ros_node() {
  const std::string distribution = variable("ROS_DISTRO");
  if (distribution.empty()) return "ROS_DISTRO is not set";
  if (distribution >= "iron" && distribution != "noetic") return "";
  return fmt::format("ROS_DISTRO is {}, and nodes before Iron misread what it would send",
                     distribution);
}

// A stated domain wins, so that a variable that is meant for ROS 2 does not move a cell that states
// one.
Domain domain_of(const DdsOptions& options) {
  if (options.domain > kMaxDomain) {
    throw DdsError(fmt::format("joining domain {} (0 to 232 exist)", *options.domain),
                   DDS_RETCODE_BAD_PARAMETER);
  }
  const std::string text = variable("ROS_DOMAIN_ID");
  if (options.domain || text.empty()) return {.id = options.domain.value_or(0)};
  const char* const end = text.data() + text.size();
  Domain domain{.is_of_ros = true};
  const auto [rest, fault] = std::from_chars(text.data(), end, domain.id);
  if (fault == std::errc() && rest == end && domain.id <= kMaxDomain) return domain;
  throw DdsError(
      fmt::format("DDS: found ROS_DOMAIN_ID='{}'; expected a domain, 0 to {}. A domain that an "
                  "option or the cell states overrides it",
                  text, kMaxDomain));
}

DdsError::DdsError(const std::string& text) : std::runtime_error(text) {}

DdsError::DdsError(const std::string& attempted, dds_return_t code)
    : std::runtime_error(fmt::format("DDS: {} failed: {}", attempted, dds_strretcode(code))) {}

}  // namespace clearance
