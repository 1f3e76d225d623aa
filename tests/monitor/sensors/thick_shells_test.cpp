// What is left out near a link whose place is uncertain counts for the pairs of all others; and
// what belongs to bodies that the cell knows is left out at their places only.
//
// Oracle: the places of the elements that the test puts in, by the lines through their pixels.
#include <gtest/gtest.h>

#include <algorithm>

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
