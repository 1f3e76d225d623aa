// The command line of programs that use DDS: domain, partition and network. Also their exit code
// when DDS fails.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/app/command_line.hpp"
#include "monitor/app/program.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance {

// The four options of every DDS program. Without an option, the cell decides. ROS_DOMAIN_ID decides
// where neither states a domain.
struct DdsArguments {
  std::optional<std::uint32_t> domain;   // not given: the cell's
  std::optional<std::string> partition;  // not given: the cell's
  std::optional<std::string> interface;  // not given: the cell's
  std::vector<std::string> peers;

  // `has_cell` means that the program takes a cell, whose settings are the defaults.
  void add_to(CommandLine& line, bool has_cell = true);

  // The options: the command line first, then the cell if there is one.
  [[nodiscard]] DdsOptions resolve(const Cell& cell) const {
    return {.domain = domain ? domain : cell.domain,
            .partition = partition.value_or(cell.partition),
            .interface = interface.value_or(cell.interface),
            .peers = peers};
  }
  [[nodiscard]] DdsOptions resolve() const { return resolve(Cell{}); }
};

// The cell of a program that needs no more of it than its network and its topics; without a file,
// the default cell. Nothing, after errors on stderr, if the cell cannot be read.
[[nodiscard]] std::optional<Cell> cell_of_topics(const std::filesystem::path& cell);

// The exit code of a DDS program that ended with this exception.
[[nodiscard]] inline ExitCode dds_exit_code(const std::exception& error) {
  return dynamic_cast<const DdsError*>(&error) != nullptr ? kDdsFailed : kFailed;
}

}  // namespace clearance
