// The limiter in the loop: what the robot does, judged by the states of its hardware and by the
// true distance of its hand. A test may take longer on a busy machine, and then says the same.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "counted_allocations.hpp"
#include "limited_robot.hpp"

namespace clearance_control_test {
namespace {

constexpr double kDeceleration = 2.0;
constexpr int kNotRelied = 1, kHeld = 2, kDistance = 4;  // Cause of permit_reader.hpp

double speed(const LimitedRobot& robot) { return std::abs(robot.observed().velocities[0]); }
bool is_free(const LimitedRobot& robot) { return robot.observed().scaling == 1.0; }

// Steps with a constant velocity to the wall until the robot has it.
bool goes(LimitedRobot& robot, double velocity) {
  return robot.step_until(
      [&] {
        return Values{velocity, 0.0};
      },
      [&] { return robot.observed().velocities[0] == velocity; }, 30.0);
}

TEST(LimiterInTheLoop, LetsVelocitiesPassToTheBitWhereTheWallIsFar) {
  LimitedRobot robot({.slide = -3.0});
  ASSERT_TRUE(goes(robot, 0.0) &&
              robot.step_until([] { return Values{}; }, [&] { return is_free(robot); }, 30.0));
  int passed = 0;
  bool was_free = true;
  Values before{};
  for (int k = 0; k < 30'000 && passed < 700; ++k) {
    const Values references = {0.2 * std::sin(0.005 * k), 0.1 * std::sin(0.003 * k)};
    robot.step(references);
    if (was_free && is_free(robot)) {
      ASSERT_EQ(robot.observed().velocities, before) << k;
      ++passed;
    }
    was_free = is_free(robot);
    before = references;
  }
  EXPECT_EQ(passed, 700);
}

TEST(LimiterInTheLoop, LetsPositionsPassToTheBitWhereTheWallIsFar) {
  LimitedRobot robot({.interface = "position", .slide = -3.0});
  ASSERT_TRUE(robot.step_until(
      [] {
        return Values{-3.0, 0.0};
      },
      [&] { return is_free(robot); }, 30.0));
  int passed = 0;
  bool was_free = true;
  Values before = {-3.0, 0.0};
  for (int k = 0; k < 30'000 && passed < 700; ++k) {
    const Values references = {-3.0 + 0.04 * std::sin(0.005 * k), 0.02 * std::sin(0.003 * k)};
    robot.step(references);
    if (was_free && is_free(robot)) {
      ASSERT_EQ(robot.observed().positions, before) << k;
      ++passed;
    }
    was_free = is_free(robot);
    before = references;
  }
  EXPECT_EQ(passed, 700);
}

// At velocity v (d - 0.1) / 0.3, it needs 0.3 / v ln(10) s from 0.4 m to 0.13 m. A report counts
// for 0.1 s, and its positions are not older than that, so the robot may be earlier by 0.2 s. A
// delay below 0.3 / v / e s does not let it overshoot.
TEST(LimiterInTheLoop, SlowsBetweenTheMarginsAndKeepsTheLesserOne) {
  LimitedRobot robot({.slide = 0.5});
  constexpr double kVelocity = 0.4;
  ASSERT_TRUE(goes(robot, kVelocity));
  double slowed_s = 0.0;
  const auto forward = [] { return Values{kVelocity, 0.0}; };
  ASSERT_TRUE(robot.step_until(
      forward,
      [&] {
        slowed_s += robot.distance() < 0.4 ? kPeriod : 0.0;
        return robot.distance() < 0.13;
      },
      30.0));
  EXPECT_GT(slowed_s, 0.3 / kVelocity * std::log(10.0) - 0.2);
  EXPECT_TRUE(robot.step_until(
      forward, [&] { return robot.observed().cause == kDistance; }, 30.0));
  ASSERT_TRUE(robot.step_until(
      forward, [&] { return robot.distance() < 0.11; }, 30.0));
  for (int k = 0; k < 2000; ++k) {
    robot.step(forward());
    ASSERT_GT(robot.distance(), 0.1) << k;
  }
}

// Positions are held as soon as their references are faster than the distance permits. If reports
// are late before that, the motion begins anew from where the robot stands.
TEST(LimiterInTheLoop, HoldsPositionsThatAreTooFastBeforeTheMargin) {
  LimitedRobot robot({.interface = "position", .slide = 0.5});
  const auto at_rest = [] { return Values{0.5, 0.0}; };
  ASSERT_TRUE(robot.step_until(
      at_rest, [&] { return is_free(robot); }, 30.0));
  double slide = 0.5;
  const auto forward = [&] {
    const bool is_late = robot.distance() > 0.4 && robot.observed().cause == kNotRelied;
    slide = is_late ? robot.observed().positions[0] : slide + 4e-4;
    return Values{slide, 0.0};
  };
  const auto is_held_near = [&] {
    EXPECT_GT(robot.distance(), 0.1);
    EXPECT_LE(speed(robot), 0.5 + 1e-9);
    return (robot.distance() < 0.4 && speed(robot) == 0.0) || testing::Test::HasFailure();
  };
  ASSERT_TRUE(robot.step_until(forward, is_held_near, 30.0));
  for (int k = 0; k < 2000; ++k) {
    robot.step(forward());
    ASSERT_EQ(speed(robot), 0.0) << k;
  }
}

TEST(LimiterInTheLoop, HoldsBelowTheMargin) {
  LimitedRobot robot({.slide = 0.95});
  ASSERT_TRUE(robot.step_until(
      [] {
        return Values{-0.2, 0.1};
      },
      [&] { return robot.observed().cause == kDistance; }, 30.0));
  for (int k = 0; k < 500; ++k) {
    robot.step({-0.2, 0.1});
    ASSERT_EQ(robot.observed().velocities, Values{}) << k;
  }
}

// No report comes after the end of the daemon, so every update later than the time for which one
// counts holds.
void hold_after_the_end(LimitedRobot& robot, std::chrono::milliseconds counts_for,
                        const std::function<Values()>& references, int updates) {
  const auto end = robot.daemon->kill() + counts_for;
  while (std::chrono::steady_clock::now() < end) robot.step(references());
  for (int k = 0; k < updates; ++k) {
    robot.step(references());
    ASSERT_EQ(robot.observed().cause, kNotRelied) << k;
    ASSERT_EQ(robot.observed().scaling, 0.0) << k;
  }
}

void hold_and_resume(const RobotOptions& options,
                     const std::function<Values(const LimitedRobot&)>& from) {
  LimitedRobot robot(options);
  const auto references = [&] { return from(robot); };
  const auto is_fast = [&] { return is_free(robot) && speed(robot) > 0.15; };
  ASSERT_TRUE(robot.step_until(references, is_fast, 30.0));
  hold_after_the_end(robot, std::chrono::milliseconds(100), references,
                     static_cast<int>(0.5 / kDeceleration / kPeriod) + 2);
  EXPECT_LT(speed(robot), 1e-12);
  robot.daemon = std::make_unique<Daemon>(robot.folder, robot.stopping);
  double before = speed(robot);
  const auto is_fast_without_a_jump = [&] {
    EXPECT_LE(std::abs(speed(robot) - before), 1.001 * kDeceleration * kPeriod);
    before = speed(robot);
    return is_fast() || testing::Test::HasFailure();
  };
  EXPECT_TRUE(robot.step_until(references, is_fast_without_a_jump, 30.0));
}

TEST(LimiterInTheLoop, HoldsVelocitiesAfterTheDaemonIsKilledAndResumesWithTheNextOne) {
  hold_and_resume({.slide = -8.0}, [](const LimitedRobot&) { return Values{0.2, 0.0}; });
}

TEST(LimiterInTheLoop, HoldsPositionsAfterTheDaemonIsKilledAndResumesWithTheNextOne) {
  hold_and_resume({.interface = "position", .slide = -8.0}, [](const LimitedRobot& robot) {
    return Values{robot.observed().positions[0] + 4e-4, 0.0};
  });
}

TEST(LimiterInTheLoop, HoldsTwoPeriodsAfterTheDaemonIsKilled) {
  LimitedRobot robot({.slide = -3.0, .reports_count_for = "0.0"});
  const auto forward = [] { return Values{0.1, 0.0}; };
  for (int round = 0; round < 8; ++round) {
    ASSERT_TRUE(robot.step_until(
        forward, [&] { return is_free(robot); }, 30.0));
    hold_after_the_end(robot, std::chrono::milliseconds(2), forward, 20);
    robot.daemon = std::make_unique<Daemon>(robot.folder, robot.stopping);
  }
}

// The robot brakes as the cell states, and its reports count for less than the stated reaction.
TEST(LimiterInTheLoop, ObeysTheScalingOfStopsAndKeepsTheirMargin) {
  LimitedRobot robot(
      {.slide = 0.0,
       .limits = "obey_scaling: true",
       .reports_count_for = "0.02",
       .stopping = "{reaction_ms: 50, path: kept, deceleration: 2, acceleration: 2}"});
  double fastest = 0.0;
  for (int k = 0; k < 60'000 && !(robot.distance() < 0.15 && speed(robot) < 0.1); ++k) {
    robot.step({0.4, 0.0});
    fastest = std::max(fastest, speed(robot));
    ASSERT_GT(robot.distance(), 0.05) << k;
  }
  EXPECT_GT(fastest, 0.2);
  EXPECT_LT(robot.distance(), 0.15);
  for (int k = 0; k < 2000; ++k) {
    robot.step({0.4, 0.0});
    ASSERT_GT(robot.distance(), 0.05) << k;
  }
}

// While the daemon stands still, another one of the cell is heard. When it goes on, both are, until
// the later one hears the other and ends: by then, several reports are of another source.
TEST(LimiterInTheLoop, HoldsAfterReportsOfTwoDaemonsUntilAPersonAcknowledges) {
  LimitedRobot robot({.slide = -3.0});
  const auto still = [] { return Values{}; };
  const auto frees = [&] { return is_free(robot); };
  const auto is_held = [&] { return robot.observed().cause == kHeld; };
  const auto is_silent = [&] { return robot.observed().cause == kNotRelied; };
  ASSERT_TRUE(robot.step_until(still, frees, 30.0));
  for (int tries = 0; tries < 20 && !is_held(); ++tries) {
    robot.daemon->signal(SIGSTOP);
    ASSERT_TRUE(robot.step_until(still, is_silent, 30.0));
    const Daemon second(robot.folder, robot.stopping);
    ASSERT_TRUE(robot.step_until(still, frees, 30.0));
    robot.daemon->signal(SIGCONT);
    robot.step_until(still, is_held, 0.3);
  }
  ASSERT_TRUE(is_held());
  ASSERT_FALSE(robot.step_until(
      still, [&] { return !is_held(); }, 0.5));
  ASSERT_TRUE(robot.acknowledge());
  EXPECT_TRUE(robot.step_until(still, frees, 30.0));
}

TEST(LimiterInTheLoop, AllocatesNothingInAnUpdate) {
  for (const char* interface : {"velocity", "position"}) {
    LimitedRobot robot({.interface = interface, .slide = -3.0});
    const auto still = [&] {
      return Values{interface == std::string("position") ? -3.0 : 0.0, 0.0};
    };
    ASSERT_TRUE(robot.step_until(
        still, [&] { return is_free(robot); }, 30.0));
    const std::uint64_t before = counted_allocations();
    robot.step(still());
    ASSERT_GT(counted_allocations(), before) << "the loop publishes joint states, and is counted";
    for (int k = 0; k < 200; ++k) {
      robot.step(still());
      ASSERT_EQ(robot.allocations_of_update(), 0u) << k;
    }
    robot.daemon->kill();
    for (int k = 0; k < 500; ++k) {
      robot.step(still());
      ASSERT_EQ(robot.allocations_of_update(), 0u) << k;
    }
  }
}

}  // namespace
}  // namespace clearance_control_test

namespace {

// Nodes of ROS 2 have no partitions: two robots in one domain would contradict each other. The name
// of the socket belongs to this process until it ends.
int own_domain() {
  constexpr int kDomains = 99;  // below the ports that the kernel assigns
  for (int tries = 0; tries < kDomains; ++tries) {
    const int domain = 1 + (getpid() + tries) % kDomains;
    const std::string name = "clearance-test-of-ros-domain-" + std::to_string(domain);
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};  // no file: the first byte is 0
    name.copy(address.sun_path + 1, name.size());
    const int named = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (bind(named, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0)
      return domain;
    close(named);
  }
  throw std::runtime_error("all domains are in use");
}

}  // namespace

// Without CYCLONEDDS_URI, all traffic stays on this machine.
int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  setenv("ROS_DISTRO", "jazzy", 0);  // a workspace without the package ros_environment has none
  setenv("ROS_DOMAIN_ID", std::to_string(own_domain()).c_str(), 1);
  if (getenv("CYCLONEDDS_URI") == nullptr) setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST", 1);
  rclcpp::init(argc, argv);
  const int status = RUN_ALL_TESTS();
  rclcpp::shutdown();
  return status;
}
