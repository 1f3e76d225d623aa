// These do not place a camera: samples of clocks that are ahead or were set back, and leaps that
// the tick refuses. Oracles: the motions that the test makes.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/monitor/sensors/mounted_camera.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

class ClocksAndLeaps : public MountedCamera {};

// The sources of a pose, of transforms and of joints have clocks that are 200 ms ahead.
TEST_F(ClocksAndLeaps, SamplesOfAClockThatIsAheadPlaceNoCamera) {
  const std::int64_t ahead = 200 * kMs, image = kStart + 250 * kMs;
  make_with_info("on: cart");
  for (int ms = 0; ms <= 300; ms += 10)
    add_cart(0.001 * ms, kStart + ms * kMs + ahead, kStart + ms * kMs);
  EXPECT_TRUE(see(image).empty());
  make_with_info("frame: mast");
  for (int ms = 0; ms <= 300; ms += 10)
    add_frame("map", "mast", 0.001 * ms, kStart + ms * kMs + ahead, kStart + ms * kMs);
  EXPECT_TRUE(see(image).empty());
  make_with_info("on: upper");
  for (int ms = 0; ms <= 300; ms += 10) {
    const std::int64_t came = kStart + ms * kMs;
    sensors->add({}, test::joints(0.002 * ms, 0.0, 0.0, came + ahead), came);
  }
  EXPECT_TRUE(see(image).empty());
}

TEST_F(ClocksAndLeaps, SamplesAheadByNoMoreThanTheCellsLimitPlaceACamera) {
  make_with_info("on: cart");
  for (int ms = 0; ms <= 300; ms += 10)
    add_cart(1.0, kStart + ms * kMs + 4 * kMs, kStart + ms * kMs);
  EXPECT_EQ(see(kStart + 250 * kMs).size(), 1u);
}

TEST_F(ClocksAndLeaps, TransformsHoldAtTheTimeThatTheCellChooses) {
  make_with_info("frame: mast", "world_frame: map, stamps: sent");
  for (int ms = 0; ms <= 300; ms += 10)
    add_frame("map", "mast", 0.001 * ms, kStart + ms * kMs + 1000 * kMs, kStart + ms * kMs);
  const auto frames = see(kStart + 250 * kMs);
  ASSERT_EQ(frames.size(), 1u) << "as if AMCL's transforms, which are of the future";
  EXPECT_NEAR(frames[0].world_from_sensor.position.x(), 0.25, 1e-6);
}

TEST_F(ClocksAndLeaps, APositionThatAJointCannotReachPlacesNoLink) {
  const Scene scene = test::scara_cell();  // 2 rad/s
  PostureHistory history(scene);
  const auto add = [&](double position, int ms) {
    for (const JointSample& sample : test::joints(position, 0.0, 0.0, kStart + ms * kMs))
      history.add(sample, sample.stamp_ns);
  };
  const auto is_known = [&](int ms) {
    history.place(kStart + ms * kMs);
    return history.link(0, 1).known;
  };
  for (int ms = 0; ms <= 2000; ms += 10) add(0.0, ms);
  EXPECT_TRUE(is_known(2000));
  add(0.5, 2010);
  EXPECT_FALSE(is_known(2008));
  EXPECT_FALSE(is_known(2010));
  add(0.5, 2020);
  EXPECT_FALSE(is_known(2018)) << "two in a row";
  for (int ms = 2030; ms <= 3000; ms += 10) add(0.0, ms);
  EXPECT_TRUE(is_known(2800));
  EXPECT_NEAR(history.link(0, 1).world_from_body.orientation.z(), 0.0, 1e-12);
}

TEST_F(ClocksAndLeaps, APoseThatAnObjectCannotReachPlacesNoCamera) {
  make_with_info("on: cart");
  cell.scene.objects[0].max_speed = 1.5;
  for (int ms = 0; ms <= 500; ms += 10)
    add_cart(ms == 300 ? 2.0 : 0.0, kStart + ms * kMs, kStart + ms * kMs);
  EXPECT_TRUE(see(kStart + 298 * kMs, 60 * kMs, 202 * kMs).empty());
  EXPECT_TRUE(see(kStart + 300 * kMs, 60 * kMs, 200 * kMs).empty());
  for (int ms = 510; ms <= 1000; ms += 10) add_cart(0.0, kStart + ms * kMs, kStart + ms * kMs);
  EXPECT_EQ(see(kStart + 900 * kMs).size(), 1u);
}

TEST_F(ClocksAndLeaps, ATransformThatAStatedSpeedDoesNotAllowPlacesNoCamera) {
  make_with_info("frame: mast, max_speed: 0.5, max_turn_speed: 0.1");
  for (int ms = 0; ms <= 400; ms += 20)
    add_mast(ms == 200 || ms == 220 ? 2.0 : 0.0, kStart + ms * kMs);
  EXPECT_EQ(see(kStart + 80 * kMs, kMs, 320 * kMs).size(), 1u) << "before";
  EXPECT_TRUE(see(kStart + 180 * kMs, 60 * kMs, 220 * kMs).empty()) << "an age limit around it";
  EXPECT_TRUE(see(kStart + 200 * kMs, 60 * kMs, 200 * kMs).empty()) << "at its own stamp";
  EXPECT_TRUE(see(kStart + 210 * kMs, 60 * kMs, 190 * kMs).empty()) << "between two in a row";
  for (int ms = 420; ms <= 1500; ms += 20) add_mast(0.0, kStart + ms * kMs);
  EXPECT_EQ(see(kStart + 1450 * kMs).size(), 1u);
}

// A mast moves at up to 3 m/s, and no speed is stated. One transform is wrong, or all from then on.
// For a second after that, a frame has no place, or its error contains the true one.
TEST_F(ClocksAndLeaps, ATransformThatLeapsLeavesNoFrameSurerThanItIsAlthoughNoSpeedIsStated) {
  Random random(5);
  int refused = 0, placed = 0;
  for (int run = 0; run < 60; ++run) {
    make_with_info("frame: mast");
    const double leap = random.uniform(0.18, 1.5), speed = random.uniform(-3.0, 3.0);
    const bool stays = run % 2 == 0;
    const int leap_ms = 20 * random.integer(20, 30);
    const int image_ms = leap_ms + random.integer(-20, stays ? 960 : 30);
    for (int ms = 0; ms <= image_ms + 40; ms += 20) {
      const bool is_wrong = stays ? ms >= leap_ms : ms == leap_ms;
      add_mast(0.001 * ms * speed + (is_wrong ? leap : 0.0), kStart + ms * kMs);
    }
    const auto frames = see(kStart + image_ms * kMs, 60 * kMs, 40 * kMs);
    refused += frames.empty() ? 1 : 0;
    if (frames.empty()) continue;
    ++placed;
    const double truth = 0.001 * image_ms * speed;
    EXPECT_LE(std::abs(frames[0].world_from_sensor.position.x() - truth), frames[0].pose_error)
        << "run " << run << ": a leap of " << leap << " m";
  }
  EXPECT_GT(refused, 15);
  EXPECT_GT(placed, 10);
}

TEST_F(ClocksAndLeaps, AMastThatMovesFastIsNoLeapWithoutAStatedSpeed) {
  make_with_info("frame: mast");
  for (int ms = 0; ms <= 400; ms += 20) add_mast(0.004 * ms, kStart + ms * kMs);
  const auto frames = see(kStart + 310 * kMs, kMs, 90 * kMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_LT(frames[0].pose_error, 0.041) << "half of the 80 mm between two transforms";
  // A second after a leap that stayed, the later place is believed: it may be a correction.
  for (int ms = 420; ms <= 1700; ms += 20) add_mast(1.6 + 0.3, kStart + ms * kMs);
  const auto during = see(kStart + 1350 * kMs, kMs, 350 * kMs);
  ASSERT_EQ(during.size(), 1u);
  EXPECT_GT(during[0].pose_error, 0.3);
  const auto later = see(kStart + 1450 * kMs, kMs, 250 * kMs);
  ASSERT_EQ(later.size(), 1u);
  EXPECT_LT(later[0].pose_error, 1e-9);
}

// A localisation corrects an odometry that was set to 0 at the same time.
TEST_F(ClocksAndLeaps, FramesOfAPathMayLeapIfTheyCorrectEachOther) {
  make_with_info("frame: mast, max_speed: 0.5, max_turn_speed: 0.1");
  for (int ms = 0; ms <= 400; ms += 20) {
    const double odom = ms < 200 ? 0.0 : 7.0, stamp = ms;
    const std::int64_t at = kStart + static_cast<std::int64_t>(stamp) * kMs;
    add_frame("map", "odom", odom, at, at);
    add_frame("odom", "mast", 1.0 - odom, at, at);
  }
  const auto frames = see(kStart + 300 * kMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].world_from_sensor.position.x(), 1.0, 1e-9);
}

TEST_F(ClocksAndLeaps, TransformsFromBeforeTheirClockWasSetBackPlaceNoCamera) {
  make_with_info("frame: mast");
  const std::int64_t back = 5000 * kMs;
  for (int ms = 0; ms <= 5000; ms += 100) add_mast(0.0001 * ms, kStart + ms * kMs);
  for (int ms = 0; ms <= 200; ms += 100)
    add_frame("map", "mast", 5.0, kStart + ms * kMs, kStart + ms * kMs + back);
  const auto frames = see(kStart + 130 * kMs, 60 * kMs, back);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].world_from_sensor.position.x(), 5.0, 1e-9);
}

TEST_F(ClocksAndLeaps, ASmallStepBackOfThisMachinesClockLeavesNothingToPlaceACamera) {
  make_with_info("on: cart");
  for (int ms = 0; ms <= 1000; ms += 10) add_cart(1.0, kStart + ms * kMs, kStart + ms * kMs);
  EXPECT_TRUE(see(kStart + 535 * kMs).empty()) << "the cart may have left since";
  for (int ms = 550; ms <= 700; ms += 10) add_cart(1.4, kStart + ms * kMs, kStart + ms * kMs);
  const auto frames = see(kStart + 655 * kMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].world_from_sensor.position.x(), 1.4, 1e-9);
}

TEST_F(ClocksAndLeaps, TransformsFromBeforeThisMachinesClockWasSetBackPlaceNoCamera) {
  make_with_info("frame: mast");
  for (int ms = 0; ms <= 1000; ms += 20) add_mast(1.0, kStart + ms * kMs);
  EXPECT_TRUE(see(kStart + 535 * kMs).empty()) << "the mast may have moved since";
}

// The frame is from before the step, and the transforms around its stamp are from after it.
TEST_F(ClocksAndLeaps, AFrameThatWaitsWhenThisMachinesClockIsSetBackIsDropped) {
  make(kImage + ", age_limit_ms: 4000, mount: {frame: mast}", "ros2: {world_frame: map}\n");
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  for (int ms = 0; ms <= 1000; ms += 20) add_mast(0.0, kStart + ms * kMs);
  EXPECT_TRUE(see(kStart + 1005 * kMs, kMs).empty());
  ASSERT_TRUE(sensors->any_waiting());
  for (int ms = 500; ms <= 1100; ms += 20) add_mast(0.2, kStart + ms * kMs);
  EXPECT_TRUE(settle(kStart + 1600 * kMs).empty());
  EXPECT_FALSE(sensors->any_waiting());
}

// The first message after the step is the image.
TEST_F(ClocksAndLeaps, WhatCameBeforeThisMachinesClockWasSetBackPlacesNoCamera) {
  make_with_info("on: cart");
  for (int ms = 0; ms <= 10'000; ms += 10) add_cart(1.0, kStart + ms * kMs, kStart + ms * kMs);
  EXPECT_TRUE(see(kStart + 35 * kMs).empty());
}

TEST_F(ClocksAndLeaps, AnObjectMayHaveMovedAndTurnedBetweenPosesThatAreFarFromEachOther) {
  make_with_info("on: cart");
  cell.scene.objects[0].max_speed = 1.5;
  add_cart(1.0, kStart, kStart);
  add_cart(1.0, kStart + 240 * kMs, kStart + 240 * kMs);
  const auto frames = see(kStart + 120 * kMs, 60 * kMs, 120 * kMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_GE(frames[0].pose_error, 0.12 * (1.5 + 6.3 * cell.scene.sensors[0].extent()));
}

TEST_F(ClocksAndLeaps, AFrameMayHaveMovedAndTurnedBetweenTransformsThatAreFarFromEachOther) {
  make_with_info("frame: mast, max_speed: 0.5, max_turn_speed: 0.1");
  for (int ms = 0; ms <= 200; ms += 20) add_mast(0.0, kStart + ms * kMs);
  add_mast(0.0, kStart + 1000 * kMs);
  const auto frames = see(kStart + 600 * kMs, 60 * kMs, 400 * kMs);
  ASSERT_EQ(frames.size(), 1u);
  const double extent = cell.scene.sensors[0].extent();
  EXPECT_GE(frames[0].pose_error, 0.4 * (0.5 + 0.1 * extent)) << "out and back";
  EXPECT_LE(frames[0].pose_error, 0.41 * (0.5 + 0.1 * extent));
  const auto nearer = see(kStart + 950 * kMs, 60 * kMs, 50 * kMs);
  ASSERT_EQ(nearer.size(), 1u);
  EXPECT_LE(nearer[0].pose_error, 0.051 * (0.5 + 0.1 * extent)) << "50 ms before the next one";
}

// A localisation that is seldom heard corrects an odometry that drifts. The mast itself swings at
// up to its stated speed.
TEST_F(ClocksAndLeaps, PathsOfSeveralFramesAreWithinTheirErrorAcrossGaps) {
  Random random(23);
  int frames_seen = 0, gaps = 0;
  for (int run = 0; run < 200; ++run) {
    make_with_info("frame: mast, max_speed: 0.5, max_turn_speed: 0.1");
    const double swing = random.uniform(0.0, 0.1), drift = random.uniform(0.0, 0.03);
    const double at_s = random.uniform(0.0, 1.0);
    const auto truth = [&](double s) { return swing * std::sin(0.5 / 0.1 * (s + at_s)); };
    const auto drifted = [&](double s) { return drift * std::sin(8.0 * (s - at_s)); };
    const int period = 20 * static_cast<int>(random.integer(1, 30));
    for (int ms = 0; ms <= 1800; ms += 20) {
      const std::int64_t at = kStart + ms * kMs;
      if (ms % period == 0) add_frame("map", "odom", drifted(1e-3 * ms), at, at);
      if (ms % 60 == 0) add_frame("odom", "mast", truth(1e-3 * ms) - drifted(1e-3 * ms), at, at);
    }
    const int ms = 700 + static_cast<int>(random.integer(0, 400));
    const auto frames = see(kStart + ms * kMs, 60 * kMs, 1100 * kMs);
    if (frames.empty()) continue;
    ++frames_seen;
    gaps += period > 150 ? 1 : 0;
    const double x = frames[0].world_from_sensor.position.x();
    EXPECT_LE(std::abs(x - truth(1e-3 * ms)), frames[0].pose_error + 1e-9) << run;
  }
  EXPECT_GT(frames_seen, 150);
  EXPECT_GT(gaps, 50);
}

// The shoulder turns at 0.5 rad/s, and its encoder is stuck.
TEST_F(ClocksAndLeaps, ALinkWhoseJointIsFrozenHidesNothingAndPlacesNoCamera) {
  for (const bool is_stuck : {false, true}) {
    make(kImage + kAbove);
    add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
    for (int ms = 0; ms <= 5000; ms += 10) {
      const std::int64_t at = kStart + ms * kMs;
      auto joints = test::joints(0.0, 0.0, 0.0, at);
      joints[0].has_velocity = true;
      joints[0].velocity = is_stuck ? 0.5 : 0.0;
      sensors->add({}, joints, at);
    }
    ImageText image = flat(0, 1950);  // where the upper arm is
    image.stamp_ns = kStart + 4995 * kMs;
    add(image);
    const auto frames = settle(kStart + 5060 * kMs);
    ASSERT_EQ(frames.size(), 1u);
    std::size_t left_out = 0;
    for (const OwnImageStatus& own : sensors->status(0).own) left_out += own.elements;
    EXPECT_EQ(left_out == 0, is_stuck);
    EXPECT_EQ(frames[0].cloud->size() + left_out, 48u);
  }
}

// The cart drives at 0.5 m/s, and its localisation is stuck.
TEST_F(ClocksAndLeaps, AnObjectWhosePosesAreFrozenPlacesNoCamera) {
  for (const bool is_stuck : {false, true}) {
    make_with_info("on: cart");
    for (int ms = 0; ms <= 5000; ms += 10) {
      const std::int64_t at = kStart + ms * kMs;
      PoseSample sample = test::sample(0, test::at(1, 0, 0), at);
      sample.has_twist = true;
      sample.twist.linear = {is_stuck ? 0.5 : 0.0, 0.0, 0.0};
      sensors->add(std::vector{sample}, {}, at);
    }
    EXPECT_EQ(see(kStart + 4995 * kMs).size(), is_stuck ? 0u : 1u);
  }
}

TEST_F(ClocksAndLeaps, AFrameNamesWhatCarriesItsCamera) {
  const auto carrier = [&](const std::string& mount, const char* parent) {
    make_with_info(mount);
    cell.scene.objects[0].frame = "trolley";
    sensors = std::make_unique<Sensors>(cell, SensorsOptions{});
    add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
    for (int ms = 0; ms <= 300; ms += 10) {
      const std::int64_t at = kStart + ms * kMs;
      add_cart(1.0, at, at);
      sensors->add({}, test::joints(0.0, 0.0, 0.0, at), at);
      if (parent != nullptr) {
        add_frame(parent, "between", 0.1, at, at);
        add_frame("between", "mast", 0.1, at, at);
      }
    }
    const auto frames = see(kStart + 250 * kMs);
    EXPECT_EQ(frames.size(), 1u);
    return frames.empty() ? Carrier{} : frames[0].carrier;
  };
  const auto expect = [](const Carrier& is, RobotBase::Kind kind, std::uint32_t index) {
    EXPECT_EQ(is.kind, kind);
    EXPECT_EQ(kind == RobotBase::Kind::kLink ? is.link : is.object, index);
  };
  expect(carrier("on: upper", nullptr), RobotBase::Kind::kLink, 1);
  expect(carrier("frame: mast", "upper"), RobotBase::Kind::kLink, 1);
  expect(carrier("on: cart", nullptr), RobotBase::Kind::kObject, 0);
  expect(carrier("frame: mast", "trolley"), RobotBase::Kind::kObject, 0);
  expect(carrier("frame: mast", "map"), RobotBase::Kind::kWorld, 0);
}

TEST_F(ClocksAndLeaps, FramesThatWaitAreNotBuiltOnceTheyAreDropped) {
  make_with_info("on: cart");
  add_cart(1.0, kStart, kStart);
  EXPECT_TRUE(see(kStart + 10 * kMs, kMs).empty());
  ASSERT_TRUE(sensors->any_waiting());
  sensors->drop_waiting();
  EXPECT_FALSE(sensors->any_waiting());
  EXPECT_TRUE(settle(kStart + 100 * kMs).empty());
  EXPECT_EQ(sensors->status(0).skipped, 1u);
}

// A point that always moves at full speed, from one end to the other.
TEST(PlacesInSpace, LieWithinTheDeviationThatASpeedAllows) {
  Random random(17);
  for (int path = 0; path < 20'000; ++path) {
    const double speed = random.uniform(0.1, 3.0), share = random.uniform(0.0, 1.0);
    const Vec3 end(random.uniform(0.0, 1.0) * speed, 0.0, 0.0);  // 1 s after the origin
    const double angle = random.uniform(0.0, 3.2);
    const Vec3 at =
        random.uniform(0.0, 1.0) * share * speed * Vec3(std::cos(angle), std::sin(angle), 0.0);
    if ((end - at).norm() > speed * (1.0 - share)) continue;
    EXPECT_LE((at - share * end).norm(), deviation_in_space(share, 1.0 - share, speed, end.norm()));
  }
  EXPECT_NEAR(deviation_in_space(0.5, 0.5, 2.0, 2.0), 0.0, 1e-5);
  EXPECT_GE(deviation_in_space(0.5, 0.5, 2.0, 3.0), 1.0) << "stamps are off by as much";
}

}  // namespace
}  // namespace clearance::sensors_test
