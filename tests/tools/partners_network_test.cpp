// Two daemons that are partners on two machines, and a link between them that is cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "monitor/client/client.hpp"
#include "tests/shared/random.hpp"
#include "tests/tools/lossy_network.hpp"
#include "tests/tools/meeting_boxes.hpp"
#include "tests/tools/one_leader.hpp"

namespace clearance {
namespace {

using test::ChildProcess;
using test::eventually;
using test::kDaemon;

// A link that is cut leaves a leader in each half. One of the two follows when the link is whole
// again.
TEST(PartnersOnANetwork, BothHalvesOfACutGoOnAndAgreeAfterwards) {
  test::NetworkNamespace one(1), other(2);
  for (const auto* machine : {&one, &other}) {
    if (!machine->refusal().empty()) GTEST_SKIP() << machine->refusal();
  }
  test::LossyWire wire(one.frames(), other.frames());
  const test::CellFile file(test::meeting_cell());
  const Cell cell = file.cell();
  DdsOptions dds = test::own_dds();
  const auto arguments = test::with(test::with({file.path()}, test::dds_arguments(dds)),
                                    {"--interface", "eth0", "--partner"});
  dds.interface = "eth0";
  std::optional<ChildProcess> left, right;
  std::optional<test::SendingRobot> robot;
  one.run([&] {
    robot.emplace(dds, cell);
    left.emplace(kDaemon, test::with(arguments, {"left"}));
  });
  ASSERT_TRUE(left->tells("partner-stands", {"leading"}));
  other.run([&] { right.emplace(kDaemon, test::with(arguments, {"right"})); });
  const auto agreements = [](const ChildProcess& daemon) {
    const std::string text = daemon.output();
    int count = 0;
    for (std::size_t at = 0; (at = text.find("[partner-agrees]", at)) != std::string::npos; ++at)
      ++count;
    return count;
  };
  ASSERT_TRUE(eventually([&] { return agreements(*left) > 0 && agreements(*right) > 0; }))
      << left->output() << right->output();
  wire.lose(1.0);
  ASSERT_TRUE(right->tells("partner-stands", {"leading"})) << right->output();
  const int before = agreements(*right);
  wire.lose(0.0);
  EXPECT_TRUE(eventually([&] { return agreements(*right) > before; }))
      << left->output() << right->output();
  for (auto* daemon : {&*left, &*right}) {
    daemon->signal(SIGTERM);
    EXPECT_EQ(daemon->wait(), 0) << daemon->output();
    EXPECT_FALSE(daemon->told("partner-differs")) << daemon->output();
  }
  one.run([&] { robot.reset(); });
}

// The campaign: CLEARANCE_CUTS=100. A client beside one of the two hears that one, whatever becomes
// of the link: it misses no cycle, and sees the zone as the reports have it. It never sees two
// daemons write at once what has one leader, but what the other half has written during the cut. A
// machine that cannot keep its rate counts less than the other one during a cut. The stream may
// then lose a period when both meet again.
TEST(PartnersOnANetwork, RandomCutsOfTheLinkLoseNoCycleAndForgetNoZone) {
  test::NetworkNamespace one(1), other(2);
  for (const auto* machine : {&one, &other}) {
    if (!machine->refusal().empty()) GTEST_SKIP() << machine->refusal();
  }
  test::LossyWire wire(one.frames(), other.frames());
  const test::CellFile file(test::meeting_cell());
  const Cell cell = file.cell();
  DdsOptions dds = test::own_dds();
  const auto arguments = test::with(test::with({file.path()}, test::dds_arguments(dds)),
                                    {"--interface", "eth0", "--gradients", "--partner"});
  dds.interface = "eth0";
  std::optional<ChildProcess> left, right;
  std::optional<test::SendingRobot> robot;
  const char* const asked = std::getenv("CLEARANCE_CUTS");
  const int cuts = asked == nullptr ? 2 : std::atoi(asked);
  test::OneLeader::Found leaders;
  int done = 0, missing = 0, late = 0, other_bits = 0, zones_wrong = 0, came = 0;
  one.run([&] {
    robot.emplace(dds, cell);
    left.emplace(kDaemon, test::with(arguments, {"left"}));
  });
  ASSERT_TRUE(left->tells("partner-stands", {"leading"}));
  other.run([&] { right.emplace(kDaemon, test::with(arguments, {"right"})); });
  one.run([&] {
    client::Connection connection(dds, cell.topics);
    test::OneLeader leads(connection.participant(), cell);
    client::Reports reports(connection);
    client::Catalogue catalogue(connection);
    client::Zones zones(connection);
    client::Pair boxes(catalogue, "left", "right");
    Random random(34);
    std::uint64_t lineage = 0, other_half = 0;
    std::vector<std::pair<std::int64_t, std::int64_t>> halves_ns;
    bool is_inside = false;
    int agreed = 0;
    const auto read_for = [&](double seconds, const auto& until) {
      const std::int64_t end = dds_time() + static_cast<std::int64_t>(1e9 * seconds);
      while (dds_time() < end) {
        if (!reports.next(std::chrono::milliseconds(50))) continue;
        ++came;
        leads.take();
        for (const auto& sender : reports.senders()) {
          if (sender.partner == "right") other_half = sender.daemon;
        }
        (reports->lineage == lineage ? missing : late) += static_cast<int>(reports.check().missed);
        lineage = reports->lineage;
        const auto state = reports.partner().state;
        other_bits +=
            state == client::PartnerState::kDifferent || state == client::PartnerState::kCorrupt;
        agreed = state == client::PartnerState::kAgrees ? agreed + 1 : 0;
        if (const auto* const pair = boxes.in(*reports)) {
          if (pair->swept_lower < 0.3) is_inside = true;
          if (pair->swept_lower > 0.35) is_inside = false;
          const bool is_decided = pair->swept_lower < 0.3 || pair->swept_lower > 0.35;
          zones_wrong += is_decided && (reports->active_zones._length > 0) != is_inside;
        }
        if (until()) return true;
      }
      return false;
    };
    const auto agree = [&] {
      agreed = 0;
      return read_for(20.0, [&] { return agreed > 20; });
    };
    for (; done < cuts; ++done) {
      if (!agree()) break;
      const auto zone_is_right = [&] {
        zones.update();
        return zones.states().contains(0) && zones.states().at(0).active == is_inside;
      };
      if (!read_for(5.0, zone_is_right)) ++zones_wrong;
      const std::int64_t cut_ns = dds_time();
      wire.lose(1.0);
      read_for(random.uniform(0.02, 0.6), [] { return false; });
      if (!read_for(5.0, zone_is_right)) ++zones_wrong;
      wire.lose(0.0);
      halves_ns.emplace_back(cut_ns, dds_time() + leader_lease_ns(0));
    }
    if (!agree()) --done;
    for (const auto& [from_ns, until_ns] : halves_ns)
      leads.leave_out(other_half, from_ns, until_ns);
    leaders = leads.found();
    leads.check();
  });
  std::printf(
      "%d cuts, %d reports, %d missing, %d periods lost where the halves had counted apart, %d "
      "with "
      "other bits, %d zones wrong; a plain reader saw %zu gradients, %d changes of the leader, %d "
      "of them soon, %d too soon, %d old samples\n",
      done, came, missing, late, other_bits, zones_wrong, leaders.samples, leaders.successions,
      leaders.soon, leaders.faults, leaders.old);
  EXPECT_EQ(done, cuts) << left->output() << right->output();
  EXPECT_EQ(missing, 0);
  EXPECT_EQ(other_bits, 0);
  EXPECT_EQ(zones_wrong, 0);
  EXPECT_GT(came, 0);
  EXPECT_GT(leaders.samples, 100u);
  one.run([&] { robot.reset(); });
}

}  // namespace
}  // namespace clearance
