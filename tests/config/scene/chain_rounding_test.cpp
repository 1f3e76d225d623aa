// Links lie within these errors of the places that forward kinematics computes.
//
// Oracle: a straight chain in which each joint turns by its error in the same direction, so that
// the displacements of a link add up. Rounding adds a share of each length and of each place.
#include "config/scene/chain_rounding.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/shapes.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

constexpr double kStandsAt = 2.0, kLinkLength = 0.5, kSlidesBy = 0.3;  // m
constexpr std::size_t kChainJoints = 5;

struct Chain {
  std::vector<Robot> robots = std::vector<Robot>(1);
  std::vector<JointVariable> variables = std::vector<JointVariable>(1);
};

// Makes a chain along x: a base, and joints of one type.
Chain straight(JointType type) {
  Chain chain;
  Robot& robot = chain.robots[0];
  robot.base.base_from_root = test::at(kStandsAt, 0, 0);
  robot.links.resize(kChainJoints + 1);
  for (std::uint32_t i = 0; i < kChainJoints; ++i)
    robot.joints.push_back(
        {.name = "", .type = type, .parent = i, .parent_from_joint = test::at(kLinkLength, 0, 0)});
  chain.variables[0].lower = -kSlidesBy;
  chain.variables[0].upper = 0.5 * kSlidesBy;
  return chain;
}

// `turned` is the error of each joint, rad; `slide` is how far each joint moves, m.
ChainError expected(std::size_t link, double turned, double slide) {
  const auto place = [&](std::size_t i) {
    return kStandsAt + static_cast<double>(i) * (kLinkLength + slide);
  };
  ChainError error{.shift = 0.0, .turn = kJointError};
  for (std::size_t i = 0; i <= link; ++i) {
    const double length = i == 0 ? kStandsAt : kLinkLength + slide;
    error.shift += kJointError * length + kPlacingError * place(i);  // its own length and place
    error.shift += i == 0 ? 0.0 : kPositionError * slide;
    if (i < link) error.shift += (i == 0 ? kJointError : turned) * (place(link) - place(i));
    if (i > 0) error.turn += turned;
  }
  return error;
}

void expect_errors(JointType type, double turned, double slide) {
  const Chain chain = straight(type);
  const std::vector<ChainError> found = chain_rounding(chain.robots, chain.variables);
  ASSERT_EQ(found.size(), kChainJoints + 1);
  for (std::size_t link = 0; link <= kChainJoints; ++link) {
    const ChainError least = expected(link, turned, slide);
    EXPECT_GE(found[link].shift, least.shift * (1 - 1e-12)) << link;
    EXPECT_LE(found[link].shift, least.shift * (1 + 1e-9)) << link;
    EXPECT_GE(found[link].turn, least.turn * (1 - 1e-12)) << link;
    EXPECT_LE(found[link].turn, least.turn * (1 + 1e-9)) << link;
  }
}

TEST(ChainRounding, OfAStraightChainIsTheSumOfWhatItsJointsAdd) {
  expect_errors(JointType::kFixed, kJointError, 0.0);
  expect_errors(JointType::kRevolute, kJointError + kPositionError * kLeastSureAngle, 0.0);
  expect_errors(JointType::kPrismatic, kJointError, kSlidesBy);
}

TEST(ChainRounding, OfARobotOnAnotherBeginsWithThatOfTheLinkThatCarriesIt) {
  Chain chain = straight(JointType::kFixed);
  Robot tool;
  tool.base.kind = RobotBase::Kind::kLink;
  tool.base.link = kChainJoints - 1;
  tool.base.base_from_root = test::at(kLinkLength, 0, 0);
  tool.links.resize(1);
  chain.robots.push_back(tool);
  const std::vector<ChainError> found = chain_rounding(chain.robots, chain.variables);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].shift, expected(kChainJoints, kJointError, 0.0).shift, 1e-20);
}

TEST(ChainRounding, WidensEveryErrorOfAnObjectsParts) {
  constexpr double kShift = 1e-9, kTurn = 1e-10, kArm = 3.0, kRadius = 0.5;
  Object object;
  object.parts = {{"ball", test::made(point(Vec3::Zero(), kRadius)), test::at(kArm, 0, 0)},
                  {"cube", test::cube(), {}},
                  {"far", test::cube(), {}}};
  object.parts[1].shape.inner_radius = 0.5 * kShift;
  const Object before = object;
  account_for({.shift = kShift, .turn = kTurn}, object);
  // The lever arm counts twice.
  EXPECT_NEAR(object.pose_error, kShift + 2.0 * kTurn * (kArm + kRadius), 1e-15);
  for (std::size_t i = 0; i < 3; ++i) {
    const ConvexBody &was = before.parts[i].shape, &is = object.parts[i].shape;
    EXPECT_EQ(is.position_error, was.position_error + object.pose_error) << i;
    EXPECT_EQ(is.error_bound_as_a, was.error_bound_as_a + object.pose_error) << i;
    EXPECT_EQ(is.error_bound_as_b, was.error_bound_as_b + object.pose_error) << i;
  }
  EXPECT_EQ(object.parts[2].shape.inner_radius,
            before.parts[2].shape.inner_radius - object.pose_error);
  EXPECT_EQ(object.parts[1].shape.inner_radius, 0.0) << "nothing is certainly inside";
}

}  // namespace
}  // namespace clearance
