// Speed and separation monitoring as a client meets it: over DDS, in a recording, and on a
// terminal.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <map>
#include <string>
#include <thread>

#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/shared/take_next.hpp"
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
  const auto next = [&] { return eventually([&] { return take_next(reader, sample); }); };
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

// The oracle: S_p of a robot that stands, with the delay and the ages that the same tick states.
TEST(SeparationOverDds, CountsTheMeasuredDelayAndIsFailSafeBeyondTheLimitAsAReplayIs) {
  constexpr double kStated = 0.06;                      // s
  constexpr std::int64_t kResponseLimit = 150'000'000;  // ns, below the age limit
  std::string text = kPersonAndRobot;
  const auto replace = [&text](const std::string& what, const std::string& by) {
    text.replace(text.find(what), what.size(), by);
  };
  replace("reaction_time_ms: 100", "controller_time_ms: 60");
  replace("rate_hz: 200", "rate_hz: 200\nresponse_limit_ms: 150");
  const CellFile cell(text.c_str());
  const Cell read = cell.cell();
  const DdsOptions dds = own_dds();
  const ScratchFolder folder;
  const std::string run = (folder / "run.mcap").string();
  Participant client(dds);
  Poses poses(client, read);
  ChildProcess daemon(kDaemon, with({cell.path(), "--record", run}, dds_arguments(dds)));
  for (int i = 0; i < 60; ++i) {
    poses.send(0.0);
    std::this_thread::sleep_for(std::chrono::milliseconds(i % 20 == 19 ? 250 : 10));
  }
  EXPECT_TRUE(eventually([&] { return daemon.wrote("response-late"); })) << daemon.output();
  EXPECT_TRUE(eventually([&] { return daemon.wrote("response-back"); })) << daemon.output();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();

  const std::vector<Kept> messages = messages_of(run);
  std::map<std::uint64_t, std::int64_t> delays;  // by cycle
  for (const Kept& message : messages) {
    if (message.kind != TopicKind::kDistances) continue;
    const auto report = decoded<clearance_msg_Distances>(message);
    delays[report->cycle] = report->report_delay_ns;
  }
  EXPECT_EQ(delays.at(1), TickTime::kNotMeasured) << "nothing was published yet";
  int known = 0, beyond = 0;
  for (const Kept& message : messages) {
    if (message.kind != TopicKind::kSeparation) continue;
    const auto separation = decoded<clearance_msg_Separation>(message);
    const std::int64_t delay = delays.at(separation->cycle);
    const clearance_msg_PairSeparation& pair = separation->pairs._buffer[0];
    const std::int64_t age = std::max(pair.age_human_ns, pair.age_robot_ns);
    if (age < 0) continue;
    if (delay < 0 || age + delay > kResponseLimit) {
      ++beyond;
      EXPECT_EQ(pair.validity, 0) << separation->cycle;
      EXPECT_EQ(separation->zones._buffer[0].scaling, 0.0);
      continue;
    }
    if (pair.validity == 0) continue;  // a first pose gives no velocity
    ++known;
    const double time = kStated + 1e-9 * static_cast<double>(delay + pair.age_human_ns);
    EXPECT_NEAR(pair.protective_distance, 0.1 + 1.6 * time, 1e-9) << separation->cycle;
  }
  EXPECT_GT(known, 10);
  EXPECT_GT(beyond, 10);
  ChildProcess replay(kReplay, {"check", run, "--compare"});
  EXPECT_EQ(replay.wait(), 0) << replay.output();
}

}  // namespace
}  // namespace clearance::test
