// The command line of programs that use DDS: domain, partition and network. Also their exit code
// when DDS fails.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/app/program.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance {

// The four options of every DDS program. Without an option, the cell decides. ROS_DOMAIN_ID decides
// where neither states a domain.
struct DdsArguments {
  std::optional<std::uint32_t> domain;   // not given: the cell's
  std::optional<std::string> partition;  // not given: the cell's
  std::optional<std::string> interface;  // not given: the cell's
  std::vector<std::string> peers;

  // `has_cell` means that the program takes a cell, whose settings are the defaults.
  void add_to(CLI::App& app, bool has_cell = true) {
    app.add_option("--domain", domain,
                   fmt::format("DDS domain; otherwise {}that of ROS_DOMAIN_ID, or 0",
                               has_cell ? "the cell's, " : ""))
        ->check(CLI::Range(0, 232));
    app.add_option("--partition", partition,
                   has_cell ? "DDS partition; otherwise the cell's, or the default one"
                            : "DDS partition; otherwise the default one")
        ->check([](const std::string& name) {
          return is_partition(name) ? std::string()
                                    : fmt::format(
                                          "found '{}'; expected a partition of at most 255 "
                                          "bytes without wildcards (* ? [)",
                                          name);
        });
    app.add_option(
        "--interface", interface,
        fmt::format("Network interface; lo stays on this machine, default is the network "
                    "of every program without a configuration; otherwise {}lo",
                    has_cell ? "the cell's, or " : ""));
    app.add_option("--peer", peers, "Address of another machine; repeatable")
        ->check([](const std::string& peer) {
          return can_be_looked_up(peer)
                     ? std::string()
                     : fmt::format("found '{}'; expected the address or the name of a machine",
                                   peer);
        });
  }

  // The options: the command line first, then the cell if there is one.
  [[nodiscard]] DdsOptions resolve(const Cell& cell) const {
    return {.domain = domain ? domain : cell.domain,
            .partition = partition.value_or(cell.partition),
            .interface = interface.value_or(cell.interface),
            .peers = peers};
  }
  [[nodiscard]] DdsOptions resolve() const { return resolve(Cell{}); }
};

// The exit code of a DDS program that ended with this exception.
[[nodiscard]] inline ExitCode dds_exit_code(const std::exception& error) {
  return dynamic_cast<const DdsError*>(&error) != nullptr ? kDdsFailed : kFailed;
}

}  // namespace clearance
