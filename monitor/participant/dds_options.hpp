// A program's domain, partition and network on DDS, and the exception if it cannot join them.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace clearance {

// Only programs of the same domain, partition and network find each other.
struct DdsOptions {
  // 0 to 232. If it is empty, the variable ROS_DOMAIN_ID states the domain, as for ROS 2 nodes. If
  // that is not set either, the domain is 0.
  std::optional<std::uint32_t> domain = {};
  std::string partition = "";  // empty: the default one
  // The network interface. "lo": this machine only; "default": the one that Cyclone chooses for
  // programs without a configuration.
  std::string interface = "lo";
  std::vector<std::string> peers = {};  // addresses of other machines; not needed for lo
};

struct Domain {
  std::uint32_t id = 0;
  bool is_of_ros = false;  // ROS_DOMAIN_ID states it
};
// Returns the domain that these options mean. Throws DdsError if it is above 232, or if the
// variable counts and is no such number.
[[nodiscard]] Domain domain_of(const DdsOptions& options);

// Says what was attempted, where, and Cyclone's reason; or what was found and expected.
class DdsError : public std::runtime_error {
 public:
  explicit DdsError(const std::string& text);
  DdsError(const std::string& attempted, dds_return_t code);
};

}  // namespace clearance
