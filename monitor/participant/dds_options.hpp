// A program's domain, partition and network on DDS, and the exception if it cannot join them.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace clearance {

// Only programs of the same domain, partition and network find each other.
struct DdsOptions {
  std::uint32_t domain = 0;    // 0 to 232
  std::string partition = "";  // empty: the default one
  // The network interface. "lo": this machine only; "default": the one that Cyclone chooses for
  // programs without a configuration.
  std::string interface = "lo";
  std::vector<std::string> peers = {};  // addresses of other machines; not needed for lo
};

// Says what was attempted, where, and Cyclone's reason.
class DdsError : public std::runtime_error {
 public:
  DdsError(const std::string& attempted, dds_return_t code);
};

}  // namespace clearance
