// The network that a program joins, as Cyclone's configuration and as text for the log.
#pragma once

#include <cstdint>
#include <string>

#include "monitor/participant/dds_options.hpp"

namespace clearance {

// Cyclone's configuration for these options, as XML. Loopback carries a whole batch in one datagram
// of up to 65,000 B. All other networks get datagrams that fit an Ethernet frame. IP would fragment
// larger ones: every lost fragment costs the whole datagram, and holds the kernel's reassembly
// memory for 30 s. Measured with 10 % loss and reports above 14,720 B: of 16,000 reports, 2,984
// arrived with Cyclone's own sizes and 14,902 with these. Throws DdsError for a ROS 2 variable that
// counts and means nothing.
[[nodiscard]] std::string domain_configuration(const DdsOptions& options);

// Added to the number of a domain, it names a second one of this process that is the same on the
// wire: if another library has configured the domain, as rmw_cyclonedds does for ROS 2 nodes.
// Settings of CYCLONEDDS_URI for the number alone do not count there.
constexpr std::uint32_t kSecondDomain = 0x10000;
[[nodiscard]] std::string second_domain_configuration(const DdsOptions& options,
                                                      std::uint32_t domain);

// The number of the domain in messages: the one that this program calls `domain`, unless
// CYCLONEDDS_URI has an ExternalDomainId.
[[nodiscard]] std::uint32_t domain_on_the_wire(std::uint32_t domain);

// "domain 7, partition demo, interface lo, datagrams of up to 65000 B"
[[nodiscard]] std::string where_joined(const DdsOptions& options, const Domain& domain);
// Says how to start another program on the same network: the CYCLONEDDS_URI to copy.
[[nodiscard]] std::string how_to_reach(const DdsOptions& options, std::uint32_t domain);
[[nodiscard]] std::string describe_partition(const std::string& partition);

}  // namespace clearance
