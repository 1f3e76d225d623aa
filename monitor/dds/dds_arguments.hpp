// The command-line options by which every program says where on DDS it is.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "config/scene.hpp"
#include "monitor/dds/participant.hpp"

namespace clearance {

struct DdsArguments {
  std::optional<std::uint32_t> domain;   // not given: the cell's
  std::optional<std::string> partition;  // not given: the cell's
  DdsOptions options;

  // `has_cell`: the program takes a cell, which says what is not given.
  void add_to(CLI::App& app, bool has_cell = true) {
    app.add_option("--domain", domain,
                   has_cell ? "DDS domain; otherwise the cell's, or 0" : "DDS domain; otherwise 0")
        ->check(CLI::Range(0, 232));
    app.add_option("--partition", partition,
                   has_cell ? "DDS partition; otherwise the cell's, or the default one"
                            : "DDS partition; otherwise the default one")
        ->check([](const std::string& name) {
          return is_partition(name) ? std::string()
                                    : "found '" + name +
                                          "'; expected a partition of at most 255 bytes without "
                                          "wildcards (* ? [)";
        });
    app.add_option("--interface", options.interface,
                   "Network interface; lo keeps everything on this machine")
        ->capture_default_str();
    app.add_option("--peer", options.peers, "Address of another machine to look for; repeatable")
        ->check([](const std::string& peer) {
          return can_be_looked_up(peer)
                     ? std::string()
                     : "found '" + peer + "'; expected the address or the name of a machine";
        });
  }

  [[nodiscard]] DdsOptions resolve(std::uint32_t cell_domain,
                                   const std::string& cell_partition) const {
    DdsOptions resolved = options;
    resolved.domain = domain.value_or(cell_domain);
    resolved.partition = partition.value_or(cell_partition);
    return resolved;
  }
};

// "--log-level" with its six values.
inline void add_log_level(CLI::App& app, std::string& level) {
  app.add_option("--log-level", level, "trace, debug, info, warn, error or off")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
}

}  // namespace clearance
