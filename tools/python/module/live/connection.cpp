// clearance.Connection: monitor/client/client.hpp.
#include "tools/python/module/live/connection.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <utility>

#include "config/cell/share_topics.hpp"
#include "config/cell/shares.hpp"
#include "tools/python/module/cell.hpp"
#include "tools/python/module/live/live.hpp"

namespace clearance::python {

SharedConnection connection_of(const SharedConnection& given) {
  if (given) return given;
  const Unlocked unlock;
  return std::make_shared<client::Connection>();
}

void add_connection(py::module_& module) {
  py::class_<client::Connection, SharedConnection>(module, "Connection",
                                                   R"(A daemon's domain, partition and network.)")
      .def(py::init([](const std::shared_ptr<CellObject>& cell, std::optional<std::uint32_t> domain,
                       std::optional<std::string> partition, std::optional<std::string> interface,
                       std::vector<std::string> peers, const std::optional<std::string>& share) {
             DdsOptions options;
             Topics topics;
             if (cell) {
               const Cell& of = cell->cell();
               options = {of.domain, of.partition, of.interface};
               topics = of.topics;
             }
             if (domain) options.domain = domain;
             options.partition = partition.value_or(options.partition);
             options.interface = interface.value_or(options.interface);
             options.peers = std::move(peers);
             if (options.domain > 232u) throw py::value_error("domain: expected 0 to 232");
             if (!is_partition(options.partition))
               throw py::value_error("partition: expected at most 255 bytes without wildcards");
             if (share && (share->empty() || share->size() > kMaxShareName))
               throw py::value_error("share: expected a name of 1 to 32 bytes");
             if (share) topics = topics_of_share(topics, *share);
             const Unlocked unlock;
             return std::make_shared<client::Connection>(options, topics);
           }),
           py::arg("cell") = py::none(), py::kw_only(), py::arg("domain") = py::none(),
           py::arg("partition") = py::none(), py::arg("interface") = py::none(),
           py::arg("peers") = std::vector<std::string>(), py::arg("share") = py::none(),
           R"(cell: a Cell, whose domain, partition, network and topics are used. Without it: the
default partition, the domain of ROS_DOMAIN_ID or 0, and "ros" where ROS 2 is set up, else loopback. A cell that
states none has these, too. The other arguments replace these. interface: a network card, "lo", "default" or "ros". peers: addresses of other
machines. share: of a cell in shares, whose reports, names and commands are meant; poses and joints go to
all shares.

Raises DdsError if DDS cannot be joined.)")
      .def_property_readonly("where", &client::Connection::where, "For messages: domain 7, ...");
}

}  // namespace clearance::python
