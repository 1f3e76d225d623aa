// A stepped clock, objects that two sources send, and impossible poses, over real DDS.
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1000 * kMs;

// Two boxes above a floor, 2 m apart, moving slowly, and late after 0.2 s.
const std::string kCell = R"(name: inputs
units: {length: m, angle: deg}
rate_hz: 200
defaults: {age_limit_ms: 200, max_speed: 2}
objects:
  - {name: left, groups: [arm], box: {size: [0.2, 0.2, 0.2]}}
  - {name: right, groups: [arm], box: {size: [0.2, 0.3, 0.2]}}
  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: 0}}
pairs: [{between: [left, right], publish: true}, {between: [arm, floor]}]
simulation:
  movers:
    - {object: left, centre: {xyz: [-1, 0, 3]}, amplitude: [0.3, 0, 0.2], frequency_hz: 0.2}
    - {object: right, centre: {xyz: [1, 0, 3]}, amplitude: [0.1, 0.2, 0], frequency_hz: 0.3}
)";

// A daemon, a robot on the same machine, and a client.
class DaemonInputs : public testing::Test {
 protected:
  using Report = std::unique_ptr<Sample<clearance_msg_Distances>>;

  void start(const ChildOptions& options = {}) {
    daemon.emplace(kDaemon, with({cell.path()}, dds_arguments(dds)), options);
    distances.settle();
  }
  // Sends poses every 5 ms until a report with this status arrives. Returns false after the time
  // limit.
  bool send_until(PairStatus status, std::int64_t limit_ns) {
    return reach(status, limit_ns, [&] { robot.send(t_s += 0.005); });
  }
  bool wait_until(PairStatus status, std::int64_t limit_ns) {
    return reach(status, limit_ns, [] {});
  }
  template <class Step>
  bool reach(PairStatus status, std::int64_t limit_ns, const Step& step) {
    const std::int64_t end = SystemClock().monotonic_ns() + limit_ns;
    while (SystemClock().monotonic_ns() < end) {
      step();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      while ((last = take()) != nullptr) {
        if ((*last)->pairs._buffer[0].status == static_cast<std::uint8_t>(status)) return true;
      }
    }
    return false;
  }
  Report take() {
    auto sample = std::make_unique<Sample<clearance_msg_Distances>>();
    const bool came = take_next(distances.reader(), *sample);
    return came ? std::move(sample) : nullptr;
  }

  CellFile cell{kCell};
  Cell read = cell.cell();
  DdsOptions dds = own_dds();
  Participant client{dds};
  Distances distances{client, read};
  Poses robot{client, read};
  double t_s = 0.0;
  Report last;
  std::optional<ChildProcess> daemon;
};

class SteppedClock : public DaemonInputs {
 protected:
  void SetUp() override {
    if (test::places::stepped_clock().empty()) GTEST_SKIP() << "not with sanitizers";
    step(0);
    start({.environment = {{"LD_PRELOAD", test::places::stepped_clock()},
                           {"CLEARANCE_CLOCK_AHEAD", file()}}});
    ASSERT_TRUE(send_until(PairStatus::kConverged, 5 * kSecond)) << daemon->output();
  }
  std::string file() const { return (folder / "ahead").string(); }
  // Steps the clock of the machine on which daemon and robot run.
  void step(std::int64_t ahead_ns) {
    std::fstream out(file(), std::ios::binary | std::ios::out | std::ios::in);
    if (!out) out.open(file(), std::ios::binary | std::ios::out);
    out.write(reinterpret_cast<const char*>(&ahead_ns), sizeof ahead_ns);
    out.flush();
    robot.set_clock_ahead(ahead_ns);
  }

  ScratchFolder folder;
};

TEST_F(SteppedClock, PosesThatNoLongerComeAreLateWhateverTheClockSays) {
  for (const std::int64_t ahead : {-2 * kSecond, -3600 * kSecond}) {
    step(ahead);
    EXPECT_TRUE(wait_until(PairStatus::kStale, kSecond)) << ahead;
    ASSERT_TRUE(send_until(PairStatus::kConverged, 5 * kSecond)) << daemon->output();
  }
}

TEST_F(SteppedClock, RobotOfTheSameMachineIsHeardAgainHalfASecondAfterAStep) {
  for (const std::int64_t ahead : {3600 * kSecond, std::int64_t{0}, -2 * kSecond}) {
    step(ahead);
    EXPECT_TRUE(send_until(PairStatus::kUnknown, kSecond)) << ahead;
    EXPECT_TRUE(send_until(PairStatus::kConverged, 5 * kSecond)) << daemon->output();
    EXPECT_NEAR(static_cast<double>((*last)->clock_offset_ns), static_cast<double>(ahead), 1e6);
  }
  EXPECT_TRUE(eventually([&] {
    return daemon->output().find("clock was stepped by -2.000 s") != std::string::npos;
  })) << daemon->output();
}

TEST_F(DaemonInputs, ObjectOfTwoSourcesThatContradictEachOtherIsUnknownAndBothAreNamed) {
  start();
  ASSERT_TRUE(send_until(PairStatus::kConverged, 5 * kSecond)) << daemon->output();
  Participant elsewhere(dds);
  Poses other(elsewhere, read, "other");
  other.set_clock_ahead(4 * kMs);
  for (int i = 0; i < 300; ++i) {
    robot.send(t_s += 0.005);
    other.send(t_s + 2.0);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  std::uint8_t status = 0;
  while (const Report report = take()) status = (*report)->pairs._buffer[0].status;
  EXPECT_EQ(status, static_cast<std::uint8_t>(PairStatus::kUnknown));
  EXPECT_TRUE(eventually([&] {
    return daemon->output().find("left is sent by 'test' and by 'other'") != std::string::npos;
  })) << daemon->output();
}

TEST_F(DaemonInputs, PoseThatTheObjectCannotHaveReachedMakesItsPairsUnknownAndIsNamed) {
  start();
  ASSERT_TRUE(send_until(PairStatus::kConverged, 5 * kSecond)) << daemon->output();
  robot.move_by(Vec3(0, 20'000, 0));
  EXPECT_TRUE(send_until(PairStatus::kUnknown, kSecond));
  robot.move_by(Vec3::Zero());
  EXPECT_TRUE(send_until(PairStatus::kConverged, kSecond));
  EXPECT_TRUE(eventually([&] {
    return daemon->output().find("faster than it moves") != std::string::npos;
  })) << daemon->output();
}

TEST_F(DaemonInputs, TwistThatThePosesContradictMakesThePairsUnknownAndIsNamed) {
  start();
  ASSERT_TRUE(send_until(PairStatus::kConverged, 5 * kSecond)) << daemon->output();
  robot.scale_twists(-1.0);
  EXPECT_TRUE(send_until(PairStatus::kUnknown, 5 * kSecond));
  EXPECT_TRUE(eventually([&] {
    return daemon->output().find("elsewhere than its twist leads") != std::string::npos;
  })) << daemon->output();
}

}  // namespace
}  // namespace clearance::test
