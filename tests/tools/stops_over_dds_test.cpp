// How robots stop as a client meets it: over DDS, in a recording, and on a terminal. The figures
// themselves are tested on the tick.
#include <gtest/gtest.h>

#include <csignal>
#include <regex>
#include <string>

#include "monitor/interface/report.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

TEST(StopsOverDds, ComeWithEveryTickAndAreUnknownWithoutInputs) {
  const std::string file = places::sources() + "/config/cells/stops.yaml";
  const Cell cell = std::get<Cell>(read_cell(file));
  const DdsOptions dds = own_dds();
  const ScratchFolder folder;
  const std::string run = (folder / "run.mcap").string();
  Participant client(dds);
  const dds_entity_t reader = client.reader(TopicKind::kSeparation, cell.topics.separation, 4096);
  ChildProcess watch(kWatch, with({"--plain"}, dds_arguments(dds)));
  ChildProcess daemon(kDaemon, with({file, "--record", run}, dds_arguments(dds)));
  Sample<clearance_msg_Separation> sample;
  // The first message whose stop is known, or is not.
  const auto comes = [&](bool known) {
    return eventually([&] {
      return take_next(reader, sample) && sample->stops._length == 1 &&
             (sample->stops._buffer[0].validity != 0) == known;
    });
  };
  ASSERT_TRUE(comes(false)) << daemon.output();
  EXPECT_EQ(sample->stops._buffer[0].scaling, 0.0);
  EXPECT_TRUE(eventually([&] { return watch.wrote("arm stops: not known, scaling 0, "); }))
      << watch.output();

  ChildProcess robot(kRobot, with({file, "--swing", "0.05"}, dds_arguments(dds)));
  ASSERT_TRUE(comes(true)) << daemon.output();
  const clearance_msg_RobotStop& stop = sample->stops._buffer[0];
  EXPECT_EQ(stop.robot, 0u);
  EXPECT_EQ(sample->scene_revision, cell.scene.revision);
  EXPECT_GE(stop.scaling, 0.0);
  EXPECT_LE(stop.scaling, 1.0);
  EXPECT_GT(stop.time, 0.06) << "the reaction is part of it";
  EXPECT_LT(stop.pair, cell.scene.pairs.size());
  const std::regex line(
      "arm stops: (clear by [0-9.]+ m in [0-9.]+ s, .+ - .+|scaling 0[0-9.]+, [0-9]+ % of its "
      "motion "
      "is clear, .+ - .+, [0-9.]+ m (below|above) the margin, in [0-9.]+ s)");
  EXPECT_TRUE(eventually([&] { return std::regex_search(watch.output(), line); }))
      << watch.output();

  robot.signal(SIGTERM);
  EXPECT_EQ(robot.wait(), 0);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  ChildProcess replay(kReplay, {"check", run, "--compare"});
  EXPECT_EQ(replay.wait(), 0) << replay.output();
}

}  // namespace
}  // namespace clearance::test
