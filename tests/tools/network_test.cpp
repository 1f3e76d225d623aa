// Two machines: reports above 20 kB on a network that loses one packet in ten, and programs that do
// not use this project's configuration.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>

#include "tests/tools/lossy_network.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance {
namespace {

using test::ChildProcess;
using test::eventually;

// Twenty boxes with all 190 pairs published: reports of 38 kB.
std::string crowded_cell() {
  std::string text = R"(
name: crowd
units: {length: m, angle: deg}
rate_hz: 200
defaults: {age_limit_ms: 10000, max_speed: 5}
objects:
)";
  for (int i = 0; i < 20; ++i) {
    text +=
        "  - {name: box" + std::to_string(i) + ", groups: [all], box: {size: [0.2, 0.2, 0.2]}}\n";
  }
  return text + "pairs:\n  - {between: [all, all], publish: true}\n";
}

// The number of IP fragments created in the calling thread's namespace since its start.
std::uint64_t fragments_created() {
  std::ifstream file("/proc/thread-self/net/snmp");
  std::string names, values, name, value;
  while (std::getline(file, names) && std::getline(file, values)) {
    std::istringstream name_stream(names), value_stream(values);
    while (name_stream >> name && value_stream >> value) {
      if (name == "FragCreates") return std::stoull(value);
    }
  }
  ADD_FAILURE() << "no FragCreates in /proc/net/snmp";
  return 0;
}

// Parses "123 reports in 2.0 s, 4 missed".
std::pair<std::uint64_t, std::uint64_t> came_and_missed(const std::string& summary) {
  std::smatch found;
  if (!std::regex_search(summary, found, std::regex("(\\d+) reports in .* s, (\\d+) missed")))
    return {0, 0};
  return {std::stoull(found[1]), std::stoull(found[2])};
}

TEST(Network, LargeReportsAreNeverIpFragmentsAndSurviveLoss) {
  test::NetworkNamespace robot(1), panel(2);
  for (const auto* machine : {&robot, &panel}) {
    if (!machine->refusal().empty()) GTEST_SKIP() << machine->refusal();
  }
  test::LossyWire wire(robot.frames(), panel.frames());
  const test::CellFile cell(crowded_cell());
  const auto arguments = test::with(test::dds_arguments(test::own_dds()), {"--interface", "eth0"});
  std::optional<ChildProcess> daemon, watch;
  robot.run([&] { daemon.emplace(test::kDaemon, test::with({cell.path()}, arguments)); });
  panel.run([&] { watch.emplace(test::kWatch, test::with({"--plain"}, arguments)); });
  ASSERT_TRUE(eventually([&] { return watch->wrote("cycle "); }))
      << daemon->output() << watch->output();
  EXPECT_TRUE(daemon->told("started", {"interface eth0", "1400 B"})) << daemon->output();

  wire.lose(0.1);
  const std::uint64_t before = wire.frames();
  EXPECT_TRUE(eventually([&] { return wire.frames() > before + 10'000; }));
  wire.lose(0.0);
  watch->signal(SIGTERM);
  EXPECT_EQ(watch->wait(), 0);
  const auto [came, missed] = came_and_missed(watch->output());
  EXPECT_GT(came, missed) << watch->output();
  RecordProperty("came", std::to_string(came));
  RecordProperty("missed", std::to_string(missed));
  robot.run([] { EXPECT_EQ(fragments_created(), 0u); });
  EXPECT_EQ(wire.ip_fragments(), 0u);
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
}

// A participant with Cyclone's default configuration on another machine.
bool hears_health_by_default(std::uint32_t domain) {
  const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
  EXPECT_GT(participant, 0);
  const dds_entity_t of = dds_create_topic(participant, &clearance_msg_Health_desc,
                                           "clearance/health", nullptr, nullptr);
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  const dds_entity_t reader = dds_create_reader(participant, of, qos, nullptr);
  dds_delete_qos(qos);
  Sample<clearance_msg_Health> health;
  void* pointer = &*health;
  dds_sample_info_t info{};
  const bool came =
      eventually([&] { return dds_take(reader, &pointer, &info, 1, 1) == 1 && info.valid_data; });
  dds_delete(participant);
  return came;
}

TEST(Network, OfEveryProgramWithoutAConfigurationIsTheDefaultInterface) {
  test::NetworkNamespace robot(1), panel(2);
  for (const auto* machine : {&robot, &panel}) {
    if (!machine->refusal().empty()) GTEST_SKIP() << machine->refusal();
  }
  test::LossyWire wire(robot.frames(), panel.frames());
  const test::CellFile cell(test::small_cell("default"));
  constexpr std::uint32_t kDomain = 117;  // a domain that nothing in this process has configured
  std::optional<ChildProcess> daemon;
  robot.run([&] {
    daemon.emplace(test::kDaemon, std::vector<std::string>{cell.path(), "--interface", "default",
                                                           "--domain", std::to_string(kDomain)});
  });
  bool came = false;
  panel.run([&] { came = hears_health_by_default(kDomain); });
  EXPECT_TRUE(came) << daemon->output();
  EXPECT_TRUE(daemon->told("how-to-reach", {"every program without a configuration"}))
      << daemon->output();
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
}

// The variable contains a tag here. Only programs with the same tag communicate.
TEST(Network, OfCyclonesOwnVariableIsJoined) {
  const test::CellFile cell(test::small_cell("variable"));
  const auto arguments = test::dds_arguments(test::own_dds());
  const test::ChildOptions tagged{
      .environment = {{"CYCLONEDDS_URI", "<CycloneDDS><Domain><Discovery><Tag>clearance-test-" +
                                             std::to_string(getpid()) +
                                             "</Tag></Discovery></Domain></CycloneDDS>"}}};
  ChildProcess daemon(test::kDaemon, test::with({cell.path()}, arguments), tagged);
  ChildProcess stranger(test::kWatch, test::with({"--plain"}, arguments));
  ChildProcess friendly(test::kWatch, test::with({"--plain"}, arguments), tagged);
  EXPECT_TRUE(eventually([&] { return friendly.wrote("cycle "); }))
      << daemon.output() << friendly.output();
  EXPECT_FALSE(stranger.wrote("cycle ")) << stranger.output();
  EXPECT_TRUE(daemon.told("started", {", then CYCLONEDDS_URI"})) << daemon.output();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
}

}  // namespace
}  // namespace clearance
