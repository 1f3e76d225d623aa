// A program's domain, partition and network on DDS, and the exception if it cannot join them.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace clearance {

// Only programs of the same domain, partition and network find each other.
struct DdsOptions {
  // 0 to 232. If it is empty, the variable ROS_DOMAIN_ID states the domain, as for ROS 2 nodes. If
  // that is not set either, the domain is 0.
  std::optional<std::uint32_t> domain = {};
  std::string partition = "";  // empty: the default one
  // The network interface. "lo": this machine only; "default": the one that Cyclone chooses for
  // programs without a configuration; "ros": what ROS 2's variables mean for a node. Empty: as
  // interface_of() says.
  std::string interface = {};
  std::vector<std::string> peers = {};  // addresses of other machines; not needed for lo
};

struct Domain {
  std::uint32_t id = 0;
  bool is_of_ros = false;  // ROS_DOMAIN_ID states it
};
// Returns the domain that these options mean. Throws DdsError if it is above 232, or if the
// variable counts and is no such number.
[[nodiscard]] Domain domain_of(const DdsOptions& options);

// True when a peer, "HOST" or "HOST:PORT", is an address or a name that this machine can look up.
[[nodiscard]] bool can_be_looked_up(const std::string& peer);

// A network interface, and the variable that decided for "ros", if one did.
struct Interface {
  std::string name, variable = {};
};
// Returns the interface that these options mean. If they state none, it is "ros" where ROS 2 is set
// up: ROS_DISTRO, ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_LOCALHOST_ONLY or ROS_STATIC_PEERS is set.
// Elsewhere it is "lo".
[[nodiscard]] Interface interface_of(const DdsOptions& options);

// The nodes that a ROS 2 node looks for, as ROS_AUTOMATIC_DISCOVERY_RANGE says.
enum class RosRange { kOff, kLocalhost, kSubnet, kSystemDefault };
[[nodiscard]] std::string_view name_of(RosRange range) noexcept;
struct RosDiscovery {
  RosRange range = RosRange::kSubnet;
  std::vector<std::string> static_peers = {};
};
// Reads ROS 2's variables like Jazzy's nodes: ROS_LOCALHOST_ONLY=1 goes before the other two.
// Throws DdsError where a node would only warn: at an unknown range, or a peer that cannot be
// looked up.
[[nodiscard]] RosDiscovery ros_discovery();

// Returns why this program must not be a node of ROS 2; empty: it may. Up to
// Humble, an id in this message has 24 bytes instead of 16, under the same name of the type: nodes
// misread the rest, and end or use up memory. ROS_DISTRO says which nodes there are.
[[nodiscard]] std::string why_no_ros_node();

// Says what was attempted, where, and Cyclone's reason; or what was found and expected.
class DdsError : public std::runtime_error {
 public:
  explicit DdsError(const std::string& text);
  DdsError(const std::string& attempted, dds_return_t code);
};

}  // namespace clearance
