// Programs that meet the daemon on one machine and on two. The daemon has ROS 2's variables, and
// they have the settings that rmw_cyclonedds and rmw_fastrtps make of them. Each machine is a
// network namespace.
#include <gtest/gtest.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "monitor/participant/domain_configuration.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/lossy_network.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance {
namespace {

using test::ChildProcess;
using test::eventually;
using Variables = std::vector<std::pair<std::string, std::string>>;
using Arguments = std::vector<std::string>;
const Arguments kNoArguments;

const std::string kFastDds = test::places::programs() + "/fast_dds_partner";

// A domain that nothing else in this process configures.
constexpr std::uint32_t kDomain = 118;

std::string domain(const std::string& settings) {
  return "<CycloneDDS><Domain>" + settings + "</Domain></CycloneDDS>";
}

const std::string kIndices =
    "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32"
    "</MaxAutoParticipantIndex>";
const std::string kNoMulticast = "<General><AllowMulticast>false</AllowMulticast></General>";

// The settings of nodes on rmw_cyclonedds, Jazzy's and Humble's.
const std::string kSubnet = domain("<Discovery>" + kIndices + "</Discovery>");
const std::string kLocalhost = domain(kNoMulticast + "<Discovery>" + kIndices +
                                      "<Peers><Peer address=\"localhost\"/></Peers></Discovery>");
const std::string kHumble = domain("");
const std::string kHumbleLocalhost =
    domain("<General><Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces></General>");
// A node that finds no other, and has to be found.
const std::string kSilent = domain(kNoMulticast + "<Discovery>" + kIndices + "</Discovery>");

// True if a program with these settings hears the daemon's health.
bool hears_health(const std::string& settings) {
  const dds_entity_t joined = dds_create_domain(kDomain, settings.c_str());
  const dds_entity_t participant = dds_create_participant(kDomain, nullptr, nullptr);
  EXPECT_GT(participant, 0) << settings;
  const dds_entity_t of = dds_create_topic(participant, &clearance_msg_Health_desc,
                                           "clearance/health", nullptr, nullptr);
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  const dds_entity_t reader = dds_create_reader(participant, of, qos, nullptr);
  dds_delete_qos(qos);
  Sample<clearance_msg_Health> health;
  const bool came = eventually([&] { return test::take_next(reader, health); });
  dds_delete(participant);
  dds_delete(joined);
  return came;
}

// A daemon on one of two machines.
class RosDiscoveryNetwork : public testing::Test {
 protected:
  void SetUp() override {
    for (const auto* machine : {&here, &there}) {
      if (!machine->refusal().empty()) GTEST_SKIP() << machine->refusal();
    }
    wire.emplace(here.frames(), there.frames());
    test::write_text(folder / "scara.urdf", test::kScaraUrdf);
    test::write_text(
        folder / "cell.yaml",
        "name: ros\nunits: {length: m, angle: rad}\nrate_hz: 50\n"
        "robots: [{name: arm, urdf: scara.urdf, age_limit_ms: 1000}]\n"
        "objects: [{name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}]\n"
        "pairs: [{between: [arm, wall]}]\nros2: {minimum_distance: true}\n");
  }
  void start(const Variables& variables, const Arguments& arguments = {}) {
    here.run([&] {
      daemon.emplace(
          test::kDaemon,
          test::with({folder / "cell.yaml", "--domain", std::to_string(kDomain)}, arguments),
          test::ChildOptions{.environment = variables});
    });
    ASSERT_TRUE(daemon->tells("how-to-reach")) << daemon->output();
  }
  static bool hears(test::NetworkNamespace& machine, const std::string& settings) {
    bool came = false;
    machine.run([&] { came = hears_health(settings); });
    return came;
  }
  // True if the positions that a node on Fast DDS sends reach the daemon, and the distance that
  // follows from them reaches the node. The wall is 2.95 m from the finger before it is pushed out.
  bool meets_fast_dds(test::NetworkNamespace& machine, const std::string& network) {
    const double pushed = 0.01 * ++nodes;
    std::optional<ChildProcess> node;
    machine.run([&] {
      node.emplace(kFastDds,
                   std::vector<std::string>{network, std::to_string(kDomain), "", "shoulder=0",
                                            "elbow=0", "push=" + std::to_string(pushed)});
    });
    const bool met = eventually([&] {
      const std::string output = node->output(), before = "\"message\":";
      const std::size_t at = output.rfind(before);
      if (at == std::string::npos) return false;
      return std::abs(std::atof(&output[at + before.size()]) - (2.95 - pushed)) < 1e-9;
    });
    node->signal(SIGTERM);
    node->wait();
    return met;
  }
  // The settings that the daemon's second line proposes.
  [[nodiscard]] std::string proposed() const {
    const std::string text = daemon->output(), before = "CYCLONEDDS_URI='";
    const std::size_t begin = text.find(before);
    if (begin == std::string::npos) return "";
    return text.substr(begin + before.size(),
                       text.find('\'', begin + before.size()) - begin - before.size());
  }

  test::NetworkNamespace here{1}, there{2};
  std::optional<test::LossyWire> wire;
  test::ScratchFolder folder;
  std::optional<ChildProcess> daemon;
  int nodes = 0;  // on Fast DDS, so far
};

TEST_F(RosDiscoveryNetwork, WhereRosIsSetUpTheDaemonMeetsEveryNodeOfItsMachine) {
  start({{"ROS_DISTRO", "jazzy"}});
  for (const std::string& node : {kSubnet, kLocalhost, kHumble, kHumbleLocalhost})
    EXPECT_TRUE(hears(here, node)) << node << '\n' << daemon->output();
  EXPECT_TRUE(hears(there, kSubnet)) << daemon->output();
  EXPECT_TRUE(hears(here, domain_configuration({.interface = "lo"}))) << "a client elsewhere on lo";
  EXPECT_TRUE(daemon->tells("how-to-reach",
                            {"every ROS 2 node of this machine on rmw_cyclonedds or rmw_fastrtps"}))
      << daemon->output();
}

TEST_F(RosDiscoveryNetwork, BesideHumbleTheDaemonMeetsNodesAndSaysThatItIsNone) {
  start({{"ROS_DISTRO", "humble"}});
  EXPECT_TRUE(hears(here, kHumbleLocalhost)) << daemon->output();
  EXPECT_TRUE(daemon->tells("how-to-reach", {"not a node of ROS 2: ROS_DISTRO is humble, "}))
      << daemon->output();
}

TEST_F(RosDiscoveryNetwork, TheVariablesForThisMachineMeanWhatTheyMeanForNodes) {
  for (const Variables& variables : {Variables{{"ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST"}},
                                     Variables{{"ROS_LOCALHOST_ONLY", "1"}}}) {
    start(variables);
    for (const std::string& node : {kLocalhost, kHumbleLocalhost})
      EXPECT_TRUE(hears(here, node)) << node << '\n' << daemon->output();
    EXPECT_TRUE(daemon->tells("how-to-reach", {"programs of this machine reach it with"}))
        << daemon->output();
  }
}

// Fast DDS listens on all cards, so that SUBNET is met where LOCALHOST is asked for, too.
TEST_F(RosDiscoveryNetwork, NodesOnFastDdsAreMetOnEveryInterfaceButLo) {
  if (!std::filesystem::exists(kFastDds)) GTEST_SKIP() << "Fast DDS is not installed";
  start({{"ROS_DISTRO", "jazzy"}});
  EXPECT_TRUE(meets_fast_dds(there, "subnet")) << daemon->output();
  for (const auto& [variables, arguments] :
       {std::pair(Variables{{"ROS_DISTRO", "jazzy"}}, kNoArguments),
        std::pair(Variables{{"ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST"}}, kNoArguments),
        std::pair(Variables{}, Arguments{"--interface", "default"})}) {
    start(variables, arguments);
    for (const char* node : {"subnet", "localhost", "humble"})
      EXPECT_TRUE(meets_fast_dds(here, node)) << node << '\n' << daemon->output();
  }
}

TEST_F(RosDiscoveryNetwork, ADaemonOnLoMeetsANodeOfHumbleOnFastDds) {
  if (!std::filesystem::exists(kFastDds)) GTEST_SKIP() << "Fast DDS is not installed";
  start({});
  EXPECT_TRUE(meets_fast_dds(here, "humble")) << daemon->output();
  EXPECT_TRUE(daemon->tells(
      "how-to-reach",
      {"No other node on rmw_fastrtps reaches it: start clearanced with --interface ros"}))
      << daemon->output();
}

TEST_F(RosDiscoveryNetwork, StaticPeersAreFoundOnAnotherMachine) {
  start({{"ROS_STATIC_PEERS", "10.77.0.2"}});
  EXPECT_TRUE(hears(there, kSilent)) << daemon->output();
}

TEST_F(RosDiscoveryNetwork, ClientsReadTheVariablesToo) {
  start({{"ROS_DISTRO", "jazzy"}});
  for (const auto& [machine, variables] :
       {std::pair(&there, Variables{{"ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET"}}),
        std::pair(&here, Variables{{"ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST"}})}) {
    std::optional<ChildProcess> watch, record;
    machine->run([&] {
      const Arguments of_domain{"--domain", std::to_string(kDomain)};
      const test::ChildOptions options{.environment = variables};
      watch.emplace(test::kWatch, test::with(of_domain, {"--plain"}), options);
      const std::string recording = folder / (variables.front().second + ".mcap");
      record.emplace(test::kRecord,
                     test::with(of_domain, {"--seconds", "2", "--output", recording}), options);
    });
    EXPECT_TRUE(eventually([&] { return watch->wrote("cycle "); })) << watch->output();
    EXPECT_EQ(record->wait(), 0) << record->output();
  }
}

TEST_F(RosDiscoveryNetwork, TheDefaultInterfaceMeetsNodesOfThisMachineThatUseNoMulticast) {
  start({}, {"--interface", "default"});
  for (const std::string& node : {kSubnet, kLocalhost})
    EXPECT_TRUE(hears(here, node)) << node << '\n' << daemon->output();
}

// rmw_cyclonedds puts its own settings before those of the variable.
TEST_F(RosDiscoveryNetwork, TheProposedSettingsReachADaemonOnLoopback) {
  start({});
  for (const std::string& node : {kSubnet, kLocalhost, kHumble})
    EXPECT_TRUE(hears(here, node + "," + proposed())) << proposed();
  EXPECT_TRUE(hears(here, kHumbleLocalhost)) << "without them";
  here.run([&] {
    EXPECT_LT(dds_create_domain(kDomain, (kHumbleLocalhost + "," + proposed()).c_str()), 0);
  });
  EXPECT_TRUE(daemon->tells("how-to-reach", {"Humble with ROS_LOCALHOST_ONLY=1 reach it without "
                                             "this, and on rmw_cyclonedds terminate with it"}))
      << daemon->output();
}

TEST_F(RosDiscoveryNetwork, CyclonesOwnVariableMayNameTheCardOfRos) {
  start({{"ROS_DISTRO", "jazzy"},
         {"CYCLONEDDS_URI", domain("<General><Interfaces><NetworkInterface name=\"eth0\"/>"
                                   "</Interfaces></General>")}});
  EXPECT_TRUE(hears(here, kSubnet)) << daemon->output();
}

TEST_F(RosDiscoveryNetwork, AMachineWithoutACardHasItsLoopback) {
  here.run([] {
    ifreq card{};
    std::strncpy(card.ifr_name, "eth0", IFNAMSIZ - 1);
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    EXPECT_EQ(ioctl(socket, SIOCSIFFLAGS, &card), 0) << "without IFF_UP";
    close(socket);
  });
  start({{"ROS_DISTRO", "jazzy"}});
  for (const std::string& node : {kSubnet, kLocalhost, kHumbleLocalhost})
    EXPECT_TRUE(hears(here, node)) << node << '\n' << daemon->output();
}

}  // namespace
}  // namespace clearance
