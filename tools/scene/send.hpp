// clearance-scene send: changes the scene of a running daemon.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "monitor/dds/dds_arguments.hpp"

namespace clearance {

struct SendArguments {
  std::string changes;              // a file, or "-" for stdin; empty: none
  std::vector<std::string> change;  // changes in YAML
  std::string client = "clearance-scene";
  std::vector<std::filesystem::path> files;  // that changes name as "sent:NAME"
  bool dry_run = false;
  double timeout_s = 10.0;     // for each result
  std::string back;            // a file with changes that take CHANGES back
  std::uint64_t repeats = 0;   // 0: once, and no latency
  std::filesystem::path cell;  // that names the topics; empty: none
  DdsArguments dds;
};

[[nodiscard]] CommandLine send_line(SendArguments& arguments);

// Returns the exit code. Throws DdsError.
[[nodiscard]] int send_changes(const SendArguments& arguments);

}  // namespace clearance
