// Bags of a simulation: joints and pictures are recorded before the message of their time.
//
// Oracle: the closed form of the motion at the time of each tick.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "monitor/replay/offline_replay.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/recording/ros_camera.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::simulated_bag_test {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)
using testing::Contains;
using testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kBegin = 100'000 * kMs;                // of the simulation
constexpr std::int64_t kTrueBegin = 1'700'000'000'000 * kMs;  // when it was recorded
constexpr std::int64_t kClockStep = 25 * kMs, kJointStep = 5 * kMs;
constexpr double kWall = 5.0;  // x coordinate, m

double shoulder_at(std::int64_t t) { return std::sin(1e-9 * static_cast<double>(t - kBegin)); }

RosMessage clock_message(std::int64_t log_ns, std::int64_t time_ns) {
  RosCdr cdr;
  cdr.number(static_cast<std::int32_t>(time_ns / (1000 * kMs)));
  cdr.number(static_cast<std::uint32_t>(time_ns % (1000 * kMs)));
  return {"/clock", "rosgraph_msgs/msg/Clock", log_ns, cdr.bytes()};
}

RosMessage joints_at(std::int64_t log_ns, std::int64_t stamp) {
  return joint_state(log_ns, stamp, {{"shoulder", "elbow"}, {shoulder_at(stamp), 0.0}});
}

// How a bag was recorded.
struct Recorder {
  const char* name;
  bool has_clock;       // /clock is among its topics
  bool has_true_times;  // of recording; otherwise those of the clock
  double factor = 1.0;  // simulated time in true time
  // The message of a time is sent a whole step after the joints of that time but for 1 ms.
  [[nodiscard]] std::int64_t log_ns(std::int64_t t) const {
    if (!has_true_times) return kBegin + (t - kBegin - 1) / kClockStep * kClockStep;
    return kTrueBegin + std::llround(static_cast<double>(t - kBegin) / factor);
  }
};

std::vector<RosMessage> motion(const Recorder& recorder, int count, std::int64_t begin = kBegin) {
  std::vector<RosMessage> messages;
  for (int i = 0; i < count; ++i) {
    const std::int64_t stamp = begin + i * kJointStep, since = i * kJointStep;
    messages.push_back(joints_at(recorder.log_ns(kBegin + since), stamp));
    if (!recorder.has_clock || since % kClockStep != 0) continue;
    messages.push_back(clock_message(recorder.log_ns(kBegin + since + 24 * kMs), stamp));
  }
  std::ranges::stable_sort(messages, {}, &RosMessage::log_ns);
  return messages;
}

class SimulatedBag : public testing::Test {
 protected:
  OfflineReplay replay(const std::vector<RosMessage>& messages,
                       const std::function<void(const ReplayedTick&)>& on_tick = {}) {
    write_mcap_bag(folder / "bag.mcap", messages);
    cell.ros.use_sim_time = use_sim_time;
    return replay_offline(cell, folder / "bag.mcap",
                          {.tick_hz = 1e9 / static_cast<double>(kJointStep), .evaluate_all = true},
                          on_tick);
  }
  std::uint32_t pair_of(const std::string& a, const std::string& b) const {
    for (std::uint32_t i = 0; i < cell.scene.pairs.size(); ++i) {
      const ObjectPair& pair = cell.scene.pairs[i];
      const std::string &one = cell.scene.objects[pair.first].name,
                        &other = cell.scene.objects[pair.second].name;
      if ((one == a && other == b) || (one == b && other == a)) return i;
    }
    ADD_FAILURE() << a << b;
    return 0;
  }
  static std::uint64_t refused(const OfflineReplay& done) {
    return std::accumulate(done.rejected.begin(), done.rejected.end(), std::uint64_t{0});
  }

  ScratchFolder folder;
  bool use_sim_time = true;
  Cell cell{scara_cell(", age_limit_ms: 30")};
};

class SimulatedBags : public SimulatedBag, public testing::WithParamInterface<Recorder> {};
INSTANTIATE_TEST_SUITE_P(Recorders, SimulatedBags,
                         testing::Values(Recorder{"WithTheTimeOfTheClock", false, false},
                                         Recorder{"WithTheTimeOfTheClockAndItsMessages", true,
                                                  false},
                                         Recorder{"WithTrueTimesAndAClock", true, true},
                                         Recorder{"WithTrueTimesAndASlowClock", true, true, 0.25}),
                         [](const auto& recorder) { return recorder.param.name; });

// The upper arm, a box, swings in front of the wall.
TEST_P(SimulatedBags, AreUsedAtTheTimesOfTheirStamps) {
  constexpr int kCount = 400;
  const std::uint32_t pair = pair_of("upper", "wall");
  int ticks = 0;
  const OfflineReplay done = replay(motion(GetParam(), kCount), [&](const ReplayedTick& tick) {
    EXPECT_EQ(tick.report.now_ns, kBegin + ticks++ * kJointStep);
    const double angle = shoulder_at(tick.report.now_ns);
    const double exact = kWall - 0.9 * std::cos(angle) - 0.05 * std::abs(std::sin(angle));
    const PairReport found = tick.monitor.pair(pair);
    EXPECT_LE(found.lower, exact + 1e-12);
    EXPECT_GE(found.upper, exact - 1e-12);
    EXPECT_LT(found.upper - found.lower, 1e-6);
  });
  EXPECT_TRUE(done.ok()) << done.text();
  EXPECT_EQ(ticks, kCount);
  EXPECT_EQ(done.damage, "");
  EXPECT_EQ(refused(done), 0u) << done.text();
}

TEST_F(SimulatedBag, IsNotUsedByTheCellOfARealRobotAndTheNoteNamesTheOption) {
  use_sim_time = false;
  const OfflineReplay done = replay(motion({"", false, false}, 100));
  EXPECT_GT(done.rejected[static_cast<std::size_t>(Reject::kFuture)], 0u);
  EXPECT_THAT(done.notes, Contains(HasSubstr("--use-sim-time")));
}

TEST_F(SimulatedBag, RefusesStampsThatAreFarAheadAndUsesTheOthers) {
  constexpr int kCount = 200;
  std::vector<RosMessage> messages;
  for (const RosMessage& message : motion({"", false, false}, kCount)) {
    messages.push_back(message);
    messages.push_back(joint_state(message.log_ns, message.log_ns + 400 * kMs, {{"push"}, {0.1}}));
  }
  const std::uint32_t pair = pair_of("upper", "wall");
  std::int64_t last_ns = 0;
  const OfflineReplay done = replay(messages, [&](const ReplayedTick& tick) {
    last_ns = tick.report.now_ns;
    EXPECT_GT(tick.monitor.pair(pair).lower, 0.0);
  });
  EXPECT_EQ(done.rejected[static_cast<std::size_t>(Reject::kFuture)], std::uint64_t{kCount});
  EXPECT_EQ(refused(done), std::uint64_t{kCount});
  EXPECT_EQ(last_ns, kBegin + (kCount - 1) * kJointStep);
}

TEST_F(SimulatedBag, IsReplayedUntilItsClockGoesBack) {
  const Recorder recorder{"", true, true};
  std::vector<RosMessage> messages = motion(recorder, 100);
  const OfflineReplay first = replay(messages);
  messages.push_back(clock_message(kTrueBegin + 1'900 * kMs, kBegin - 90'000 * kMs));
  for (RosMessage message : motion(recorder, 100, kBegin - 90'000 * kMs)) {
    message.log_ns += 2'000 * kMs;
    messages.push_back(message);
  }
  const OfflineReplay both = replay(messages);
  EXPECT_EQ(first.damage, "");
  EXPECT_EQ(both.ticks, first.ticks);
  EXPECT_THAT(both.damage, HasSubstr("/clock goes back from 100.475 s to 10.000 s"));
}

// Nothing else is in it that leads the time.
TEST_F(SimulatedBag, HasPicturesBeforeTheMessageOfTheirTimeByACameraOnTf) {
  const PinholeCamera view{8, 6, 8.0, 8.0, 4.0, 3.0};
  cell = read_good(
      "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: map}\n"
      "objects:\n  - {name: post, fixed: true, sphere: {radius: 0.1}}\n"
      "sensors:\n  - {name: eye, depth_image: /cam/depth, size: [8, 6], depth_error: {constant: "
      "0.01}, range: [0.3, 4], age_limit_ms: 150, mount: {frame: mast}}\n"
      "pairs: [{between: [post, eye], publish: true}]\n");
  std::vector<RosMessage> messages{camera_info(kBegin, view)};
  constexpr int kPictures = 40;
  for (int i = 0; i <= 2 * kPictures; ++i) {
    const std::int64_t stamp = kBegin + i * kClockStep;
    const std::int64_t before = std::max(stamp - kClockStep, kBegin);
    messages.push_back(transforms(before, stamp, {{"map", "mast", {0, 0, 3}, {1, 0, 0, 0}}}));
    if (i % 2 == 1) continue;
    messages.push_back(
        depth_image(stamp, view, std::vector<float>(48, 1.0F + 0.01F * static_cast<float>(i))));
    messages.back().log_ns = before;
  }
  int known = 0, unknown = 0;
  const OfflineReplay done = replay(messages, [&](const ReplayedTick& tick) {
    const bool is_known = tick.report.pairs.at(0).lower > -kInfinity;
    unknown += known > 0 && !is_known ? 1 : 0;
    known += is_known ? 1 : 0;
  });
  EXPECT_TRUE(done.ok()) << done.text();
  EXPECT_GT(known, 9 * kPictures) << done.text();
  EXPECT_EQ(unknown, 0) << done.text();
  EXPECT_EQ(refused(done), 0u) << done.text();
}

}  // namespace
}  // namespace clearance::simulated_bag_test
