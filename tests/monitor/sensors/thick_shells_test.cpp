// What is left out near a link whose place is uncertain counts for the pairs of all others; and
// what belongs to bodies that the cell knows is left out at their places only.
//
// Oracle: the places of the elements that the test puts in, by the lines through their pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/monitor/sensors/small_camera.hpp"

namespace clearance::sensors_test {
namespace {

// 2 m above the middle of the upper arm, which lies along x. x of the picture leads along x, y of
// the picture against y.
const std::string kOverTheArm =
    ", mount: {pose: {xyz: [0.5, 0, 2], rpy: [3.141592653589793, 0, 0]}}";

class ThickShells : public SensorsTest {
 protected:
  // A person beside the upper arm, 0.19 m above it, and something else far away.
  ImageText visitor(int number) {
    ImageText image = flat(number, 0);
    put(image, 3 * 8 + 4, 1750);
    put(image, 0, 1000);
    return image;
  }
  // The lower bound of the cart, half a metre beside the arm, in the frame of the image.
  double lower_of_the_cart(const ImageText& image) {
    add(image);
    const auto frames = settle(image.stamp_ns + 25'000'000);
    EXPECT_EQ(frames.size(), 1u);
    Monitor monitor(cell.scene);
    for (const SensorFrame& frame : frames) EXPECT_TRUE(monitor.show(0, frame));
    Pose at;
    at.position = {0.58, -0.5, 0.25};
    const Report& report =
        monitor.tick(std::vector{test::sample(0, at, image.stamp_ns)}, image.stamp_ns);
    const auto pair = std::ranges::find_if(report.pairs, [&](const PairReport& each) {
      return cell.scene.pairs[each.pair].first == 0;
    });
    EXPECT_NE(pair, report.pairs.end());
    return pair->lower;
  }
  // The element's cone is nearest to the cart at its greatest depth, on the side of -y.
  static constexpr double kExact = 0.5 - 0.5 / 11.0 * 2.0 * 1.76 - 0.1;
};

TEST_F(ThickShells, OfALinkWithASilentJointHideNoPersonFromThePairsOfOthers) {
  make(kImage + kOverTheArm);
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add_joints(0.0, kStart);
  const double lower = lower_of_the_cart(visitor(30));
  EXPECT_GT(sensors->status(0).own[2].elements + sensors->status(0).own[1].elements, 0u)
      << "it was left out with the arm";
  EXPECT_LE(lower, kExact);
  EXPECT_GT(lower, kExact - 0.2) << "what was left out is bounded by a box, not by the whole shell";
}

// The pixels are 4 mm wide, which is less than the thickness that counts as trusted.
TEST_F(ThickShells, HideNoSmallElementsFromThePairsOfOthers) {
  make(kImage + kOverTheArm);
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  add_joints(0.0, kStart);
  const double lower = lower_of_the_cart(visitor(30));
  EXPECT_GT(sensors->status(0).own[2].elements + sensors->status(0).own[1].elements, 0u)
      << "it was left out with the arm";
  const double exact = std::hypot(0.58 - 0.5 - 1.76 / 400.0, 0.5 - 1.76 / 400.0) - 0.1;
  EXPECT_LE(lower, exact);
  EXPECT_GT(lower, exact - 0.2);
}

TEST_F(ThickShells, AreTrustedUpToTheThicknessThatTheCellStates) {
  make(kImage + kOverTheArm + ", trusted_shell: 0.3");
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add_joints(0.0, kStart);
  EXPECT_GT(lower_of_the_cart(visitor(30)), 0.5) << "the cart's pair does without it, as stated";
}

TEST_F(ThickShells, AreThinWhileJointsCome) {
  make(kImage + kOverTheArm);
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add_joints(0.0, kStart);
  const ImageText image = visitor(1);
  add_joints(0.0, image.stamp_ns);
  EXPECT_NEAR(lower_of_the_cart(image), kExact, 0.02) << "nothing is left out: it is an obstacle";
}

class KnownBodies : public SensorsTest {
 protected:
  // A table whose top is 1 m below the camera, and where the cart is.
  void begin(const std::string& knows) {
    make(kImage + knows + kAbove, "",
         ", {name: table, fixed: true, pose: {xyz: [0, 0, 0.9]}, box: {size: [0.5, 0.5, 0.2]}}",
         "  - {between: [table, eye]}\n");
    add(Type::kCameraInfo, narrow().cdr(), kStart);
    add_joints(0.0, kStart - 100'000'000);
    add_joints(0.0, kStart);
  }
  std::size_t elements_beside(const ImageText& image) {
    ImageText with_far = image;
    put(with_far, 0, 400);  // something else, so that the frame shows something
    add_joints(0.0, image.stamp_ns);
    return elements(with_far) - 1;
  }
};

TEST_F(KnownBodies, AreLeftOutWhereTheCellHasThemAndAreObstaclesElsewhere) {
  begin(", knows: true, own_shell: 0.02");
  EXPECT_EQ(elements_beside(flat(1, 1000)), 0u) << "its top";
  EXPECT_EQ(elements_beside(flat(2, 1025)), 0u) << "within the shell";
  EXPECT_EQ(elements_beside(flat(3, 900)), 47u) << "a table that was lifted";
  ImageText can = flat(4, 1001);
  put(can, 20, 850);
  EXPECT_EQ(elements_beside(can), 1u) << "what stands on it";
  begin(", own_shell: 0.02");
  EXPECT_EQ(elements_beside(flat(1, 1000)), 47u) << "a camera that does not know it";
}

// A picture of the table alone shows that nothing else is there. One in which nothing is seen, or
// the depth is that of a place far below the table's top, does not.
TEST_F(KnownBodies, ThatAreSeenAtTheirPlacesShowThatNothingElseIsThere) {
  begin(", knows: true, own_shell: 0.02");
  const ImageText table = flat(1, 1000);
  add_joints(0.0, table.stamp_ns);
  add(table);
  const auto frames = settle(table.stamp_ns + 25'000'000);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].cloud->size(), 0u);
  cell.scene.gradients = true;
  for (ObjectPair& pair : cell.scene.pairs) pair.publish = true;
  Monitor monitor(cell.scene);
  ASSERT_TRUE(monitor.show(0, frames[0]));
  for (int i = 1; i < 5; ++i) {
    const std::int64_t now = table.stamp_ns + i * 1'000'000;
    const Report& report = monitor.tick({}, test::joints(0.01 * i, 0.0, 0.0, now), now);
    for (const PairReport& pair : report.pairs) {
      if (cell.scene.pairs[pair.pair].first == 0) continue;  // the cart was never heard
      EXPECT_LE(pair.lower, cell.scene.sensors[0].greatest_depth);
      EXPECT_GT(pair.lower, 0.9 * cell.scene.sensors[0].greatest_depth);
      EXPECT_GE(pair.upper, pair.lower);
      EXPECT_LT(pair.upper, kInfinity);
    }
    EXPECT_FALSE(report.gradients.rates.empty());
    EXPECT_TRUE(std::ranges::all_of(report.gradients.rates, [](double r) { return std::isnan(r); }))
        << "the place that is nearest is not known";
  }
  EXPECT_EQ(count(FrameFault::kNothingSeen), 0u);
  for (const std::uint16_t depth : {std::uint16_t{0}, std::uint16_t{1100}}) {
    begin(", knows: true, own_shell: 0.02");
    const ImageText other = flat(1, depth);
    add_joints(0.0, other.stamp_ns);
    EXPECT_EQ(elements(other), 0u);
    EXPECT_EQ(count(FrameFault::kNothingSeen), 1u) << depth;
    EXPECT_EQ(sensors->status(0).frames, 0u);
  }
}

// Pixels of a lens that is covered but for a corner show no more than their own rays.
TEST_F(KnownBodies, ThatFillLessThanAQuarterOfThePictureShowNothing) {
  for (const std::size_t seen : {1, 11, 12}) {
    begin(", knows: true, own_shell: 0.02");
    ImageText image = flat(1, 0);
    for (std::size_t pixel = 0; pixel < seen; ++pixel) put(image, 4 * pixel, 1000);
    add_joints(0.0, image.stamp_ns);
    EXPECT_EQ(elements(image), 0u);
    EXPECT_EQ(sensors->status(0).frames, seen == 12 ? 1u : 0u) << seen;
  }
}

// Most pixels show a place deep in the third box: it is elsewhere, and something may be in its
// place. The other boxes, which are where the cell has them, do not outvote it.
TEST_F(KnownBodies, ShowNothingWhereOneOfThemIsSeenThrough) {
  const auto box = [](const std::string& name, const std::string& x, const std::string& size) {
    return ", {name: " + name + ", fixed: true, pose: {xyz: [" + x + ", 0, 0]}, box: {size: [" +
           size + ", 6, 2]}}";
  };
  for (const std::uint16_t depth : {std::uint16_t{1000}, std::uint16_t{1900}}) {
    make(kImage + ", knows: true, own_shell: 0.02" + kAbove, "",
         box("left", "-2.1", "4") + box("middle", "0", "0.2") + box("right", "2.1", "4"),
         "  - {between: [left, eye]}\n  - {between: [middle, eye]}\n  - {between: [right, eye]}\n");
    add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
    add_joints(0.0, kStart);
    ImageText image = flat(1, 1000);
    for (std::size_t row = 0; row < 6; ++row) {
      put(image, 8 * row + 5, 0);
      for (const std::size_t column : {6, 7}) put(image, 8 * row + column, row == 0 ? 1000 : depth);
    }
    add_joints(0.0, image.stamp_ns);
    EXPECT_EQ(elements(image), 0u);
    EXPECT_EQ(sensors->status(0).frames, depth == 1000 ? 1u : 0u);
  }
}

// The arm fills the picture. Its surface is that of the table as well, which nothing shows.
TEST_F(KnownBodies, ShowNothingWhereALinkIsSeen) {
  for (const bool knows : {false, true}) {
    make(kImage + (knows ? ", knows: true" : "") + kOverTheArm, "",
         ", {name: table, fixed: true, pose: {xyz: [0.5, 0, 0]}, box: {size: [0.5, 0.5, 0.1]}}",
         "  - {between: [table, eye]}\n");
    add(Type::kCameraInfo, narrow().cdr(), kStart);
    add_joints(0.0, kStart);
    const ImageText image = flat(1, 1950);
    add_joints(0.0, image.stamp_ns);
    EXPECT_EQ(elements(image), 0u);
    EXPECT_EQ(count(FrameFault::kNothingSeen), 1u);
  }
}

// Dark pictures show nothing, but count as frames. A person stands at half of the table.
TEST_F(KnownBodies, ShowNothingWhereAnElementIsHiddenAsSpeckle) {
  begin(", knows: true, own_shell: 0.02, max_speed: 0.5, persist: {frames: 2, of: 3}");
  for (int i = 1; i < 6; ++i) {
    ImageText image = flat(i, i < 4 ? 0 : static_cast<std::uint16_t>(1000 + i));
    for (std::size_t pixel = 0; i >= 4 && pixel < 24; ++pixel)
      put(image, pixel, static_cast<std::uint16_t>(700 + i));
    add_joints(0.0, image.stamp_ns);
    EXPECT_EQ(elements(image), i == 5 ? 24u : 0u) << i;
    EXPECT_EQ(sensors->status(0).frames, i == 5 ? 1u : 0u) << i;
  }
}

// A person who has been there from the start is in no frame before two have the place.
TEST_F(KnownBodies, ShowNothingUntilEnoughFramesHavePersisted) {
  begin(", knows: true, own_shell: 0.02, max_speed: 0.5, persist: {frames: 2, of: 3}");
  for (int i = 1; i < 4; ++i) {
    ImageText image = flat(i, static_cast<std::uint16_t>(1000 + i));
    put(image, 20, static_cast<std::uint16_t>(700 + i));
    add_joints(0.0, image.stamp_ns);
    EXPECT_EQ(elements(image), i == 1 ? 0u : 1u) << i;
    EXPECT_EQ(sensors->status(0).frames, static_cast<std::uint64_t>(i - 1)) << i;
  }
}

// The place of the cart is that of the stamp.
TEST_F(KnownBodies, ThatAreTrackedAreLeftOutWhereTheyWereAtTheStamp) {
  begin(", knows: true, own_shell: 0.03");
  const auto cart_at = [&](double z, std::int64_t stamp_ns) {
    Pose pose;
    pose.position.z() = z;
    sensors->add(std::vector{test::sample(0, pose, stamp_ns)}, {}, stamp_ns);
  };
  cart_at(1.4, kStart);
  const ImageText first = flat(1, 500);  // the top of the cart is half a metre below the camera
  cart_at(1.4, first.stamp_ns);
  EXPECT_EQ(elements_beside(first), 0u);
  begin(", knows: true, own_shell: 0.03");
  cart_at(1.2, kStart);
  cart_at(1.2, first.stamp_ns);
  EXPECT_EQ(elements_beside(first), 47u) << "it is 0.2 m lower";
}

}  // namespace
}  // namespace clearance::sensors_test
