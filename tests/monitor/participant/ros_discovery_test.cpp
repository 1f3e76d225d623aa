// What ROS 2's variables mean for discovery. tests/tools/ros_discovery_test.cpp has who meets whom.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <optional>
#include <string>

#include "monitor/participant/domain_configuration.hpp"

namespace clearance {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class RosDiscoveryTest : public testing::Test {
 protected:
  RosDiscoveryTest() {
    for (const char* name : {"ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY",
                             "ROS_STATIC_PEERS", "ROS_DISTRO", "CYCLONEDDS_URI"}) {
      const char* const text = std::getenv(name);
      before_[name] = text == nullptr ? std::nullopt : std::optional<std::string>(text);
      ::unsetenv(name);
    }
  }
  ~RosDiscoveryTest() override {
    for (const auto& [name, text] : before_)
      text ? ::setenv(name.c_str(), text->c_str(), 1) : ::unsetenv(name.c_str());
  }
  static void set(const char* name, const char* text) { ::setenv(name, text, 1); }
  static std::string refusal() {
    try {
      (void)ros_discovery();
    } catch (const DdsError& error) {
      return error.what();
    }
    return "";
  }

 private:
  std::map<std::string, std::optional<std::string>> before_;
};

TEST_F(RosDiscoveryTest, IsUsedWhereRosIsSetUpAndNoInterfaceIsStated) {
  EXPECT_EQ(interface_of({}).name, "lo");
  ::setenv("ROS_DOMAIN_ID", "77", 1);
  EXPECT_EQ(interface_of({}).name, "lo") << "a domain alone says nothing of networks";
  ::unsetenv("ROS_DOMAIN_ID");
  for (const char* name :
       {"ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY", "ROS_STATIC_PEERS", "ROS_DISTRO"}) {
    set(name, "0");
    EXPECT_EQ(interface_of({}).name, "ros") << name;
    EXPECT_EQ(interface_of({}).variable, name);
    EXPECT_EQ(interface_of({.interface = "lo"}).name, "lo") << name;
    set(name, "");
    EXPECT_EQ(interface_of({}).name, "lo") << name;
  }
}

TEST_F(RosDiscoveryTest, ReadsTheVariablesAsNodesOfJazzyDo) {
  EXPECT_EQ(ros_discovery().range, RosRange::kSubnet);
  set("ROS_STATIC_PEERS", "127.0.0.1;;127.0.0.2");
  EXPECT_THAT(ros_discovery().static_peers, ElementsAre("127.0.0.1", "127.0.0.2"));
  set("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST");
  EXPECT_EQ(ros_discovery().range, RosRange::kLocalhost);
  EXPECT_THAT(ros_discovery().static_peers, ElementsAre("127.0.0.1", "127.0.0.2"));
  for (const char* name : {"OFF", "SYSTEM_DEFAULT"}) {
    set("ROS_AUTOMATIC_DISCOVERY_RANGE", name);
    EXPECT_EQ(name_of(ros_discovery().range), name);
    EXPECT_THAT(ros_discovery().static_peers, IsEmpty()) << name;
  }
  set("ROS_LOCALHOST_ONLY", "1");
  EXPECT_EQ(ros_discovery().range, RosRange::kLocalhost) << "it goes before the range";
  EXPECT_THAT(ros_discovery().static_peers, IsEmpty());
  set("ROS_LOCALHOST_ONLY", "0");
  EXPECT_EQ(ros_discovery().range, RosRange::kSystemDefault);
}

TEST_F(RosDiscoveryTest, RefusesWhatANodeWouldOnlyWarnOf) {
  set("ROS_AUTOMATIC_DISCOVERY_RANGE", "localhost");
  EXPECT_THAT(refusal(), HasSubstr("found ROS_AUTOMATIC_DISCOVERY_RANGE='localhost'; expected one "
                                   "of OFF, LOCALHOST, SUBNET, SYSTEM_DEFAULT"));
  set("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET");
  set("ROS_STATIC_PEERS", "no machine");
  EXPECT_THAT(refusal(), HasSubstr("found 'no machine' in ROS_STATIC_PEERS; expected the address"));
}

TEST_F(RosDiscoveryTest, OffIsATagThatNoOtherProgramHas) {
  set("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF");
  EXPECT_THAT(domain_configuration({.interface = "ros"}), HasSubstr("<Tag>ros_discovery_off_"));
  EXPECT_THAT(how_to_reach({.interface = "ros"}, 7), HasSubstr("OFF: no other program reaches it"));
}

TEST_F(RosDiscoveryTest, TheLineSaysWhatThoseNeedWhoDoNotReachIt) {
  EXPECT_THAT(how_to_reach({.interface = "default"}, 7),
              HasSubstr("with ROS_LOCALHOST_ONLY=1 need --interface ros here"));
  set("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST");
  EXPECT_THAT(how_to_reach({.interface = "ros"}, 7),
              HasSubstr("those on rmw_cyclonedds need ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET here"));
}

// Cyclone adds up the cards of all settings, and refuses one that is named twice.
TEST_F(RosDiscoveryTest, LeavesTheCardsToCyclonesOwnVariableIfThatNamesSome) {
  set("CYCLONEDDS_URI",
      "<General><NetworkInterfaceAddress>eth1</NetworkInterfaceAddress></General>");
  for (const char* name : {"ros", "lo", "eth0"}) {
    EXPECT_THAT(domain_configuration({.interface = name}), Not(HasSubstr("<Interfaces>"))) << name;
  }
  set("CYCLONEDDS_URI", "<General><Transport>udp</Transport></General>");
  EXPECT_THAT(domain_configuration({.interface = "lo"}), HasSubstr("<Interfaces>"));
}

TEST_F(RosDiscoveryTest, IsToldWithWhatDecidedForIt) {
  set("ROS_DISTRO", "jazzy");
  EXPECT_THAT(where_joined({}, {.id = 7}),
              HasSubstr("interface ros (discovery range SUBNET, as ROS_DISTRO is set), datagrams"));
  EXPECT_THAT(where_joined({.interface = "ros"}, {.id = 7}),
              HasSubstr("interface ros (discovery range SUBNET), datagrams"));
}

}  // namespace
}  // namespace clearance
