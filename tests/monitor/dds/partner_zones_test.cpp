// The latched states of one of two partners while it ticks apart. The test acts as the tick thread.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

#include "monitor/client/client.hpp"
#include "monitor/publish/report_writer.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/monitor/loop/listed_ports.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/logged.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/sealed.hpp"

namespace clearance {
namespace {

using test::eventually;
using enum PartnerStanding;

constexpr std::uint32_t kNear = 0, kWide = 1;

// A ball that moves towards a post, which is 0.8 m away from it at x = 0.
Cell watched_cell() {
  Scene scene = test::cell_of({test::moving("ball", {test::ball(0.1)}),
                               test::fixed("post", {test::ball(0.1)}, test::at(1, 0, 0))});
  scene.revision = 5;
  scene.pairs[0].publish = true;
  scene.zones.push_back(test::zone_over(scene, 0.2, 0.25));
  scene.zones.push_back(test::zone_over(scene, 0.6, 0.65));
  scene.zones[kWide].name = "wide";
  return Cell{scene};
}

class APartner : public testing::Test {
 protected:
  ~APartner() override {
    queue.close();
    reports.reset();
  }
  void tick(double x, PartnerStanding standing) {
    const PoseSample sample = test::sample(0, test::at(x, 0, 0), now += test::kTick);
    const Report& report = monitor.tick({&sample, 1}, now);
    TickTag* const tag = ticks.tags().back();
    ASSERT_NE(tag, nullptr);
    *tag = {.cycle = report.cycle, .lineage = 3, .standing = standing, .publishes = true};
    ticks.tags().push();
    queue.report(report, {});
    ASSERT_TRUE(eventually([&] { return reports->published_cycle() == report.cycle; }));
  }
  // The zones that a client gets that comes now: by id, whether they are active. `count` come.
  std::map<std::uint32_t, bool> latched(std::size_t count) {
    client::Connection connection(dds, cell.topics);
    client::Zones zones(connection);
    EXPECT_TRUE(eventually([&] {
      zones.update();
      return zones.states().size() >= count;
    }));
    std::map<std::uint32_t, bool> active;
    for (const auto& [id, state] : zones.states()) active[id] = state.active;
    return active;
  }

  Cell cell = watched_cell();
  DdsOptions dds = test::own_dds();
  Participant participant{dds};
  PoseReader poses{cell, participant};
  ReportQueue queue{cell.scene, {.reports = 16}};
  RecordingHealth recording;
  DaemonIdentity identity = make_identity("right");
  test::ListedPoses no_poses;
  test::TurnedClock clock;
  TickPartner ticks{no_poses, clock, {.daemon = identity.id, .batch = {.samples = 16}}};
  PartnerPort port{participant, cell.topics, identity, ticks};
  std::unique_ptr<ReportWriter> reports =
      std::make_unique<ReportWriter>(cell, participant, queue, poses, recording,
                                     ReportWriter::OnHealth(), nullptr, identity, &port);
  Monitor monitor{cell.scene};
  std::int64_t now = test::kStart;
};

using Active = std::map<std::uint32_t, bool>;

TEST_F(APartner, ThatTicksApartLeavesNoInactiveZoneButWritesActiveOnes) {
  tick(0.0, kFollowing);
  EXPECT_EQ(latched(2), (Active{{kNear, false}, {kWide, false}}));
  tick(0.0, kApart);
  tick(0.3, kApart);
  EXPECT_EQ(latched(1), (Active{{kWide, true}})) << "it is not known of the partner's";
  tick(0.0, kApart);
  tick(0.0, kApart);
  EXPECT_EQ(latched(1), (Active{{kWide, true}})) << "active in vain is true enough";
  tick(0.0, kFollowing);
  EXPECT_EQ(latched(2), (Active{{kNear, false}, {kWide, false}}));
}

// Ids and names are those of another scene than the partner's.
TEST_F(APartner, ThatHasAnotherSceneLeavesNoZonesAndNoCatalogue) {
  client::Connection connection(dds, cell.topics);
  Participant& of_partner = connection.participant();
  const dds_entity_t distances = of_partner.writer(TopicKind::kDistances, cell.topics.distances);
  const dds_entity_t zones = of_partner.writer(TopicKind::kZones, cell.topics.zones);
  const dds_entity_t catalogue = of_partner.writer(TopicKind::kCatalogue, cell.topics.catalogue);
  Cell changed = watched_cell();
  changed.scene.revision = 6;
  auto names_of_it = make_catalogue(changed);
  test::write_sealed(of_partner, catalogue, *names_of_it);
  clearance_msg_ZoneState state{};
  state.zone = 7;
  test::write_sealed(of_partner, zones, state);
  port.start({.wants_state = [] {}, .send_state = [] {}, .take_state = [](const auto&) {}});
  tick(0.3, kFollowing);
  EXPECT_EQ(latched(3), (Active{{kNear, false}, {kWide, true}, {7, false}}));
  clearance_msg_Distances report{};
  std::strcpy(report.partner, "left");
  report.scene_revision = 6;
  ASSERT_TRUE(eventually([&] {
    ++report.cycle;
    seal(report, 0);
    check_dds(dds_write(distances, &report), "writing");
    return port.partner_revision() == 6;
  }));
  tick(0.3, kApart);
  EXPECT_EQ(latched(1), (Active{{7, false}})) << "those of the partner only";
  client::Connection late(dds, cell.topics);
  client::Catalogue names(late);
  ASSERT_TRUE(eventually([&] {
    names.update();
    return names.message() != nullptr;
  }));
  EXPECT_EQ(names.revision(), 6u);
  EXPECT_EQ(names.message(5), nullptr);
  tick(0.3, kFollowing);
  EXPECT_EQ(latched(3), (Active{{kNear, false}, {kWide, true}, {7, false}}));
  EXPECT_TRUE(eventually([&] {
    names.update();
    return names.message(5) != nullptr;
  }));
  port.stop();
}

// A daemon that starts may have another scene than its partner, which it has not heard yet.
TEST_F(APartner, ThatStartsLeavesNoZonesAndNoCatalogue) {
  tick(0.3, kStarting);
  client::Connection late(dds, cell.topics);
  client::Catalogue names(late);
  const dds_entity_t zones = late.participant().writer(TopicKind::kZones, cell.topics.zones);
  clearance_msg_ZoneState state{};
  state.zone = 7;
  test::write_sealed(late.participant(), zones, state);
  EXPECT_EQ(latched(1), (Active{{7, false}}));
  names.update();
  EXPECT_EQ(names.message(), nullptr);
  tick(0.3, kLeading);
  EXPECT_EQ(latched(3), (Active{{kNear, false}, {kWide, true}, {7, false}}));
  EXPECT_TRUE(eventually([&] {
    names.update();
    return names.message(5) != nullptr;
  }));
}

// One of both is wrong. The last writer decides for a simple reader, so the state is written again.
TEST_F(APartner, ThatDisagreesKeepsAZoneActiveThatTheOtherOneClears) {
  Participant other(dds);
  const dds_entity_t distances = other.writer(TopicKind::kDistances, cell.topics.distances);
  const dds_entity_t zones = other.writer(TopicKind::kZones, cell.topics.zones);
  port.start({.wants_state = [] {}, .send_state = [] {}, .take_state = [](const auto&) {}});
  tick(0.3, kFollowing);
  clearance_msg_Distances report{};
  std::strcpy(report.partner, "left");
  report.scene_revision = cell.scene.revision;
  report.lineage = 4;
  ASSERT_TRUE(eventually([&] {
    tick(0.3, kFollowing);
    ++report.cycle;
    seal(report, 0);
    check_dds(dds_write(distances, &report), "writing");
    return port.disagrees();
  }));
  clearance_msg_ZoneState state{};
  state.zone = kWide;
  state.daemon = 77;
  state.now_ns = now + 1;
  test::write_sealed(other, zones, state);
  client::Connection connection(dds, cell.topics);
  client::Zones seen(connection);
  EXPECT_TRUE(eventually([&] {
    ++report.cycle;
    seal(report, 0);
    check_dds(dds_write(distances, &report), "writing");
    tick(0.3, kFollowing);
    seen.update();
    const auto wide = seen.states().find(kWide);
    return wide != seen.states().end() && wide->second.now_ns > state.now_ns && wide->second.active;
  }));
  port.stop();
}

TEST_F(APartner, WhoseReportHasAFlippedBitIsCountedAndItsSceneIsNotTaken) {
  const auto logged = std::make_shared<test::Logged>();
  const test::LoggedTo to{logged};
  Participant other(dds);
  const dds_entity_t distances = other.writer(TopicKind::kDistances, cell.topics.distances);
  port.start({.wants_state = [] {}, .send_state = [] {}, .take_state = [](const auto&) {}});
  clearance_msg_Distances report{};
  const auto write = [&](const auto& flip) {
    std::strcpy(report.partner, "left");
    report.scene_revision = cell.scene.revision;
    report.state_checksum = 7;
    ++report.cycle;
    seal(report, 0);
    flip();
    check_dds(dds_write(distances, &report), "writing");
  };
  const auto health = [&] {
    clearance_msg_PartnerHealth found{};
    port.fill(found);
    return found;
  };
  ASSERT_TRUE(eventually([&] {
    write([] {});
    return port.partner_revision() == cell.scene.revision;
  }));
  EXPECT_EQ(health().different, 0u);
  write([&] { report.scene_revision ^= 1; });
  EXPECT_TRUE(eventually([&] { return health().different == 1; }));
  EXPECT_EQ(port.partner_revision(), cell.scene.revision);
  write([&] { report.state_checksum ^= 1; });
  EXPECT_TRUE(eventually([&] { return health().different == 2; }));
  write([&] { report.partner[0] = '\0'; });
  EXPECT_TRUE(eventually([&] { return health().different == 3; }));
  EXPECT_EQ(logged->count("[partner-corrupt]"), 1u) << "once a second";
  port.stop();
}

// A daemon that has stopped may have left what it knew. One state each is kept.
TEST(PartnersZones, AStateThatCameTooEarlyCountsOnceTheOtherDaemonHasGone) {
  const DdsOptions dds = test::own_dds();
  client::Connection connection(dds);
  client::Zones zones(connection);
  const auto state = [](std::uint64_t daemon, bool active, std::int64_t now_ns) {
    clearance_msg_ZoneState made{};
    made.daemon = daemon;
    made.active = active;
    made.now_ns = now_ns;
    return made;
  };
  const auto is_active = [&](bool active) {
    zones.update();
    return zones.states().contains(0) && zones.states().at(0).active == active;
  };
  Participant stays(dds);
  const dds_entity_t staying = stays.writer(TopicKind::kZones, connection.topics().zones);
  {
    Participant leaves(dds);
    const dds_entity_t leaving = leaves.writer(TopicKind::kZones, connection.topics().zones);
    auto ahead = state(1, false, 1000), behind = state(2, true, 995);
    test::write_sealed(stays, staying, behind);
    ASSERT_TRUE(eventually([&] { return is_active(true); }));
    test::write_sealed(leaves, leaving, ahead);
    ASSERT_TRUE(eventually([&] { return is_active(false); }));
    test::write_sealed(stays, staying, behind);
    zones.update();
  }
  EXPECT_TRUE(eventually([&] { return is_active(true); }));
}

// The zone of a greater number may have the name of one that is gone, with a state of its own.
TEST(PartnersZones, AZoneThatTheChangedCellDoesNotHaveIsForgottenUntilItIsWrittenAgain) {
  const DdsOptions dds = test::own_dds();
  client::Connection connection(dds);
  client::Zones zones(connection);
  Participant daemon(dds);
  const dds_entity_t writer = daemon.writer(TopicKind::kZones, connection.topics().zones);
  const auto has = [&](std::set<std::uint32_t> expected) {
    zones.update();
    std::set<std::uint32_t> found;
    for (const auto& [zone, state] : zones.states()) found.insert(zone);
    return found == expected;
  };
  clearance_msg_ZoneState first{}, second{};
  first.daemon = second.daemon = 1;
  second.zone = 1;
  test::write_sealed(daemon, writer, first);
  test::write_sealed(daemon, writer, second);
  ASSERT_TRUE(eventually([&] { return has({0, 1}); }));
  second.active = true;
  test::write_sealed(daemon, writer, second);  // taken together with its end, or before
  check_dds(dds_dispose(writer, &second), "disposing");
  EXPECT_TRUE(eventually([&] { return has({0}); }));
  test::write_sealed(daemon, writer, second);
  EXPECT_TRUE(eventually([&] { return has({0, 1}); }));
}

// Two daemons write one zone, and a client hears them in any order.
TEST(PartnersZones, TheStateOfTheLatestTickCountsAsLongAsItsDaemonIsThere) {
  const DdsOptions dds = test::own_dds();
  client::Connection connection(dds);
  client::Zones zones(connection);
  const auto write = [&](dds_entity_t writer, std::uint64_t daemon, bool active,
                         std::int64_t now_ns) {
    clearance_msg_ZoneState state{};
    state.daemon = daemon;
    state.active = active;
    state.now_ns = now_ns;
    test::write_sealed(connection.participant(), writer, state);
    state.zone = static_cast<std::uint32_t>(now_ns);  // to be seen when it has come
    test::write_sealed(connection.participant(), writer, state);
    EXPECT_TRUE(eventually([&] {
      zones.update();
      return zones.states().contains(state.zone);
    }));
  };
  const auto is_active = [&] { return zones.states().at(0).active; };
  Participant stays(dds);
  const dds_entity_t staying = stays.writer(TopicKind::kZones, connection.topics().zones);
  {
    Participant leaves(dds);
    const dds_entity_t leaving = leaves.writer(TopicKind::kZones, connection.topics().zones);
    write(leaving, 1, true, 100);
    write(staying, 2, false, 50);
    EXPECT_TRUE(is_active()) << "the other one's is from before";
    write(leaving, 1, false, 110);
    EXPECT_FALSE(is_active());
    write(staying, 2, true, 120);
    EXPECT_TRUE(is_active());
    write(leaving, 1, true, 130);
  }
  EXPECT_TRUE(eventually([&] {
    write(staying, 2, false, 20);
    return !is_active();
  })) << "a clock may have been set back";
}

}  // namespace
}  // namespace clearance
