// A frame cannot show everything near a link: the blind shell, and places that it has not seen.
//
// Oracles: closed forms for boxes, balls and planes that the test puts in.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "monitor/pairs/hidden_places.hpp"
#include "tests/monitor/sensors/small_camera.hpp"

namespace clearance::sensors_test {
namespace {

// All pixels look at the upper arm if it lies along x: its upper face is 1.95 m below.
constexpr const char* kOverTheArm =
    ", mount: {pose: {xyz: [0.5, 0, 2], rpy: [3.141592653589793, 0, 0]}}";

// The payload is a ball beside the upper arm, and its top is at z = 0.3. The second one is on a
// tray, which is itself attached to the arm.
const std::array<std::string, 2> kPayloads = {
    ", {name: ball, attached: {to: upper, pose: {xyz: [0.5, 0.4, 0.2]}}, sphere: {radius: 0.1}}",
    ", {name: ball, attached: {to: tray, pose: {xyz: [0.4, 0, 0]}}, sphere: {radius: 0.1}}"
    ", {name: tray, attached: {to: upper, pose: {xyz: [0.5, 0, 0.2], rpy: [0, 0, "
    "1.5707963267948966]}}, sphere: {radius: 0.05}}"};
constexpr double kTurned = 0.7;  // of the shoulder, rad
const Vec3 kBall(0.5 * std::cos(kTurned) - 0.4 * std::sin(kTurned),
                 0.5 * std::sin(kTurned) + 0.4 * std::cos(kTurned), 0.2);
// With the shoulder turned so, all pixels look at the top of the ball, 1.7 m below.
const std::string kOverTheBall = ", own_shell: 0.02, mount: {pose: {xyz: [" +
                                 std::to_string(kBall.x()) + ", " + std::to_string(kBall.y()) +
                                 ", 2], rpy: [3.141592653589793, 0, 0]}}";

class HiddenPlacesTest : public SensorsTest {
 protected:
  // Shows the frames that are built by then to a monitor, whose joints are those at kStart.
  const Report& tick(double shoulder) {
    if (monitor == nullptr) monitor = std::make_unique<Monitor>(cell.scene);
    for (const SensorFrame& frame : settle(kStart + 50'000'000)) {
      shown.push_back(frame);
      EXPECT_TRUE(monitor->show(0, frame));
    }
    return monitor->tick({}, test::joints(shoulder, 0.0, 0.0, kStart), kStart + 1'000'000);
  }
  [[nodiscard]] const HiddenReport& near(const Report& report, const std::string& link) const {
    const auto found = std::ranges::find_if(report.hidden, [&](const HiddenReport& each) {
      const ObjectPair& pair = cell.scene.pairs[each.pair];
      return cell.scene.objects[pair.first].name == link ||
             cell.scene.objects[pair.second].name == link;
    });
    EXPECT_NE(found, report.hidden.end());
    return *found;
  }
  std::unique_ptr<Monitor> monitor;
  std::vector<SensorFrame> shown;
};

TEST_F(HiddenPlacesTest, ReportsSayForEachLinkHowThickTheBlindShellIs) {
  make(kImage + ", own_shell: 0.02" + kOverTheArm);
  const Report& before = tick(0.0);
  EXPECT_EQ(before.hidden.size(), 4u) << "links, and not the cart";
  for (const HiddenReport& each : before.hidden) EXPECT_EQ(each.thickness, kInfinity);
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  add_joints(0.0, kStart);
  // Half of the pixels see the arm, and half of them something that is 0.5 m above it.
  ImageText image = flat(0, 1950);
  const ImageText other = flat(0, 1450);
  std::copy(other.data.begin(), other.data.begin() + 48, image.data.begin());
  add(image);
  const Report& report = tick(0.0);
  ASSERT_EQ(shown.size(), 1u);
  EXPECT_EQ(near(report, "upper").elements, 24u);
  // The slab of a pixel is 20 mm long and 5 mm wide, and comes within 20 mm of the arm.
  EXPECT_GT(near(report, "upper").thickness, 0.04);
  EXPECT_LT(near(report, "upper").thickness, 0.05);
  EXPECT_EQ(near(report, "lower").elements, 0u);
  EXPECT_EQ(near(report, "lower").thickness, 0.0);
  EXPECT_EQ(near(report, "upper").unseen, -kInfinity) << "it was not asked for";
}

// A hand that is nearer to the arm than the blind shell is left out with it; one that is farther
// away is an obstacle. The pixels of the hand are all that is seen besides the arm and the floor.
TEST_F(HiddenPlacesTest, ABodyWithinTheBlindShellIsLeftOutAndOneBeyondItIsNot) {
  for (const bool is_within : {true, false}) {
    make(kImage + ", own_shell: 0.02" + kOverTheArm);
    monitor = nullptr;
    add(Type::kCameraInfo, narrow().cdr(), kStart);
    add_joints(0.0, kStart);
    ImageText image = flat(0, 1950);
    const ImageText far = flat(0, 1000);
    std::copy(far.data.begin(), far.data.begin() + 16, image.data.begin());  // the first row
    const ImageText hand = flat(0, is_within ? 1925 : 1890);
    std::copy(hand.data.begin() + 16, hand.data.begin() + 18, image.data.begin() + 16);
    add(image);
    const Report& report = tick(0.0);
    const HiddenReport& shell = near(report, "upper");
    EXPECT_EQ(shell.elements, is_within ? 40u : 39u);
    const PairReport& pair = *std::ranges::find(report.pairs, shell.pair, &PairReport::pair);
    // The face of the hand's slab is 10 mm below its depth.
    EXPECT_NEAR(pair.lower, is_within ? 0.94 : 0.05, 0.001);
    // The face of the hand is nearer than the shell is thick exactly if the hand is left out.
    EXPECT_EQ(1.95 - 1.925 < shell.thickness, true);
    EXPECT_EQ(1.95 - 1.89 < shell.thickness, false);
  }
}

// The camera looks along -z from 2 m. The arm's upper side is at z = 0.05, its lower at -0.05.
TEST_F(HiddenPlacesTest, UnseenIsBehindWhatIsSeenAndTheWholeConeOfAMissingPixel) {
  make(kImage + ", unseen: true" + kOverTheArm);
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  add_joints(3.0, kStart);  // the arm is elsewhere: 0.05 m thick sides, beside the picture
  add(flat(0, 1000));
  const Report& report = tick(3.0);
  // Behind the plane at 1 m, which is at most 10 mm wrong: z = 0.99 and below, down to 4 m.
  const HiddenReport& upper = near(report, "upper");
  EXPECT_EQ(upper.elements, 0u);
  // The sides of the picture's pyramid are 4 pixels of 400 away from its axis: at z = 0, 2 m from
  // the camera, x is 0.48 to 0.52 and y is -0.015 to 0.015.
  const double sine = std::sin(3.0), cosine = std::cos(3.0);
  const Vec3 nearest(0.48, 0.0, 0.0);
  const Vec3 in_link(cosine * nearest.x(), -sine * nearest.x(), 0.0);
  const double gap = std::hypot(0.1 - in_link.x(), std::max(0.0, std::abs(in_link.y()) - 0.05));
  EXPECT_NEAR(upper.unseen, gap, 0.02);
  EXPECT_LT(upper.unseen, (upper.unseen_at - Vec3(0.1 * cosine, 0.1 * sine, 0)).norm());
}

TEST_F(HiddenPlacesTest, WhatTheRobotItselfHidesIsNotCountedAsUnseen) {
  make(kImage + ", unseen: true" + kOverTheArm);
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  add_joints(0.0, kStart);
  ImageText image = flat(0, 1950);
  const ImageText near_camera = flat(0, 500);
  std::copy(near_camera.data.begin(), near_camera.data.begin() + 16, image.data.begin());
  add(image);
  {
    const HiddenReport& upper = near(tick(0.0), "upper");
    EXPECT_EQ(upper.elements, 40u);
    EXPECT_LT(upper.unseen, 0.0) << "what is behind the first row contains a part of the arm";
  }
  // Without that row, all pixels see the arm, and nothing but a missing pixel is unseen.
  make(kImage + ", unseen: true" + kOverTheArm);
  monitor = nullptr;
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  add_joints(0.0, kStart);
  ImageText gap = flat(0, 1950);
  gap.data[0] = gap.data[1] = 0;
  const ImageText step = flat(0, 3900);
  std::copy(step.data.begin() + 94, step.data.end(), gap.data.begin() + 94);
  add(gap);
  EXPECT_LT(near(tick(0.0), "upper").unseen, 0.0) << "the cone of the missing pixel meets the arm";
}

TEST_F(HiddenPlacesTest, APayloadIsLeftOutWhereItsLinkCarriedItAtTheStamp) {
  for (const std::string& payload : kPayloads) {
    for (const double shoulder : {kTurned, kTurned + 0.3}) {
      make(kImage + kOverTheBall, "", payload);
      add(Type::kCameraInfo, narrow().cdr(), kStart);
      add_joints(shoulder, kStart);
      add_joints(2.0, kStart + 1'000'000'000);  // it has turned away since
      add(Type::kImage, flat(0, 1700).cdr(), kStart + 1'000'000'000);
      const auto frames = settle(kStart + 1'000'000'000);
      if (shoulder == kTurned) {
        EXPECT_TRUE(frames.empty());
        EXPECT_EQ(count(FrameFault::kNothingSeen), 1u) << payload;
      } else {
        ASSERT_EQ(frames.size(), 1u);
        EXPECT_EQ(frames[0].cloud->size(), 48u) << payload;
      }
    }
  }
}

TEST_F(HiddenPlacesTest, ABodyThatIsNotAttachedIsAnObstacleAtTheSamePlace) {
  make(kImage + kOverTheBall, "", ", {name: ball, groups: [arm], sphere: {radius: 0.1}}");
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  ASSERT_EQ(cell.scene.objects[1].name, "ball");
  sensors->add(std::vector{test::sample(1, {kBall, Eigen::Quaterniond::Identity()}, kStart)},
               test::joints(kTurned, 0.0, 0.0, kStart), kStart);
  add(flat(0, 1700));
  const auto frames = settle(kStart + 2000);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].cloud->size(), 48u);
}

// The top of a tray on a cart is 1.7 m below the camera.
TEST_F(HiddenPlacesTest, WhatNoRobotCarriesIsAnObstacleAlthoughItIsAttached) {
  make(kImage +
           ", own_shell: 0.02, mount: {pose: {xyz: [5, 0, 2], rpy: [3.141592653589793, 0, "
           "0]}}",
       "",
       ", {name: tray, groups: [arm], attached: {to: cart, pose: {xyz: [0, 0, 0.1]}}, sphere: "
       "{radius: 0.1}}");
  EXPECT_TRUE(std::ranges::none_of(hidden_pairs(cell.scene), [&](std::uint32_t pair) {
    const ObjectPair& of = cell.scene.pairs[pair];
    return cell.scene.objects[of.first].name == "tray" ||
           cell.scene.objects[of.second].name == "tray";
  }));
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  ASSERT_EQ(cell.scene.objects[0].name, "cart");
  sensors->add(
      std::vector{test::sample(0, {{5.0, 0.0, 0.1}, Eigen::Quaterniond::Identity()}, kStart)},
      test::joints(kTurned, 0.0, 0.0, kStart), kStart);
  add(flat(0, 1700));
  const auto frames = settle(kStart + 2000);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].cloud->size(), 48u);
}

// The first row sees something 0.69 m above the ball. One pixel in the middle sees something that
// is 15 mm or 60 mm above the ball.
TEST_F(HiddenPlacesTest, ReportsSayHowThickTheBlindShellOfAPayloadIs) {
  for (const std::string& payload : kPayloads) {
    for (const bool is_within : {true, false}) {
      make(kImage + kOverTheBall, "", payload);
      monitor = nullptr;
      EXPECT_EQ(near(tick(kTurned), "ball").thickness, kInfinity) << "no frame yet";
      add(Type::kCameraInfo, narrow().cdr(), kStart);
      add_joints(kTurned, kStart);
      ImageText image = flat(0, 1700);
      for (std::size_t pixel = 0; pixel < 8; ++pixel) put(image, pixel, 1000);
      put(image, 19, is_within ? 1685 : 1640);
      add(image);
      monitor = nullptr;
      const Report& report = tick(kTurned);
      const HiddenReport& shell = near(report, "ball");
      EXPECT_EQ(shell.elements, is_within ? 40u : 39u) << payload;
      // The slab of a pixel is 20 mm long and 4 mm wide, and comes within 20 mm of the ball.
      EXPECT_GT(shell.thickness, 0.04);
      EXPECT_LT(shell.thickness, 0.05);
      const PairReport& pair = *std::ranges::find(report.pairs, shell.pair, &PairReport::pair);
      EXPECT_NEAR(pair.lower, is_within ? 0.69 : 0.05, 0.001);
      EXPECT_EQ(near(report, "upper").elements, 0u);
      EXPECT_EQ(near(report, "upper").thickness, 0.0);
    }
  }
}

TEST_F(HiddenPlacesTest, WhatAPayloadItselfHidesIsNotCountedAsUnseenAndWhatHidesItIs) {
  for (const std::string& payload : kPayloads) {
    for (const bool is_behind : {false, true}) {
      make(kImage + ", unseen: true" + kOverTheBall, "", payload);
      monitor = nullptr;
      add(Type::kCameraInfo, narrow().cdr(), kStart);
      add_joints(kTurned, kStart);
      ImageText image = flat(0, 1700);
      for (std::size_t pixel = 0; pixel < 8; ++pixel) put(image, pixel, is_behind ? 500 : 3900);
      add(image);
      const HiddenReport& ball = near(tick(kTurned), "ball");
      EXPECT_EQ(ball.elements, 40u);
      if (is_behind) {
        EXPECT_LT(ball.unseen, 0.0) << "a part of the ball is behind the first row";
      } else {
        // The first row has not seen what is beyond 3.91 m. The ball ends at 1.9 m.
        EXPECT_NEAR(ball.unseen, 2.01, 0.001);
      }
    }
  }
}

// The places that a frame lists are of one body and one sensor. They say nothing of others.
TEST_F(HiddenPlacesTest, OfBodiesThatAFrameDoesNotListHaveNoShell) {
  make(kImage + ", own_shell: 0.02" + kOverTheArm);
  for (const bool is_swapped : {false, true}) {
    Scene scene = cell.scene;
    if (is_swapped)
      for (ObjectPair& pair : scene.pairs) std::swap(pair.first, pair.second);
    HiddenPlaces places(scene);
    ASSERT_EQ(places.reports().size(), 4u);
    for (std::uint32_t listed = 0; listed < scene.objects.size(); ++listed) {
      SeenCloud cloud = SeenCloud::of_points(1);
      cloud.hidden() = {
          {.object = listed, .shell = {.elements = 3, .thickness = 0.1, .all = {}, .large = {}}}};
      places.take(1, cloud);
      for (const HiddenReport& each : places.reports()) EXPECT_EQ(each.thickness, kInfinity);
      places.take(0, cloud);
      for (const HiddenReport& each : places.reports()) {
        const ObjectPair& pair = scene.pairs[each.pair];
        const bool is_listed =
            !scene.objects[listed].is_seen() && (pair.first == listed || pair.second == listed);
        EXPECT_EQ(each.thickness, is_listed ? 0.1 : 0.0);
        EXPECT_EQ(each.elements, is_listed ? 3u : 0u);
      }
      places.forget(1);
      EXPECT_LT(places.reports()[0].thickness, kInfinity);
      places.forget(0);
      for (const HiddenReport& each : places.reports()) EXPECT_EQ(each.thickness, kInfinity);
    }
  }
}

}  // namespace
}  // namespace clearance::sensors_test
