// Joint states on the wire, in a recording, and in its replay.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "monitor/loop/tick_loop.hpp"
#include "monitor/recording/recorder.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/replay/report_recorder.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::test {
namespace {

PoseBatch batch_of(const std::string& source, std::uint64_t sequence_number,
                   std::vector<JointSample> joints) {
  PoseBatch batch{SourceName(source), sequence_number, 0, {}};
  batch.joints = std::move(joints);
  return batch;
}

PoseBatch through_the_wire(const PoseBatch& batch, const Scene& scene) {
  CdrEncoder encoder;
  const Sample<clearance_msg_JointStates> sent = make_joint_states(batch, scene);
  Sample<clearance_msg_JointStates> came;
  EXPECT_TRUE(CdrDecoder().decode(encoder.encode(*sent), came));
  PoseBatch out;
  from_wire(*came, JointNames(scene), out);
  return out;
}

TEST(JointStates, ComeThroughTheWireAsTheyWere) {
  const Scene scene = scara_cell();
  auto all = joints(0.1, -0.2, 0.3, kStart);
  for (JointSample& sample : all) sample.has_velocity = sample.stopping = true;
  all[1].velocity = 0.7;
  const PoseBatch out = through_the_wire(batch_of("arm", 7, {all.begin(), all.end()}), scene);
  EXPECT_EQ(out.source.view(), "arm");
  EXPECT_EQ(out.sequence_number, 7u);
  ASSERT_EQ(out.joints.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(out.joints[i].variable, i);
    EXPECT_EQ(out.joints[i].position, all[i].position);
    EXPECT_EQ(out.joints[i].stamp_ns, kStart);
    EXPECT_TRUE(out.joints[i].has_velocity);
    EXPECT_TRUE(out.joints[i].stopping);
  }
  EXPECT_EQ(out.joints[1].velocity, 0.7);
}

TEST(JointStates, OfRosHaveTheStampThatIsChosenForThem) {
  const Scene scene = scara_cell();
  Sample<sensor_msgs_msg_dds__JointState_> states;
  reserve_sequence(states->name, 1);
  reserve_sequence(states->position, 1);
  states->name._buffer[states->name._length++] = dds_string_dup("elbow");
  states->position._buffer[states->position._length++] = 0.5;
  PoseBatch out;
  from_wire(*states, JointNames(scene), kStart, out);
  ASSERT_EQ(out.joints.size(), 1u);
  EXPECT_EQ(out.joints[0].stamp_ns, kStart);
  EXPECT_EQ(out.joints[0].position, 0.5);
}

TEST(JointStates, NamesOfNoUseAreLeftOutAndUnknownOnesAreOfNoVariable) {
  Scene scene = scara_cell();
  scene.robots[0].joints.emplace_back().name = "bolt";
  Sample<clearance_msg_JointStates> states;
  reserve_sequence(states->names, 4);
  reserve_sequence(states->positions, 2);
  for (const char* name : {"bolt", "push", "shoulder", "typo"}) {
    states->names._buffer[states->names._length++] = dds_string_dup(name);
  }
  states->positions._length = 2;
  states->positions._buffer[1] = 0.25;
  PoseBatch out;
  from_wire(*states, JointNames(scene), out);
  ASSERT_EQ(out.joints.size(), 3u);
  EXPECT_EQ(out.joints[0].variable, 2u);
  EXPECT_EQ(out.joints[0].position, 0.25);
  EXPECT_FALSE(out.joints[0].has_velocity);
  EXPECT_FALSE(out.joints[0].stopping);
  EXPECT_EQ(out.joints[1].variable, 0u);
  EXPECT_TRUE(std::isnan(out.joints[1].position));
  EXPECT_EQ(out.joints[2].variable, JointNames::kUnknown);
  // The batch as it is recorded.
  const PoseBatch again = through_the_wire(out, scene);
  EXPECT_EQ(again.joints[2].variable, JointNames::kUnknown);
}

// The arm and its finger are sent by two drivers, occasionally with an unknown name or an invalid
// number.
void record_joints(const Cell& cell, const std::filesystem::path& file) {
  const Scene& scene = cell.scene;
  Monitor monitor(scene);
  Recorder recorder(file, cell, kStart);
  SourceNumbers numbers(scene);
  Random random(3);
  std::uint64_t sequence[2] = {0, 0};
  for (int tick = 0; tick < 300; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    std::vector<JointSample> samples;
    std::vector<SourceUse> uses;
    for (std::uint32_t source = 0; source < 2; ++source) {
      if (!random.chance(0.6)) continue;
      const std::int64_t stamp = now - random.integer(0, 900'000);
      std::vector<JointSample> sent =
          source == 0
              ? std::vector{joint(0, std::sin(0.01 * tick), stamp), joint(1, 0.002 * tick, stamp)}
              : std::vector{joint(2, 0.1, stamp)};
      if (random.chance(0.1)) sent.push_back(joint(JointNames::kUnknown, 1.0, stamp));
      const double infinite = std::numeric_limits<double>::infinity();
      if (random.chance(0.1) && source == 0) sent[1].position = infinite;
      if (random.chance(0.1) && source == 1) sent.push_back(joint(1, infinite, stamp));
      PoseBatch batch = batch_of(source == 0 ? "arm" : "gripper", ++sequence[source], sent);
      recorder.poses(batch);
      uses.push_back({batch.source, batch.sequence_number});
      for (JointSample& sample : sent) {
        sample.source = numbers.of(batch.source);
        samples.push_back(sample);
      }
    }
    recorder.report(monitor.tick({}, samples, now), uses);
  }
  ASSERT_TRUE(recorder.close()) << recorder.error();
}

TEST(JointStates, ARecordingReplaysBitForBitAndTwiceToTheSameBytes) {
  const Cell cell{scara_cell()};
  const ScratchFolder folder;
  record_joints(cell, folder / "run.mcap");
  const auto kinds = messages_of(folder / "run.mcap");
  EXPECT_GT(std::ranges::count(kinds, TopicKind::kJointStates, &Kept::kind), 200);
  for (const char* name : {"a.mcap", "b.mcap"}) {
    ReportRecorder out(folder / name, cell);
    const OfflineReplay replay =
        replay_offline(cell, folder / "run.mcap", {.compare = Comparison::kBits},
                       [&out](const ReplayedTick& tick) { out.add(tick); });
    EXPECT_TRUE(replay.ok()) << replay.text();
    EXPECT_EQ(replay.compared, 300u);
    ASSERT_TRUE(out.close());
  }
  EXPECT_EQ(read_text(folder / "a.mcap"), read_text(folder / "b.mcap"));
}

}  // namespace
}  // namespace clearance::test
