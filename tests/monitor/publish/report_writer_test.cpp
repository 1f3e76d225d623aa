// The daemon's publications, through real DDS on loopback.
#include "monitor/publish/report_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "monitor/client/client.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/sealed.hpp"
#include "tests/shared/take_next.hpp"

namespace clearance {
namespace {

Scene watched_scene() {
  Scene scene = test::cell_of({test::moving("ball", {test::ball(0.1)}),
                               test::fixed("post", {test::ball(0.1)}, test::at(1, 0, 0))});
  scene.pairs[0].publish = true;
  scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
  return scene;
}

// The topic with this type.
template <class T>
TopicKind kind_of() {
  const auto of_type = [](const Topic& each) { return each.type == &topic_descriptor<T>(); };
  return std::ranges::find_if(kTopics, of_type)->kind;
}

template <class T>
class Reader {
 public:
  Reader(Participant& participant, const Cell& cell)
      : reader_(participant.reader(kind_of<T>(), cell.topics.*topic(kind_of<T>()).name)) {}
  [[nodiscard]] dds_entity_t handle() const { return reader_; }
  // Returns the next sample, or null if none arrives.
  const T* next() {
    const bool came = test::eventually([&] { return test::take_next(reader_, sample_); });
    return came ? &*sample_ : nullptr;
  }

 private:
  dds_entity_t reader_;
  Sample<T> sample_;
};

// The publishing side without a tick loop: the test acts as the tick thread.
struct Publisher {
  Cell cell{watched_scene()};
  Scene& scene = cell.scene;
  DdsOptions dds = test::own_dds();
  Participant participant{dds};
  PoseReader poses{cell, participant};
  ReportQueue queue{scene, {.reports = 16}};
  RecordingHealth recording;
  std::unique_ptr<ReportWriter> reports =
      std::make_unique<ReportWriter>(cell, participant, queue, poses, recording);
  Monitor monitor{scene};
  std::int64_t now = test::kStart;

  const Report& tick(double x) {
    const PoseSample sample = test::sample(0, test::at(x, 0, 0), now += test::kTick);
    const SourceUse use{.source = SourceName("arm"), .sequence_number = ++sequence};
    const Report& report = monitor.tick({&sample, 1}, now);
    queue.report(report, {&use, 1});
    return report;
  }
  std::uint64_t sequence = 0;

  ~Publisher() {
    queue.close();
    reports.reset();
  }
};

TEST(ReportWriter, PublishesEveryTickAsItWas) {
  Publisher publisher;
  Participant client(publisher.dds);
  Reader<clearance_msg_Distances> reader(client, publisher.cell);
  ASSERT_TRUE(test::eventually([&] { return test::matched_writers(reader.handle()) == 1; }));
  // A writer that has not discovered the reader yet would send it nothing.
  ASSERT_TRUE(test::eventually([&] { return publisher.reports->distance_readers() == 1; }));
  for (std::uint64_t i = 1; i <= 5; ++i) {
    const Report& report = publisher.tick(0.1 * static_cast<double>(i));
    const clearance_msg_Distances* sample = reader.next();
    ASSERT_NE(sample, nullptr);
    EXPECT_EQ(sample->cycle, i);
    EXPECT_EQ(sample->now_ns, report.now_ns);
    EXPECT_GE(sample->publish_ns, report.now_ns);
    EXPECT_EQ(sample->scene_revision, publisher.scene.revision);
    EXPECT_EQ(sample->minimum.distance, report.minimum.distance);
    ASSERT_EQ(sample->pairs._length, 1u);
    EXPECT_EQ(sample->pairs._buffer[0].lower, report.pairs[0].lower);
    ASSERT_EQ(sample->sources._length, 1u);
    EXPECT_STREQ(sample->sources._buffer[0].source, "arm");
    EXPECT_EQ(sample->sources._buffer[0].sequence_number, i);
  }
}

TEST(ReportWriter, TellsALateClientNamesAndZones) {
  Publisher publisher;
  Participant client(publisher.dds);
  Reader<clearance_msg_ZoneState> early(client, publisher.cell);
  publisher.tick(0.0);
  publisher.tick(0.6);  // 0.2 m away: inside the zone
  // Both reports are only queued so far. The client arrives after they have been published.
  const clearance_msg_ZoneState* seen = early.next();
  while (seen != nullptr && !seen->active) seen = early.next();
  ASSERT_NE(seen, nullptr);
  Reader<clearance_msg_Catalogue> catalogue(client, publisher.cell);
  Reader<clearance_msg_ZoneState> zones(client, publisher.cell);
  const clearance_msg_Catalogue* names = catalogue.next();
  ASSERT_NE(names, nullptr);
  ASSERT_EQ(names->objects._length, 2u);
  EXPECT_STREQ(names->objects._buffer[1].name, "post");
  EXPECT_EQ(names->scene_revision, publisher.scene.revision);
  const clearance_msg_ZoneState* zone = zones.next();
  ASSERT_NE(zone, nullptr);
  EXPECT_STREQ(zone->name, "zone");
  EXPECT_TRUE(zone->active);
}

// Another daemon, which started later, has ended before others heard that it leaves.
TEST(ReportWriter, ReplacesTheCatalogueOfAnotherDaemonEachSecondWhileThatOneIsThere) {
  Publisher publisher;
  Participant other(publisher.dds);
  other.writer(TopicKind::kDistances, publisher.cell.topics.distances);
  const dds_entity_t catalogues =
      other.writer(TopicKind::kCatalogue, publisher.cell.topics.catalogue);
  client::Connection connection(publisher.dds, publisher.cell.topics);
  client::Catalogue names(connection);
  const auto has = [&](std::uint64_t revision) {
    return test::eventually([&] {
      publisher.tick(0.3);
      publisher.queue.statistics(LoopStatistics(publisher.scene));
      names.update();
      return names.message() != nullptr && names.revision() == revision;
    });
  };
  ASSERT_TRUE(has(publisher.scene.revision));
  Sample<clearance_msg_Catalogue> wrong = make_catalogue(publisher.cell);
  wrong->scene_revision = publisher.scene.revision + 1;
  test::write_sealed(other, catalogues, *wrong);
  EXPECT_TRUE(test::eventually([&] {
    names.update();
    return names.message(publisher.scene.revision + 1) != nullptr;
  }));
  EXPECT_TRUE(has(publisher.scene.revision));
}

TEST(ReportWriter, PublishesAZoneOnlyWhenItChanges) {
  Publisher publisher;
  Participant client(publisher.dds);
  Reader<clearance_msg_ZoneState> zones(client, publisher.cell);
  const auto expect_next = [&](bool active, std::uint64_t cycle) {
    const clearance_msg_ZoneState* zone = zones.next();
    ASSERT_NE(zone, nullptr);
    EXPECT_EQ(zone->active, active) << cycle;
    EXPECT_EQ(zone->cycle, cycle);
  };
  publisher.tick(0.0);
  expect_next(false, 1);
  publisher.tick(0.1);
  publisher.tick(0.6);
  expect_next(true, 3);
  publisher.tick(0.55);
  publisher.tick(0.0);  // within the zone when it left 0.55 m, and therefore since the last tick
  publisher.tick(0.0);
  expect_next(false, 6);
}

// The zone stays active, and a client sees the cause of each tick in which it is another one.
TEST(ReportWriter, PublishesAnActiveZoneAgainWhenItsCauseOrTheObjectOfThatChanges) {
  Publisher publisher;
  Participant client(publisher.dds);
  Reader<clearance_msg_ZoneState> zones(client, publisher.cell);
  Report report = publisher.monitor.tick({}, publisher.now += test::kTick);
  ASSERT_EQ(report.zones[0].cause, ZoneCause::kUnknown);
  const auto publish = [&](ZoneCause cause, std::uint32_t object) {
    ++report.cycle;
    report.zones[0].cause = cause;
    report.zones[0].cause_object = object;
    publisher.queue.report(report, {});
  };
  const auto expect_next = [&] {
    const clearance_msg_ZoneState* zone = zones.next();
    ASSERT_NE(zone, nullptr);
    EXPECT_TRUE(zone->active);
    EXPECT_EQ(zone->cause, static_cast<std::uint8_t>(report.zones[0].cause));
    EXPECT_EQ(zone->cause_object, report.zones[0].cause_object);
    EXPECT_EQ(zone->cycle, report.cycle);
    EXPECT_EQ(zone->since_cycle, 1u);
  };
  for (const ZoneCause cause :
       {ZoneCause::kUnknown, ZoneCause::kNear, ZoneCause::kLate, ZoneCause::kDiscontinuous,
        ZoneCause::kContradicted, ZoneCause::kContactTooDeep, ZoneCause::kContactTooLate}) {
    publish(cause, 0);
    expect_next();
    report.zones[0].clearance -= 0.01;
    publish(cause, 0);  // which is not written
  }
  publish(ZoneCause::kLate, 0);
  expect_next();
  publish(ZoneCause::kLate, 1);
  expect_next();
}

TEST(ReportWriter, SaysHowTheDaemonIs) {
  Publisher publisher;
  Participant client(publisher.dds);
  Reader<clearance_msg_Health> reader(client, publisher.cell);
  LoopStatistics statistics(publisher.scene);
  statistics.cycle = 1000;
  statistics.now_ns = test::kStart;
  statistics.overruns = 3;
  statistics.skipped_cycles = 4;
  for (int i = 0; i < 999; ++i) statistics.tick.add(20'000);
  statistics.tick.add(90'000);
  statistics.late_responses = 7;
  statistics.rejected[0][static_cast<std::size_t>(Reject::kNotUnit)] = 5;
  statistics.rejected_total[static_cast<std::size_t>(Reject::kNotUnit)] = 5;
  statistics.refused_poses[0].cause = Reject::kNotUnit;
  statistics.refused_poses[0].value = {1, 2, 3, 0, 0, 0, 0.5};
  statistics.rejected_total[static_cast<std::size_t>(Reject::kUnknownObject)] = 6;
  statistics.ages[0] = {.age_ns = 7'000'000, .stale = false};
  publisher.recording.begin("run.mcap");
  publisher.recording.fail("run.mcap was deleted");
  publisher.recording.set_missing(12);
  publisher.queue.statistics(statistics);

  const clearance_msg_Health* health = reader.next();
  ASSERT_NE(health, nullptr);
  EXPECT_EQ(health->cycle, 1000u);
  EXPECT_EQ(health->overruns, 3u);
  EXPECT_EQ(health->skipped_cycles, 4u);
  EXPECT_NEAR(health->tick_p50_us, 20.0, 20.0 / 64);
  EXPECT_EQ(health->tick_max_us, 90.0);
  EXPECT_EQ(health->late_responses, 7u);
  EXPECT_STREQ(health->recording, "run.mcap was deleted");
  EXPECT_EQ(health->recording_missing, 12u);
  ASSERT_EQ(health->rejected._length, 2u);
  EXPECT_STREQ(health->rejected._buffer[0].object, "ball");
  EXPECT_STREQ(health->rejected._buffer[0].cause, name(Reject::kNotUnit));
  EXPECT_EQ(health->rejected._buffer[0].count, 5u);
  EXPECT_STREQ(health->rejected._buffer[0].last, "(0, 0, 0, 0.5)");
  EXPECT_STREQ(health->rejected._buffer[1].last, "");
  EXPECT_STREQ(health->rejected._buffer[1].object, "(no such id)");
  EXPECT_EQ(health->rejected._buffer[1].count, 6u);
  ASSERT_EQ(health->inputs._length, 1u) << "the post is fixed: it has no age";
  EXPECT_STREQ(health->inputs._buffer[0].name, "ball");
  EXPECT_EQ(health->inputs._buffer[0].age_ns, 7'000'000);
}

// The report was due a while before it was handed over; its inputs were older still.
TEST(ReportWriter, SaysTheResponseTimeOfEachInputTheSlowestFirst) {
  Publisher publisher;
  Participant client(publisher.dds);
  Reader<clearance_msg_Health> reader(client, publisher.cell);
  Reader<clearance_msg_Distances> reports(client, publisher.cell);
  constexpr std::int64_t kDelay = 3'000'000;
  ReportStart start{.told_ns = SystemClock().monotonic_ns() - kDelay};
  start.ages_ns.fill(-1);
  start.ages_ns[2] = 1'000'000;
  start.ages_ns[4] = 40'000'000;
  publisher.queue.start(start);
  publisher.queue.report(publisher.monitor.tick({}, publisher.now += test::kTick), {});
  ASSERT_NE(reports.next(), nullptr);
  LoopStatistics statistics(publisher.scene);
  statistics.sources[2] = SourceName("arm");
  statistics.sources[4] = SourceName("tracker");
  publisher.queue.statistics(statistics);
  const clearance_msg_Health* health = reader.next();
  ASSERT_NE(health, nullptr);
  ASSERT_EQ(health->responses._length, 2u);
  const clearance_msg_InputResponse* const inputs = health->responses._buffer;
  EXPECT_STREQ(inputs[0].input, "tracker");
  EXPECT_STREQ(inputs[1].input, "arm");
  EXPECT_NEAR(inputs[0].max_us - inputs[1].max_us, 39'000.0, 1e-6);
  EXPECT_GE(inputs[0].max_us, 43'000.0);
  EXPECT_EQ(inputs[0].max_us, health->response_max_us);
  const std::int64_t told = publisher.queue.longest_delay(start.told_ns);
  EXPECT_NEAR(1e-3 * static_cast<double>(told), inputs[0].max_us - 40'000.0, 1e-6);
}

TEST(Participant, SaysWhichDomainsThereAre) {
  try {
    const Participant participant({.domain = 233});
    FAIL() << "domain 233 does not exist";
  } catch (const DdsError& error) {
    EXPECT_NE(std::strstr(error.what(), "0 to 232"), nullptr) << error.what();
  }
}

TEST(Participant, SaysWhichInterfaceIsMissing) {
  DdsOptions options = test::own_dds();
  options.interface = "nosuch0";
  try {
    const Participant participant(options);
    FAIL() << "there is no interface nosuch0";
  } catch (const DdsError& error) {
    EXPECT_NE(std::strstr(error.what(), "domain"), nullptr) << error.what();
  }
}

}  // namespace
}  // namespace clearance
