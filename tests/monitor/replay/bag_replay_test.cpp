// Offline replays of bags and joint logs. They give the same ticks as joint states sent to the
// daemon, at the daemon's rate, and two replays give the same bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "monitor/recording/log_recording.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/replay/report_recorder.hpp"
#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;
constexpr double kWall = 5.0;  // x coordinate, m

double shoulder_at(double seconds) { return std::sin(seconds); }

// Joint states every `period_ms`, those of the arm and of the finger separately; the cart by /tf.
std::vector<RosMessage> motion(int count, int period_ms) {
  std::vector<RosMessage> messages;
  for (int i = 0; i < count; ++i) {
    const std::int64_t t = kStart + i * period_ms * kMs;
    const double s = 1e-9 * static_cast<double>(t - kStart);
    messages.push_back(
        joint_state(t, t - 100'000, {{"elbow", "shoulder"}, {0.3 * s, shoulder_at(s)}}));
    messages.push_back(joint_state(t + 1000, t, {{"push"}, {0.1}}, "/finger/joint_states"));
    messages.push_back(transforms(t + 2000, t, {{"world", "cart", {-3, 0, 0.1 * s}}}));
  }
  return messages;
}

class BagReplay : public testing::Test {
 protected:
  OfflineReplay replay(const std::string& name, const OfflineReplayOptions& options = {},
                       const std::function<void(const ReplayedTick&)>& on_tick = {}) {
    return replay_offline(cell, folder / name, options, on_tick);
  }
  std::string bytes_of_replay(const std::string& name, const OfflineReplayOptions& options = {}) {
    ReportRecorder out(folder / "out.mcap", cell);
    const OfflineReplay done =
        replay(name, options, [&out](const ReplayedTick& tick) { out.add(tick); });
    EXPECT_TRUE(done.ok()) << done.text();
    EXPECT_TRUE(out.close());
    return read_text(folder / "out.mcap");
  }
  std::uint32_t pair_of(const std::string& a, const std::string& b) const {
    for (std::uint32_t i = 0; i < scene.pairs.size(); ++i) {
      const auto& [first, second, publish] = scene.pairs[i];
      const std::string one = scene.objects[first].name, other = scene.objects[second].name;
      if ((one == a && other == b) || (one == b && other == a)) return i;
    }
    ADD_FAILURE() << a << b;
    return 0;
  }

  ScratchFolder folder;
  Cell cell{scara_cell(", age_limit_ms: 30")};
  Scene& scene = cell.scene;
};

TEST_F(BagReplay, TicksAtTheCellsRateAlsoBetweenMessages) {
  write_mcap_bag(folder / "bag.mcap", motion(101, 10));
  std::uint64_t ticks = 0;
  std::int64_t last_ns = 0;
  const OfflineReplay done = replay("bag.mcap", {}, [&](const ReplayedTick& tick) {
    if (ticks++ > 0) {
      EXPECT_EQ(last_ns + kMs, tick.report.now_ns);
    }
    last_ns = tick.report.now_ns;
  });
  EXPECT_TRUE(done.ok()) << done.text();
  EXPECT_EQ(1002u, ticks);  // the last message is 2 us after a tick
  EXPECT_EQ(3u * 101, done.batches);
  EXPECT_EQ(kStart, done.first_ns);
}

TEST_F(BagReplay, OfZeroHertzTicksOnlyWhenSomethingCame) {
  write_mcap_bag(folder / "bag.mcap", motion(101, 10));
  const OfflineReplay done = replay("bag.mcap", {.tick_hz = 0.0});
  EXPECT_EQ(3u * 101, done.ticks);
}

// Closed form: the upper arm, a box, swings in front of the wall.
TEST_F(BagReplay, DistancesAreThoseOfTheJointsInTheBag) {
  write_mcap_bag(folder / "bag.mcap", motion(200, 5));
  int checked = 0;
  const std::uint32_t pair = pair_of("upper", "wall");
  replay("bag.mcap", {.tick_hz = 200.0}, [&](const ReplayedTick& tick) {
    if (tick.report.now_ns > kStart + 199 * 5 * kMs) return;  // after the last angle
    const PairReport upper = tick.monitor.pair(pair);
    const double angle = shoulder_at(1e-9 * static_cast<double>(tick.report.now_ns - kStart));
    const double reach = 0.9 * std::cos(angle) + 0.05 * std::abs(std::sin(angle));
    EXPECT_LE(upper.lower, kWall - reach + 1e-12);
    EXPECT_GE(upper.upper, kWall - reach - 1e-12);
    ++checked;
  });
  EXPECT_GT(checked, 150);
}

// Joints that come every 100 ms are late after 30 ms, as in live operation, and a regression test
// shows it.
TEST_F(BagReplay, StalenessShowsBetweenMessagesAsItDoesLive) {
  std::vector<RosMessage> messages = motion(30, 100);
  // all at the same time
  for (RosMessage& message : messages) message.log_ns -= message.log_ns % kMs;
  write_mcap_bag(folder / "bag.mcap", messages);
  const std::uint32_t pair = pair_of("upper", "wall");
  int stale = 0, fresh = 0;
  const OfflineReplay done =
      replay("bag.mcap", {.expect_min_distance = 0.01}, [&](const ReplayedTick& tick) {
        const bool late = tick.monitor.pair(pair).status == PairStatus::kStale;
        late ? ++stale : ++fresh;
      });
  EXPECT_GT(stale, 1800);
  EXPECT_GT(fresh, 800);
  EXPECT_FALSE(done.ok());
  EXPECT_THAT(
      done.notes,
      Contains(HasSubstr("joint states from '/joint_states' come at 10.0 Hz, every 100 ms")));
  const OfflineReplay only_samples =
      replay("bag.mcap", {.tick_hz = 0.0, .expect_min_distance = 0.01});
  EXPECT_TRUE(only_samples.ok()) << only_samples.text();
}

// The recorder went on for two seconds in which nothing of the robot came.
TEST_F(BagReplay, RunsToTheLastMessageAlsoIfNothingMovesInIt) {
  std::vector<RosMessage> messages = motion(30, 10);
  const std::int64_t end_ns = kStart + 30 * 10 * kMs + 2'000 * kMs;
  for (std::int64_t t = kStart + 300 * kMs; t <= end_ns; t += 50 * kMs) {
    messages.push_back(joint_state(t, t, {{"lid"}, {0.1}}));
    messages.push_back(transforms(t, t, {{"world", "lid", {1, 0, 0}}}));
  }
  write_mcap_bag(folder / "bag.mcap", messages);
  const OfflineReplay done = replay("bag.mcap", {.expect_min_distance = 0.01});
  EXPECT_FALSE(done.ok());
  EXPECT_GE(done.last_ns, end_ns - kMs);
}

TEST_F(BagReplay, OneBagInMcapInSqliteAndConvertedGivesTheSameBytesTwice) {
  write_mcap_bag(folder / "bag.mcap", motion(100, 7));
  write_sqlite_bag(folder / "bag.db3", motion(100, 7));
  const std::string once = bytes_of_replay("bag.mcap");
  EXPECT_EQ(once, bytes_of_replay("bag.mcap"));
  EXPECT_EQ(once, bytes_of_replay("bag.db3"));
  const LogRecordingResult converted = record_log(folder / "bag.db3", folder / "run.mcap", cell);
  EXPECT_EQ("", converted.error);
  EXPECT_EQ(300u, converted.batches);
  EXPECT_EQ(once, bytes_of_replay("run.mcap", {.tick_hz = scene.rate_hz}));
}

TEST_F(BagReplay, AJointTableIsTheBagOfItsRows) {
  std::string table = "t_ns,shoulder,elbow,push\n";
  std::vector<RosMessage> messages;
  for (int i = 0; i < 50; ++i) {
    const std::int64_t t = kStart + i * 4 * kMs;
    const double angle = 0.01 * i;
    table += fmt::format("{},{:.17g},{:.17g},0.1\n", t, angle, -angle);
    messages.push_back(joint_state(t, t, {{"shoulder", "elbow", "push"}, {angle, -angle, 0.1}}));
  }
  write_text(folder / "log.csv", table);
  write_mcap_bag(folder / "bag.mcap", messages);
  const auto lowest_of = [&](const std::string& name) {
    std::vector<double> lower;
    const OfflineReplay done =
        replay(name, {}, [&](const ReplayedTick& tick) { lower.push_back(tick.report.lower_all); });
    EXPECT_TRUE(done.ok()) << done.text();
    return lower;
  };
  const std::vector<double> of_table = lowest_of("log.csv");
  EXPECT_EQ(197u, of_table.size());
  EXPECT_EQ(of_table, lowest_of("bag.mcap"));
}

TEST_F(BagReplay, ALongPauseCostsTenSecondsOfTicks) {
  std::vector<RosMessage> messages = motion(10, 10);
  for (RosMessage late : motion(10, 10)) {
    late.log_ns += 7'200'000 * kMs;
    messages.push_back(late);
  }
  write_mcap_bag(folder / "bag.mcap", messages);
  const OfflineReplay done = replay("bag.mcap");
  EXPECT_LT(done.ticks, 11'000u);
  EXPECT_GT(done.ticks, 10'000u);
  EXPECT_THAT(done.notes, Contains(HasSubstr("1 pause was longer than 20 s")));
}

TEST_F(BagReplay, RefusesWhatCannotBeAsked) {
  write_mcap_bag(folder / "bag.mcap", motion(10, 10));
  EXPECT_THAT(replay("bag.mcap", {.compare = Comparison::kBits}).error,
              HasSubstr("nothing to compare with"));
  EXPECT_THAT(replay("bag.mcap", {.joints = {{"elbo", 1.0}}}).error, HasSubstr("'elbo'"));
  EXPECT_THAT(replay("bag.mcap", {.joint_topics = {"/nowhere"}}).notes,
              Contains(HasSubstr("is unknown: shoulder, elbow, push;")));
  write_mcap_bag(folder / "other.mcap", {ros_text(kStart, "x", "/chatter")});
  EXPECT_THAT(replay("other.mcap").error, HasSubstr("nothing that moves this cell"));
  const Cell bench{bench_cell()};
  record_run(bench, folder / "ours.mcap", {.ticks = 5});
  EXPECT_THAT(replay_offline(bench, folder / "ours.mcap", {.tick_hz = 100.0}).error,
              HasSubstr("no other rate of ticks can be asked for"));
}

TEST_F(BagReplay, ADamagedBagIsReplayedUpToTheDamage) {
  write_mcap_bag(folder / "bag.mcap", motion(4000, 5));
  const std::string whole = read_text(folder / "bag.mcap");
  write_text(folder / "bag.mcap", whole.substr(0, whole.size() / 2));
  const OfflineReplay done = replay("bag.mcap");
  EXPECT_GT(done.ticks, 5000u);
  EXPECT_THAT(done.damage, HasSubstr("cut off"));
}

}  // namespace
}  // namespace clearance::test
