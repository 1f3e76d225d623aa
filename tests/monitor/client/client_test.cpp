// The client library over real DDS. The test plays the daemon.
#include "monitor/client/client.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "monitor/participant/participant.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/sealed.hpp"
#include "tests/shared/take_next.hpp"

namespace clearance {
namespace {

using std::chrono::milliseconds;
using test::eventually;

constexpr milliseconds kPatience(20'000);

// Writes the topics that a daemon writes.
class Daemon {
 public:
  explicit Daemon(const DdsOptions& dds)
      : participant_(dds),
        distances_(participant_.writer(TopicKind::kDistances, Topics{}.distances,
                                       {.lease_ns = 100'000'000})),
        catalogue_(participant_.writer(TopicKind::kCatalogue, Topics{}.catalogue)) {}

  [[nodiscard]] bool is_heard() const { return test::matched_readers(distances_) > 0; }

  void report(std::uint64_t cycle, std::int64_t publish_ns = dds_time(), std::uint64_t daemon = 7) {
    write(cycle, publish_ns, daemon, [](clearance_msg_Distances&) {});
  }
  // Sent with a change behind the CRC.
  template <class Change>
  void write(std::uint64_t cycle, std::int64_t publish_ns, std::uint64_t daemon,
             const Change& change) {
    clearance_msg_Distances report{};
    report.daemon = daemon;
    report.cycle = cycle;
    report.publish_ns = publish_ns;
    report.scene_revision = 5;
    seal(report, participant_.address(Topics{}.distances));
    change(report);
    check_dds(dds_write(distances_, &report), "writing");
  }

  // Announces objects and pairs, and one joint. A hand has two parts.
  void announce(std::uint64_t revision = 5,
                const std::vector<const char*>& objects = {"hand", "table"},
                const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs = {{0, 1}}) {
    Sample<clearance_msg_Catalogue> catalogue;
    catalogue->scene = dds_string_dup("cell");
    catalogue->cell_yaml = dds_string_dup("");
    catalogue->scene_revision = revision;
    reserve_sequence(catalogue->objects, objects.size());
    for (const char* name : objects) {
      clearance_msg_CatalogueObject& object =
          catalogue->objects._buffer[catalogue->objects._length];
      object.id = catalogue->objects._length++;
      object.name = dds_string_dup(name);
      if (std::string_view(name) != "hand") continue;
      reserve_sequence(object.parts, 2);
      for (const char* part : {"palm", "finger"}) {
        object.parts._buffer[object.parts._length++] = dds_string_dup(part);
      }
    }
    reserve_sequence(catalogue->pairs, pairs.size());
    for (const auto& [a, b] : pairs) {
      const std::uint32_t id = catalogue->pairs._length++;
      catalogue->pairs._buffer[id] = {id, a, b, true};
    }
    reserve_sequence(catalogue->joints, 1);
    catalogue->joints._buffer[catalogue->joints._length++] = {0, dds_string_dup("elbow")};
    test::write_sealed(participant_, catalogue_, *catalogue);
  }

  Participant& participant() { return participant_; }

 private:
  Participant participant_;
  dds_entity_t distances_, catalogue_;
};

TEST(Client, GetsReportsInOrderEachWithItsCheck) {
  const DdsOptions dds = test::own_dds();
  Daemon daemon(dds);
  client::Connection connection(dds);
  client::Reports reports(connection, {.old_after = std::chrono::seconds(10)});
  ASSERT_TRUE(eventually([&] { return daemon.is_heard() && reports.daemons() == 1; }));
  EXPECT_FALSE(reports.next());
  EXPECT_EQ(reports->cycle, 0u);
  daemon.report(4);
  daemon.report(5);
  daemon.report(8, dds_time() - 20'000'000'000);
  daemon.report(1, dds_time(), 9);
  for (const std::uint64_t cycle : {4, 5}) {
    ASSERT_TRUE(reports.next(kPatience));
    EXPECT_EQ(reports->cycle, cycle);
    EXPECT_TRUE(reports.check().fresh());
    EXPECT_EQ(reports.check().missed, 0u);
  }
  ASSERT_TRUE(reports.next(kPatience));
  EXPECT_EQ(reports.check().missed, 2u);
  EXPECT_TRUE(reports.check().is_old);
  ASSERT_TRUE(reports.next(kPatience));
  EXPECT_TRUE(reports.check().other_daemon);
  EXPECT_FALSE(reports.next(milliseconds(1)));
  EXPECT_EQ((*reports).cycle, 1u) << "the last one stays";
}

TEST(Client, HandsOutNoFaultyReportAndIsHeldByTwoUntilAcknowledge) {
  const DdsOptions dds = test::own_dds();
  Daemon daemon(dds);
  client::Connection connection(dds);
  client::Reports reports(connection, {.period = std::chrono::hours(1)});
  ASSERT_TRUE(eventually([&] { return daemon.is_heard(); }));
  EXPECT_EQ(reports.reason(), ReportError::kNothingHeard);
  daemon.report(1);
  ASSERT_TRUE(reports.next(kPatience));
  EXPECT_FALSE(reports.fail_safe());
  const auto fault = [&](ReportError expected, const auto& change) {
    daemon.write(2, dds_time(), 7, change);
    EXPECT_TRUE(eventually([&] { return !reports.next() && reports.reason() == expected; }));
    EXPECT_EQ(reports->cycle, 1u);
  };
  fault(ReportError::kCorrupt, [](auto& report) { report.lower_all = 1.0; });
  EXPECT_FALSE(reports.is_held());
  reports.acknowledge();
  fault(ReportError::kOtherAddress, [](auto& report) { seal(report, 1); });
  fault(ReportError::kCorrupt, [](auto& report) { report.delivery_checksum = 0; });
  EXPECT_TRUE(reports.is_held());
  daemon.report(3);
  ASSERT_TRUE(reports.next(kPatience));
  EXPECT_EQ(reports.check().error, ReportError::kGood);
  EXPECT_EQ(reports.reason(), ReportError::kCorrupt) << "it is held";
  reports.acknowledge();
  EXPECT_EQ(reports.reason(), ReportError::kNothingHeard);
  daemon.report(4);
  ASSERT_TRUE(reports.next(kPatience));
  EXPECT_FALSE(reports.fail_safe());
  daemon.report(4);
  EXPECT_TRUE(
      eventually([&] { return !reports.next() && reports.reason() == ReportError::kRepeated; }));
}

// The daemon of the test states no period, so the limit of old reports counts.
TEST(Client, IsFailSafeWhenNoReportComesInTime) {
  const DdsOptions dds = test::own_dds();
  Daemon daemon(dds);
  client::Connection connection(dds);
  client::Reports reports(connection, {.old_after = std::chrono::milliseconds(500)});
  ASSERT_TRUE(eventually([&] { return daemon.is_heard(); }));
  std::uint64_t cycle = 0;
  ASSERT_TRUE(eventually([&] {
    daemon.report(++cycle);
    return reports.newest(milliseconds(10)) && !reports.fail_safe();
  }));
  EXPECT_TRUE(eventually([&] { return reports.fail_safe(); }));
  EXPECT_EQ(reports.reason(), ReportError::kSilent);
  EXPECT_FALSE(reports.is_held());
}

TEST(Client, MayAskForTheNewestReportOnly) {
  const DdsOptions dds = test::own_dds();
  Daemon daemon(dds);
  client::Connection connection(dds);
  client::Reports reports(connection);
  ASSERT_TRUE(eventually([&] { return daemon.is_heard(); }));
  for (std::uint64_t cycle = 1; cycle <= 20; ++cycle) daemon.report(cycle);
  ASSERT_TRUE(eventually([&] { return reports.newest(milliseconds(1)) && reports->cycle == 20; }));
  EXPECT_FALSE(reports.newest());
}

TEST(Client, HearsThatTheDaemonHasEnded) {
  const DdsOptions dds = test::own_dds();
  client::Connection connection(dds);
  client::Reports reports(connection);
  {
    Daemon daemon(dds);
    ASSERT_TRUE(eventually([&] { return !reports.has_ended(); }));
    daemon.report(1);
    ASSERT_TRUE(eventually([&] { return reports.next(); }));
  }
  EXPECT_TRUE(eventually([&] { return reports.has_ended() && reports.daemons() == 0; }));
  EXPECT_EQ(reports->cycle, 1u);
}

// The second catalogue has the table first. Reports of the first one may still come.
TEST(Client, FindsAPairByNameInReportsOfEachOfTheLastCatalogues) {
  const DdsOptions dds = test::own_dds();
  Daemon daemon(dds);
  client::Connection connection(dds);
  client::Catalogue catalogue(connection);
  client::Pair pair(catalogue, "table", "hand");
  client::Object table(catalogue, "table");
  clearance_msg_PairDistance published[2]{};
  published[1].pair = 1;
  clearance_msg_Distances report{};
  report.pairs = {2, 2, published, false};
  report.scene_revision = 5;
  EXPECT_EQ(pair.in(report), nullptr) << "no catalogue yet";
  daemon.announce();
  ASSERT_TRUE(eventually([&] { return pair.in(report) == &published[0]; }));
  EXPECT_EQ(table.id(5), 1u);
  daemon.announce(6, {"table", "lamp", "hand"}, {{1, 2}, {2, 0}});
  report.scene_revision = 6;
  ASSERT_TRUE(eventually([&] { return pair.in(report) == &published[1]; }));
  EXPECT_EQ(table.id(6), 0u);
  EXPECT_EQ(catalogue.pair_name(published[1], 6), "hand.palm - table");
  EXPECT_EQ(catalogue.pair_name(published[0], 5), "hand.palm - table");
  report.scene_revision = 5;
  EXPECT_EQ(pair.in(report), &published[0]);
  EXPECT_EQ(table.id(5), 1u);
  report.scene_revision = 7;
  EXPECT_EQ(pair.in(report), nullptr);
}

TEST(Client, KnowsNamesFromTheCatalogueHoweverLateItComes) {
  const DdsOptions dds = test::own_dds();
  Daemon daemon(dds);
  daemon.announce();
  client::Connection connection(dds);
  client::Catalogue catalogue(connection);
  clearance_msg_PairDistance pair{};
  pair.part_a = 1;
  EXPECT_EQ(catalogue.pair_name(pair), "pair 0");
  EXPECT_EQ(catalogue.object("hand"), std::nullopt);
  ASSERT_TRUE(eventually([&] { return catalogue.update(), catalogue.message() != nullptr; }));
  EXPECT_EQ(catalogue.revision(), 5u);
  EXPECT_EQ(catalogue.object("table"), 1u);
  EXPECT_EQ(catalogue.pair("table", "hand"), 0u);
  EXPECT_EQ(catalogue.pair("table", "chair"), std::nullopt);
  EXPECT_EQ(catalogue.joint("elbow"), 0u);
  EXPECT_EQ(catalogue.object_name(1), "table");
  EXPECT_EQ(catalogue.object_name(9), "object 9");
  EXPECT_EQ(catalogue.joint_name(0), "elbow");
  EXPECT_EQ(catalogue.pair_name(pair), "hand.finger - table");
}

template <class T>
bool take(dds_entity_t reader, Sample<T>& sample) {
  return test::take_next(reader, sample);
}

// One of two partners ticks apart since it wrote that the zone is clear. A reader that comes now
// gets what both have written last, in any order.
TEST(Client, BelievesTheLaterOfTwoDaemonsAboutAZoneAsLongAsItIsThere) {
  const DdsOptions dds = test::own_dds();
  Participant one(dds), other(dds);
  const auto write = [&](dds_entity_t writer, std::uint64_t daemon, bool active, std::int64_t now) {
    clearance_msg_ZoneState zone{};
    zone.daemon = daemon;
    zone.active = active;
    zone.now_ns = now;
    test::write_sealed(one, writer, zone);
  };
  const dds_entity_t leader = one.writer(TopicKind::kZones, Topics{}.zones);
  const dds_entity_t apart = other.writer(TopicKind::kZones, Topics{}.zones);
  write(leader, 1, true, 2000);
  client::Connection connection(dds, Topics{});
  client::Zones zones(connection);
  ASSERT_TRUE(eventually([&] { return zones.update(), zones.states().contains(0); }));
  ASSERT_TRUE(eventually([&] { return test::matched_readers(apart) > 0; }));
  write(apart, 2, false, 1000);
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(milliseconds(10));
    zones.update();
    EXPECT_TRUE(zones.states().at(0).active);
  }
  // A daemon that was started again, on a clock that was set back, counts once the former has gone.
  dds_delete(leader);
  EXPECT_TRUE(eventually([&] {
    write(apart, 2, false, 1001);
    return zones.update(), !zones.states().at(0).active;
  }));
}

// DDS may lose the message of a zone, or bring it later than the report.
TEST(Client, HasTheZonesActiveThatTheReportLists) {
  const DdsOptions dds = test::own_dds();
  Participant daemon(dds);
  const dds_entity_t writer = daemon.writer(TopicKind::kZones, Topics{}.zones);
  clearance_msg_ZoneState clear{};
  clear.daemon = 1;
  clear.clearance = 2.0;
  test::write_sealed(daemon, writer, clear);
  client::Connection connection(dds, Topics{});
  client::Zones zones(connection);
  ASSERT_TRUE(eventually([&] { return zones.update(), zones.states().contains(0); }));
  Sample<clearance_msg_Distances> report;
  report->cycle = 7;
  reserve_sequence(report->active_zones, 2);
  report->active_zones._length = 2;
  report->active_zones._buffer[1] = 4;  // whose state has not come
  zones.update(*report);
  for (const std::uint32_t zone : {0u, 4u}) {
    const clearance_msg_ZoneState& state = zones.states().at(zone);
    EXPECT_TRUE(state.active && !state.certified);
    EXPECT_EQ(state.since_cycle, 7u);
    EXPECT_LT(state.clearance, 0.0);
  }
  report->active_zones._length = 0;
  zones.update(*report);
  EXPECT_FALSE(zones.states().at(0).active);
  EXPECT_EQ(zones.states().at(0).clearance, 2.0);
  EXPECT_FALSE(zones.states().contains(4));
}

TEST(Client, JointsAndPosesArriveAsTheDaemonWantsThem) {
  const DdsOptions dds = test::own_dds();
  Daemon daemon(dds);
  const dds_entity_t joints =
      daemon.participant().reader(TopicKind::kJointStates, Topics{}.joint_states);
  const dds_entity_t poses = daemon.participant().reader(TopicKind::kPoses, Topics{}.poses);
  client::Connection connection(dds);
  client::JointWriter arm(connection, "arm", {"shoulder", "elbow"});
  client::PoseWriter tracker(connection, "tracker");
  ASSERT_TRUE(eventually([&] { return arm.is_heard() && tracker.is_heard(); }));
  EXPECT_TRUE(arm.write({{0.1, 0.2}}, {{1.0, 2.0}}, 77, true));
  EXPECT_TRUE(arm.write({{0.3, 0.4}}));
  Sample<clearance_msg_JointStates> states;
  ASSERT_TRUE(eventually([&] { return take(joints, states); }));
  EXPECT_STREQ(states->source, "arm");
  EXPECT_EQ(states->sequence_number, 1u);
  EXPECT_EQ(states->stamp_ns, 77);
  ASSERT_EQ(states->names._length, 2u);
  EXPECT_STREQ(states->names._buffer[1], "elbow");
  EXPECT_EQ(states->positions._buffer[1], 0.2);
  EXPECT_EQ(states->velocities._buffer[1], 2.0);
  EXPECT_TRUE(states->stopping);
  ASSERT_TRUE(eventually([&] { return take(joints, states); }));
  EXPECT_EQ(states->sequence_number, 2u);
  EXPECT_EQ(states->velocities._length, 0u);
  EXPECT_FALSE(states->stopping);
  EXPECT_GT(states->stamp_ns, 1'000'000'000'000'000'000);

  std::vector<clearance_msg_ObjectPose> sent(2);
  sent[1].object = 1;
  sent[1].position = {1.0, 2.0, 3.0};
  EXPECT_TRUE(tracker.write(sent, 5));
  Sample<clearance_msg_PoseBatch> batch;
  ASSERT_TRUE(eventually([&] { return take(poses, batch); }));
  EXPECT_STREQ(batch->source, "tracker");
  EXPECT_EQ(batch->scene_revision, 5u);
  ASSERT_EQ(batch->poses._length, 2u);
  EXPECT_EQ(batch->poses._buffer[1].position.z, 3.0);
}

TEST(Client, RefusesWhatTheDaemonCouldNotUse) {
  client::Connection connection(test::own_dds());
  EXPECT_THROW(client::PoseWriter(connection, ""), std::invalid_argument);
  EXPECT_THROW(client::PoseWriter(connection, std::string(33, 'x')), std::invalid_argument);
  client::JointWriter arm(connection, std::string(32, 'x'), {"a", "b"});
  EXPECT_THROW((void)arm.write({{0.1}}), std::invalid_argument);
  EXPECT_THROW((void)arm.write({{0.1, 0.2}}, {{0.1}}), std::invalid_argument);
  client::PoseWriter poses(connection, "p");
  EXPECT_FALSE(poses.write(std::vector<clearance_msg_ObjectPose>(clearance_msg_kMaxPoses + 1), 0));
}

TEST(Client, MayLiveInAParticipantOfTheProgramsOwn) {
  const DdsOptions dds = test::own_dds();
  Daemon daemon(dds);
  daemon.announce();
  // Another participant in this process's domain, like that of a program that uses DDS itself.
  const dds_entity_t own = check_dds(dds_create_participant(*dds.domain, nullptr, nullptr), "own");
  {
    client::Connection connection(own, dds.partition);
    client::Catalogue catalogue(connection);
    EXPECT_TRUE(eventually([&] { return catalogue.update(), catalogue.message() != nullptr; }));
  }
  EXPECT_EQ(dds_delete(own), DDS_RETCODE_OK) << "it is left to its owner";
}

}  // namespace
}  // namespace clearance
