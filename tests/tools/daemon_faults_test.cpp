// A daemon that dies, one that hangs, and two on one cell: the observations of their clients, over
// real DDS.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <map>

#include "monitor/publish/report_writer.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance {
namespace {

using test::ChildProcess;
using test::eventually;

std::uint32_t alive_writers(dds_entity_t reader) {
  dds_liveliness_changed_status_t status{};
  dds_get_liveliness_changed_status(reader, &status);
  return status.alive_count;
}

// A cell, a client with default liveliness, and the time within which that client is notified.
struct WatchedDaemon {
  test::CellFile cell{test::small_cell("small")};
  Cell read = cell.cell();
  DdsOptions dds = test::own_dds();
  Participant client{dds};
  test::Distances distances{client, read};
  ChildProcess daemon{test::kDaemon, test::with({cell.path()}, test::dds_arguments(dds))};

  // Cyclone itself declares a dead process lost after 10 s. This limit is a tenth of that, where
  // the lease is 100 ms.
  static constexpr std::chrono::seconds kSoon{1};

  void run() {
    distances.settle();
    ASSERT_EQ(alive_writers(distances.reader()), 1u);
  }
  [[nodiscard]] bool is_given_up() {
    return eventually([&] { return alive_writers(distances.reader()) == 0; }, kSoon);
  }
};

TEST(DaemonLiveliness, TellsClientsWithinASecondThatADaemonWasKilled) {
  WatchedDaemon watched;
  watched.run();
  watched.daemon.signal(SIGKILL);
  EXPECT_TRUE(watched.is_given_up());
}

TEST(DaemonLiveliness, TellsClientsThatADaemonStandsStillAndThatItGoesOn) {
  WatchedDaemon watched;
  watched.run();
  watched.daemon.signal(SIGSTOP);
  EXPECT_TRUE(watched.is_given_up());
  watched.daemon.signal(SIGCONT);
  EXPECT_TRUE(eventually([&] { return alive_writers(watched.distances.reader()) == 1; }));
}

TEST(DaemonLiveliness, LeaseIsTenPeriodsAndNoLessThanATenthOfASecond) {
  EXPECT_EQ(lease_ns(1000.0), 100'000'000);
  EXPECT_EQ(lease_ns(10.0), 1'000'000'000);
}

TEST(TwoDaemons, TheSecondYieldsAndTheFirstGoesOn) {
  const test::CellFile cell(test::small_cell("small"));
  const Cell read = cell.cell();
  const DdsOptions dds = test::own_dds();
  Participant client(dds);
  test::Distances distances(client, read);
  const auto arguments = test::with({cell.path()}, test::dds_arguments(dds));
  ChildProcess first(test::kDaemon, arguments);
  distances.settle();
  const auto report = distances.next();
  ASSERT_NE(report, nullptr);
  const std::uint64_t daemon = (*report)->daemon;
  EXPECT_NE(daemon, 0u);

  ChildProcess second(test::kDaemon, arguments);
  EXPECT_EQ(second.wait(), 4) << second.output();
  EXPECT_TRUE(second.tells("other-daemon-first")) << second.output();
  EXPECT_TRUE(first.tells("other-daemon-later")) << first.output();

  // Until the second daemon detected the first, clients received reports of both and could
  // distinguish them.
  std::map<std::uint64_t, std::uint64_t> cycle_of;
  std::uint64_t after = 0;
  const bool went_on = eventually([&] {
    const auto next = distances.next();
    if (next == nullptr) return false;
    std::uint64_t& cycle = cycle_of[(*next)->daemon];
    EXPECT_GT((*next)->cycle, cycle);
    cycle = (*next)->cycle;
    after = (*next)->daemon == daemon ? after + 1 : 0;
    return after == 100;
  });
  EXPECT_TRUE(went_on);
  EXPECT_LE(cycle_of.size(), 2u);
  EXPECT_TRUE(first.tells("other-writer-left", {"clearance/distances"})) << first.output();
  first.signal(SIGTERM);
  EXPECT_EQ(first.wait(), 0) << first.output();
}

TEST(TwoDaemons, OneThatStandsStillOrIsDeadBlocksNoOther) {
  for (const int signal : {SIGSTOP, SIGKILL}) {
    WatchedDaemon watched;
    watched.run();
    watched.daemon.signal(signal);
    ChildProcess second(test::kDaemon, test::with({watched.cell.path(), "--ticks", "200"},
                                                  test::dds_arguments(watched.dds)));
    EXPECT_EQ(second.wait(), 0) << second.output();
  }
}

TEST(TwoDaemons, AnotherProgramOnTheTopicIsNamedAndCountedInHealth) {
  const test::CellFile cell(test::small_cell("small"));
  const Cell read = cell.cell();
  const DdsOptions dds = test::own_dds();
  Participant client(dds), replay(dds);
  const dds_entity_t health = client.reader(TopicKind::kHealth, read.topics.health);
  const dds_entity_t writer = replay.writer(TopicKind::kDistances, read.topics.distances);
  ChildProcess daemon(test::kDaemon, test::with({cell.path()}, test::dds_arguments(dds)));
  const auto foreign = make_distances(read.scene);
  Sample<clearance_msg_Health> sample;
  EXPECT_TRUE(eventually([&] {
    dds_write(writer, &*foreign);
    return test::take_next(health, sample) && sample->foreign_reports > 0;
  })) << daemon.output();
  EXPECT_NE(sample->daemon, 0u);
  EXPECT_TRUE(daemon.tells("other-program")) << daemon.output();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << "it goes on: " << daemon.output();
}

}  // namespace
}  // namespace clearance
