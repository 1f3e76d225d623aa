// Where on DDS a program is, and what is thrown when it cannot be there.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace clearance {

// Only programs of the same domain, partition and network see each other.
struct DdsOptions {
  std::uint32_t domain = 0;    // 0 to 232
  std::string partition = "";  // empty: the default one
  // Network interface; lo: this machine only; default: the one that Cyclone chooses for every
  // program that has no configuration.
  std::string interface = "lo";
  std::vector<std::string> peers = {};  // addresses to look for others at; for lo none are needed
};

// Says what was attempted, on what, and Cyclone's reason.
class DdsError : public std::runtime_error {
 public:
  DdsError(const std::string& attempted, dds_return_t code);
};

}  // namespace clearance
