// A camera tells where a robot is not where its joints say. Pictures are rendered of a machine that
// is off its model, with noise within the stated bound.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "tests/monitor/sensors/witnessed_cell.hpp"

namespace clearance {
namespace {

using test::two_arms_and_eye;
using test::variable_of;
using test::WitnessedCell;

TEST(SecondWitness, AgreesWithAMachineThatIsAsStated) {
  WitnessedCell watched(two_arms_and_eye());
  for (int i = 0; i < 12; ++i) {
    for (std::size_t v = 0; v < watched.positions().size(); ++v)
      watched.positions()[v] += 0.002 * std::sin(0.3 * i + static_cast<double>(v));
    const RaysOfRobot rays = watched.look(0);
    EXPECT_GT(rays.agreeing, 100u);
    EXPECT_EQ(rays.through, 0u);
    EXPECT_LT(std::abs(rays.residual_p50), 0.001);
    EXPECT_GE(rays.residual_p90, std::abs(rays.residual_p50));
    EXPECT_LT(rays.residual_p90, 0.0105) << "the noise at the greatest depth of the arm";
    EXPECT_FALSE(watched.is_unknown(0));
    EXPECT_FALSE(watched.is_unknown(1));
  }
}

// The mean of the medians of eight pictures, m; the robot must not be denied meanwhile.
double mean_residual(WitnessedCell& watched, std::uint32_t robot) {
  double sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    sum += watched.look(robot).residual_p50;
    EXPECT_FALSE(watched.is_unknown(robot));
  }
  return sum / 8;
}

// A median over hundreds of rays is sure to a small part of the noise, which is 8 mm here. Most of
// these rays meet links that a lost zero of the second joint hardly moves.
TEST(SecondWitness, ShowsALostZeroBeforeItDeniesTheRobot) {
  const auto residual = [](double lost, const std::string& errors, std::uint32_t robot = 0) {
    WitnessedCell watched(two_arms_and_eye(errors));
    watched.off()[variable_of(watched.cell(), "left_joint2")] = lost;
    return mean_residual(watched, robot);
  };
  const std::string stated = "errors: {joints: {position: 0.02}}\n";
  for (const std::string& errors : {std::string(), stated}) {
    const double good = residual(0.0, errors);
    EXPECT_LT(std::abs(good), 0.0002) << errors;
    EXPECT_LT(residual(0.004, errors), good - 0.0001) << "nearer: " << errors;
    EXPECT_GT(residual(-0.004, errors), good + 0.0001) << "farther: " << errors;
  }
  EXPECT_GT(residual(-0.01, stated), residual(-0.004, stated)) << "it grows with the fault";
  EXPECT_NEAR(residual(0.004, stated, 1), residual(0.0, stated, 1), 1e-6) << "the other arm";
}

// Links before the joint are where they were, but for what the others hide of them.
TEST(SecondWitness, ShowsWhichLinksALostZeroMoves) {
  const std::string stated = "errors: {joints: {position: 0.02}}\n";
  WitnessedCell good(two_arms_and_eye(stated)), off(two_arms_and_eye(stated));
  off.off()[variable_of(off.cell(), "left_joint4")] = -0.01;
  const RaysOfRobot before = good.look(0), after = off.look(0);
  const Robot& robot = good.cell().scene.robots[0];
  std::size_t carries = 0;  // the joint; link carries + 1 is the first that hangs on it
  while (robot.joints[carries].name != "left_joint4") ++carries;
  std::uint32_t agreeing = 0;
  double still = 0.0, moved = 0.0;  // the largest change of a median
  for (std::size_t link = 0; link < robot.links.size(); ++link) {
    const RaysMet &was = before.links[link], &is = after.links[link];
    agreeing += was.agreeing;
    EXPECT_LE(std::isnan(was.residual_p50), was.agreeing < 2 * Witness::kLeastRays);
    if (std::isnan(was.residual_p50) || std::isnan(is.residual_p50)) continue;
    double& change = link > carries ? moved : still;
    change = std::max(change, std::abs(is.residual_p50 - was.residual_p50));
  }
  EXPECT_EQ(agreeing, before.agreeing) << "each ray is of one link";
  EXPECT_LT(still, 0.0002);
  EXPECT_GT(moved, 0.0005) << "by up to 10 mrad over its length";
}

TEST(SecondWitness, SeesALostZeroOfAJointInFivePictures) {
  WitnessedCell watched(two_arms_and_eye());
  watched.off()[variable_of(watched.cell(), "left_joint2")] = -0.2;
  EXPECT_EQ(watched.pictures_until_denied(0), 5);
  EXPECT_FALSE(watched.is_unknown(1)) << "the other arm is where its joints say";
}

// Something nearer than the robot may stand in front of it.
TEST(SecondWitness, IsNotSureOfWhatIsNearer) {
  WitnessedCell watched(two_arms_and_eye());
  watched.off()[variable_of(watched.cell(), "left_joint2")] = 0.2;
  EXPECT_EQ(watched.pictures_until_denied(0), 0);
}

TEST(SecondWitness, TakesARobotBackAfterFivePicturesOfIt) {
  WitnessedCell watched(two_arms_and_eye());
  const std::uint32_t lift = variable_of(watched.cell(), "left_joint2");
  watched.off()[lift] = -0.2;
  ASSERT_GT(watched.pictures_until_denied(0), 0);
  watched.off()[lift] = 0.0;
  for (int i = 1; i < 5; ++i) {
    watched.look(0);
    EXPECT_TRUE(watched.is_unknown(0)) << i;
  }
  watched.look(0);
  EXPECT_FALSE(watched.is_unknown(0));
}

TEST(SecondWitness, SeesABumpedCamera) {
  WitnessedCell watched(two_arms_and_eye());
  watched.camera_shift() = Vec3(0.0, 0.06, 0.0);
  EXPECT_GT(watched.pictures_until_denied(0), 0);
}

// The smallest of these sizes with which a fault is found, in either direction, within 5
// pictures; infinity: none.
template <class Apply>
double smallest_found(const Apply& apply, std::initializer_list<double> sizes) {
  for (const double size : sizes) {
    for (const double sign : {1.0, -1.0}) {
      WitnessedCell watched(two_arms_and_eye());
      // The arm is stretched to the side, so that its links stand apart.
      watched.positions()[variable_of(watched.cell(), "left_joint1")] = 1.2;
      watched.positions()[variable_of(watched.cell(), "left_joint4")] = 0.9;
      apply(watched, sign * size);
      if (watched.pictures_until_denied(0, 5) > 0) return size;
    }
  }
  return kInfinity;
}

TEST(SecondWitness, FindsSmallFaults) {
  const std::initializer_list<double> angles = {0.01, 0.02, 0.04}, lengths = {0.005, 0.01};
  for (const auto& [joint, most] :
       {std::pair("left_joint1", 0.04), {"left_joint2", 0.01}, {"left_joint4", 0.02}}) {
    const auto lose_zero = [&, name = joint](WitnessedCell& watched, double by) {
      watched.off()[variable_of(watched.cell(), name)] = by;
    };
    const double found = smallest_found(lose_zero, angles);
    EXPECT_LE(found, most) << joint;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto bump_base = [&](WitnessedCell& watched, double by) {
      watched.errors().bases[0].shift[axis] = by;
    };
    const auto bump_camera = [&](WitnessedCell& watched, double by) {
      watched.camera_shift()[axis] = by;
    };
    const double base = smallest_found(bump_base, lengths);
    const double camera = smallest_found(bump_camera, lengths);
    EXPECT_LE(std::max(base, camera), 0.01) << axis;
  }
}

TEST(SecondWitness, AllowsWhatIsStated) {
  WitnessedCell strict(two_arms_and_eye()),
      allowing(two_arms_and_eye("errors: {joints: {position: 0.02}}\n"));
  for (WitnessedCell* watched : {&strict, &allowing})
    watched->off()[variable_of(watched->cell(), "left_joint2")] = -0.02;
  EXPECT_EQ(allowing.pictures_until_denied(0), 0);
  EXPECT_EQ(allowing.look(0).through, 0u);
  EXPECT_GT(strict.look(0).through, 0u);
}

}  // namespace
}  // namespace clearance
