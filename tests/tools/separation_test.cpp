// Speed and separation monitoring as a client meets it: over DDS, in a recording, and on a
// terminal.
#include <gtest/gtest.h>

#include <csignal>

#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/person_and_robot.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

// A person who stands 2 m in front of a standing robot, at a distance of 1.7 m.
TEST(SeparationOverDds, ComesWithEveryTickAndIsUnknownWhenThePosesEnd) {
  const CellFile cell(kPersonAndRobot);
  const Cell read = cell.cell();
  const DdsOptions dds = own_dds();
  const ScratchFolder folder;
  const std::string run = (folder / "run.mcap").string();
  Participant client(dds);
  Poses poses(client, read);
  const dds_entity_t reader = client.reader(TopicKind::kSeparation, read.topics.separation, 4096);
  ChildProcess watch(kWatch, with({"--plain"}, dds_arguments(dds)));
  const std::string thinned = (folder / "thinned.mcap").string();
  ChildProcess recorder(kRecord, with({"-o", thinned, "--every", "7"}, dds_arguments(dds)));
  ChildProcess daemon(kDaemon, with({cell.path(), "--record", run}, dds_arguments(dds)));

  Sample<clearance_msg_Separation> sample;
  const auto next = [&] {
    void* pointer = &*sample;
    dds_sample_info_t info{};
    return eventually(
        [&] { return dds_take(reader, &pointer, &info, 1, 1) == 1 && info.valid_data; });
  };
  const auto wait_for = [&](SeparationValidity validity, bool sending) {
    for (int i = 0; i < 2000; ++i) {
      if (sending && i % 10 == 0) poses.send(0.0);
      if (!next()) return false;
      if (sample->zones._buffer[0].validity == static_cast<std::uint8_t>(validity)) return true;
    }
    return false;
  };
  ASSERT_TRUE(next()) << daemon.output();
  EXPECT_EQ(sample->zones._buffer[0].validity, 0);
  EXPECT_EQ(sample->zones._buffer[0].scaling, 0.0);
  ASSERT_TRUE(wait_for(SeparationValidity::kMeasured, true)) << daemon.output();
  ASSERT_EQ(sample->zones._length, 1u);
  ASSERT_EQ(sample->pairs._length, 1u);
  const clearance_msg_PairSeparation& pair = sample->pairs._buffer[0];
  EXPECT_NE(sample->daemon, 0u);
  EXPECT_EQ(sample->scene_revision, read.scene.revision);
  EXPECT_GE(sample->publish_ns, sample->now_ns);
  EXPECT_NEAR(pair.clearance, 1.7, 1e-9);
  // The protective distance is C plus the distance at 1.6 m/s during the robot's reaction and the
  // age of the pose.
  const double age_s = 1e-9 * static_cast<double>(pair.age_human_ns);
  EXPECT_NEAR(pair.protective_distance, 0.1 + 1.6 * (0.1 + age_s), 1e-9);
  EXPECT_EQ(pair.scaling, 1.0);
  const std::uint64_t cycle = sample->cycle;
  ASSERT_TRUE(next());
  EXPECT_EQ(sample->cycle, cycle + 1);
  EXPECT_TRUE(eventually([&] {
    poses.send(0.0);
    return watch.wrote("people: scaling 1.00, robot up to ");
  })) << watch.output();

  ASSERT_TRUE(wait_for(SeparationValidity::kUnknown, false)) << daemon.output();
  EXPECT_EQ(sample->zones._buffer[0].scaling, 0.0);
  EXPECT_TRUE(eventually([&] {
    return watch.wrote("people: not known, scaling 0, person - robot");
  })) << watch.output();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  const std::vector<Kept> messages = messages_of(run);
  EXPECT_EQ(std::ranges::count(messages, TopicKind::kSeparation, &Kept::kind),
            std::ranges::count(messages, TopicKind::kDistances, &Kept::kind));
  ChildProcess replay(kReplay, {"check", run, "--compare"});
  EXPECT_EQ(replay.wait(), 0) << replay.output();

  recorder.signal(SIGINT);
  EXPECT_EQ(recorder.wait(), 0) << recorder.output();
  int whole = 0;
  for (const Kept& message : messages_of(thinned)) {
    if (message.kind != TopicKind::kSeparation) continue;
    const auto separation = decoded<clearance_msg_Separation>(message);
    EXPECT_EQ(separation->cycle % 7 == 0, separation->pairs._length > 0);
    EXPECT_EQ(separation->zones._length, 1u);
    whole += separation->pairs._length > 0;
  }
  EXPECT_GT(whole, 2);
}

}  // namespace
}  // namespace clearance::test
