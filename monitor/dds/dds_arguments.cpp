#include "monitor/dds/dds_arguments.hpp"

#include <fmt/format.h>

#include "monitor/app/options.hpp"

namespace clearance {

void DdsArguments::add_to(CommandLine& line, bool has_cell) {
  line.add({
      {"--domain", &domain,
       fmt::format("DDS domain; otherwise {}that of ROS_DOMAIN_ID, or 0",
                   has_cell ? "the cell's, " : ""),
       whole_number_in(0, 232)},
      {"--partition", &partition,
       fmt::format("DDS partition; otherwise {}the default one", has_cell ? "the cell's, or " : ""),
       expecting("a partition of at most 255 bytes without wildcards (* ? [)", is_partition)},
      {"--interface", &interface,
       fmt::format("Network interface; lo stays on this machine, default is the network of every "
                   "program without a configuration, ros that of ROS 2's variables (idl/ROS.md); "
                   "otherwise {}ros where ROS 2 is set up, else lo",
                   has_cell ? "the cell's, " : "")},
      {"--peer",
       &peers,
       "Address of another machine; repeatable",
       expecting("the address or the name of a machine", can_be_looked_up),
       {.takes_all = true}},
  });
}

std::optional<Cell> cell_of_topics(const std::filesystem::path& cell) {
  if (cell.empty()) return Cell{};
  return cell_or_errors(read_cell(cell, told_on_stderr()));
}

}  // namespace clearance
