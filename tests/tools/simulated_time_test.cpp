// The daemon in the time of a simulation, over real DDS: a publisher of /clock, joints, tf and a
// camera that rides on a frame of tf. The simulation runs slower and faster than the true time, is
// paused, falls silent and begins anew.
//
// Oracle: the closed form of the distance at the simulated time of each report.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <string>
#include <vector>

#include "tests/shared/ros_frames.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/tools/camera_daemon.hpp"

namespace clearance::test {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000, kOneSecond = 1000 * kMillisecond;
constexpr std::int64_t kFirstRun = 1000 * kOneSecond, kSecondRun = 2 * kOneSecond;
constexpr int kStepMs = 4;            // between two messages of the clock
constexpr double kFastest = 0.7;      // of the wall, m/s
constexpr double kDepthError = 1e-6;  // of float32, and of the place of the camera

// A wall that rises and sinks below the ball, otherwise in each run.
double wall_at(std::int64_t t) {
  const double s = 1e-9 * static_cast<double>(t);
  return 1.0 + 0.2 * std::sin(3.0 * s + (t < kFirstRun ? 2.0 : 0.0));
}
double camera_at(std::int64_t t) { return kHeight + 0.1 * std::sin(1e-9 * static_cast<double>(t)); }
// From the ball to the nearest place of the wall that its picture allows.
double distance_at(std::int64_t t) { return 2.0 - kRadius - kError - wall_at(t); }

class SimulatedDaemon : public DaemonCameras {
 protected:
  void begin(const std::string& sensor_keys, const std::vector<std::string>& more) {
    start(kImage + ", age_limit_ms: 3000, max_speed: " + std::to_string(kFastest) + sensor_keys,
          more);
    ASSERT_TRUE(step_until(
        kStepMs, [] {}, told("sim-time-awaited")))
        << daemon->output();
    ASSERT_TRUE(eventually([&] { return matched_readers(clock_) > 0; }));
    ASSERT_TRUE(camera_.is_heard() && frames_.is_heard() && fixed_.is_heard());
    fixed_.send({{"rail", "camera", Vec3::Zero(), {1, 0, 0, 0}}});
    last_ = std::chrono::steady_clock::now();
  }
  void tell_time() {
    Sample<rosgraph_msgs_msg_dds__Clock_> message;
    message->clock = {static_cast<std::int32_t>(now_ / kOneSecond),
                      static_cast<std::uint32_t>(now_ % kOneSecond)};
    ASSERT_EQ(dds_write(clock_, &*message), DDS_RETCODE_OK);
  }
  // The simulation goes on for the true time since the last call.
  void go_on() {
    const auto now = std::chrono::steady_clock::now();
    now_ += static_cast<std::int64_t>(
        factor_ * static_cast<double>(
                      std::chrono::duration_cast<std::chrono::nanoseconds>(now - last_).count()));
    last_ = now;
    tell_time();
    if (++steps_ % 5 == 0) send_picture();
  }
  void send_picture() {
    frames_.send_at(now_, {{"map", "rail", {0, 0, camera_at(now_)}}});
    camera_.send_image({.wall = camera_at(now_) - wall_at(now_), .ball = {}}, now_);
  }
  void stand_still() {
    last_ = std::chrono::steady_clock::now();
    tell_time();
  }
  [[nodiscard]] bool is_known() const {
    return report->pairs._length > 0 && pair("ball").lower > -kInfinity;
  }
  // Holds the last report against the truth at its simulated time.
  void check() {
    if (report->cycle == checked_ || !is_known()) return;
    checked_ = report->cycle;
    ++checks_;
    const double truth = distance_at(report->now_ns);
    EXPECT_LE(ball_pair().lower, truth + kDepthError) << "at " << report->now_ns << " of " << now_;
    EXPECT_GE(ball_pair().upper, truth - kDepthError) << "at " << report->now_ns << " of " << now_;
  }
  void play_until_checked(int checks) {
    const int until = checks_ + checks;
    ASSERT_TRUE(step_until(
        kStepMs,
        [&] {
          go_on();
          check();
        },
        [&] { return checks_ >= until; }, 60))
        << daemon->output();
  }

  double factor_ = 1.0;
  std::int64_t now_ = kFirstRun;
  dds_entity_t clock_ = client.ros_writer(kRosClock, ros_dds_name("/clock"));
  RosCamera camera_{client, {}};
  RosFrames frames_{client}, fixed_{client, RosFrames::Kind::kStatic};
  std::chrono::steady_clock::time_point last_;
  int steps_ = 0, checks_ = 0;
  std::uint64_t checked_ = 0;
};

class SimulatedDaemons : public SimulatedDaemon, public testing::WithParamInterface<double> {};
INSTANTIATE_TEST_SUITE_P(Factors, SimulatedDaemons, testing::Values(0.1, 10.0));

TEST_P(SimulatedDaemons, CertifyDistancesAtTheSimulatedTimeThroughAPauseAndANewBegin) {
  factor_ = GetParam();
  const std::string file = (folder / "run.mcap").string();
  begin("", {"--use-sim-time", "--record", file});
  play_until_checked(150);
  EXPECT_TRUE(daemon->tells("sim-time-heard")) << daemon->output();
  EXPECT_FALSE(daemon->told("other-clock")) << daemon->output();

  // A pause: the clock says the same time, nothing else is sent, and nothing ages.
  const std::int64_t paused = now_;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  step_until(
      kStepMs,
      [&] {
        stand_still();
        check();
      },
      [&] { return std::chrono::steady_clock::now() > end; });
  EXPECT_TRUE(is_known()) << daemon->output();
  EXPECT_LT(report->now_ns, paused + 250 * kMillisecond + kMillisecond);
  EXPECT_FALSE(daemon->told("sim-time-silent")) << daemon->output();
  last_ = std::chrono::steady_clock::now();
  play_until_checked(50);

  // A silence says nothing of the time that passes.
  ASSERT_TRUE(step_until(
      kStepMs, [] {},
      [&] { return daemon->told("sim-time-silent") && !is("ball", PairStatus::kConverged); }))
      << daemon->output();
  EXPECT_FALSE(is_known() && ball_pair().upper - ball_pair().lower < 3.0 * kFastest);
  last_ = std::chrono::steady_clock::now();
  play_until_checked(50);

  now_ = kSecondRun;
  last_ = std::chrono::steady_clock::now();
  ASSERT_TRUE(step_until(
      kStepMs,
      [&] {
        go_on();
        check();
      },
      [&] { return daemon->told("sim-time-back"); }))
      << daemon->output();
  play_until_checked(150);
  EXPECT_LT(report->now_ns, kFirstRun) << "the new time counts";

  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  // Times in a file do not go back: the second run has a file of its own.
  const std::string second = (folder / "run-2.mcap").string();
  for (const std::vector<std::string>& files : {std::vector{file}, std::vector{file, second}}) {
    ChildProcess compared(kReplay, with(with({"check"}, files), {"--compare"}));
    EXPECT_EQ(compared.wait(), 0) << compared.output();
    EXPECT_TRUE(compared.wrote("reports compared")) << compared.output();
  }
}

// A player of bags does so: all that is of a time comes a whole step before the message of it.
TEST_F(SimulatedDaemon, UsesWhatComesBeforeTheMessageOfItsTime) {
  constexpr int kPlayedMs = 25;
  const std::string file = (folder / "run.mcap").string();
  begin("", {"--use-sim-time", "--record", file});
  RosJoints joints(client);
  ASSERT_TRUE(joints.is_heard());
  int unknown = 0;
  bool is_heard = false;
  const auto send_joints = [&](std::int64_t stamp) {
    joints.send_at(stamp, {"shoulder", "elbow", "push"},
                   {0.5 * std::sin(1e-9 * static_cast<double>(stamp)), 0.1, 0.0});
  };
  const auto play = [&] {
    tell_time();
    now_ += kPlayedMs * kMillisecond;
    send_joints(now_);
    send_picture();
    check();
    const bool is_there = is_known() && pair("upper").lower > -kInfinity;
    unknown += is_heard && !is_there;
    is_heard = is_heard || is_there;
  };
  ASSERT_TRUE(step_until(
      kPlayedMs, play, [&] { return checks_ >= 100; }, 60))
      << daemon->output();
  EXPECT_TRUE(is_heard);
  EXPECT_EQ(unknown, 0) << daemon->output();
  const auto are_refused = [&] { return daemon->wrote("positions of joint shoulder, "); };
  EXPECT_FALSE(are_refused()) << daemon->output();

  const int before = checks_;
  const auto play_with_another_clock = [&] {
    play();
    send_joints(now_ + kOneSecond);
  };
  ASSERT_TRUE(step_until(kPlayedMs, play_with_another_clock, are_refused)) << daemon->output();
  EXPECT_TRUE(daemon->wrote(name(Reject::kFuture))) << daemon->output();
  ASSERT_TRUE(step_until(
      kPlayedMs, play, [&] { return checks_ >= before + 20; }, 60));

  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  ChildProcess compared(kReplay, {"check", file, "--compare"});
  EXPECT_EQ(compared.wait(), 0) << compared.output();
}

// The stamps of this camera are of a clock that nothing else has.
TEST_F(SimulatedDaemon, UsesTheTimeOfSendingForACameraThatStatesIt) {
  begin(", stamps: sent, stamp_error_ms: 500", {"--use-sim-time"});
  const auto step = [&] {
    go_on();
    frames_.send_at(now_, {{"map", "rail", {0, 0, kHeight}}});
    camera_.send_image({.wall = 2.0, .ball = {}}, 77 * kOneSecond + steps_);
  };
  ASSERT_TRUE(step_until(kStepMs, step, [&] { return is_known(); })) << daemon->output();
  EXPECT_LE(ball_pair().lower, 2.0 - kRadius - kError - 1.0 + kDepthError);
}

TEST_F(SimulatedDaemon, CountsOneOfTwoClocks) {
  begin("", {"--use-sim-time"});
  play_until_checked(10);
  const dds_entity_t other = client.ros_writer(kRosClock, ros_dds_name("/clock"));
  Sample<rosgraph_msgs_msg_dds__Clock_> message;
  message->clock = {5, 0};
  ASSERT_TRUE(step_until(
      kStepMs,
      [&] {
        go_on();
        check();
        ASSERT_EQ(dds_write(other, &*message), DDS_RETCODE_OK);
      },
      told("two-clocks")))
      << daemon->output();
  play_until_checked(50);
  EXPECT_FALSE(daemon->told("sim-time-back")) << daemon->output();
  dds_delete(other);
}

// A URDF alone needs no cell for either.
TEST_F(SimulatedDaemon, IsAskedForWithAUrdfAlone) {
  write_text(folder / "scara.urdf", kScaraUrdf);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--use-sim-time"}, {"--stamps", "sent"}}) {
    ChildProcess checked(kDaemon,
                         with({"--urdf", (folder / "scara.urdf").string(), "--check"}, more));
    EXPECT_EQ(checked.wait(), 0) << checked.output();
  }
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--stamps", "seen"}, {"--use-sim-time", "--partner", "left"}}) {
    ChildProcess refused(kDaemon, with({"--urdf", (folder / "scara.urdf").string()}, wrong));
    EXPECT_EQ(refused.wait(), 2) << refused.output();
  }
}

}  // namespace
}  // namespace clearance::test
