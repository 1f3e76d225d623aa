// The configuration of Cyclone.
#include "monitor/participant/participant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/shared/loopback.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Participant, SendsWholeBatchesAsOneDatagramOnLoopback) {
  const std::string xml = domain_configuration({.interface = "lo"});
  EXPECT_THAT(xml, HasSubstr("<MaxMessageSize>65000B</MaxMessageSize>"));
  EXPECT_THAT(xml, HasSubstr("<FragmentSize>64000B</FragmentSize>"));
}

TEST(Participant, SendsNothingThatIpWouldCutOnANetwork) {
  const std::string xml = domain_configuration({.interface = "eth0", .peers = {"10.0.0.2"}});
  EXPECT_THAT(xml, HasSubstr("<NetworkInterface name=\"eth0\"/>"));
  EXPECT_THAT(xml, HasSubstr("<MaxMessageSize>1400B</MaxMessageSize>"));
  EXPECT_THAT(xml, HasSubstr("<FragmentSize>1300B</FragmentSize>"));
  EXPECT_THAT(xml, HasSubstr("<Peer Address=\"10.0.0.2\"/>"));
  EXPECT_THAT(xml, Not(HasSubstr("127.0.0.1")));
}

TEST(Participant, LeavesTheLastWordToCyclonesOwnVariable) {
  ::setenv("CYCLONEDDS_URI", "<General><MaxMessageSize>9000B</MaxMessageSize></General>", 1);
  const std::string xml = domain_configuration({.interface = "eth0"});
  ::unsetenv("CYCLONEDDS_URI");
  EXPECT_GT(xml.find("9000B"), xml.find("1400B"));
  EXPECT_LT(xml.find("9000B"), xml.size());
}

TEST(Participant, SaysHowLargeItsDatagramsAre) {
  const Participant participant(test::own_dds());
  EXPECT_THAT(participant.where(), HasSubstr("interface lo, datagrams of up to 65000 B"));
}

}  // namespace
}  // namespace clearance
