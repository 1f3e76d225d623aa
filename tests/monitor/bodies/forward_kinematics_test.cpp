// Oracle: products of 4 x 4 matrices of long doubles, made of the numbers in a URDF. Twists are
// compared with its differences.
#include "monitor/bodies/forward_kinematics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "config/urdf/robot_files.hpp"
#include "core/model/rotation_between.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using Long = long double;
using LongVec3 = Eigen::Matrix<Long, 3, 1>;
using LongMat3 = Eigen::Matrix<Long, 3, 3>;

struct LongFrame {
  LongMat3 rotation = LongMat3::Identity();
  LongVec3 position = LongVec3::Zero();
  [[nodiscard]] LongVec3 place(const LongVec3& point) const { return rotation * point + position; }
};

LongFrame operator*(const LongFrame& a, const LongFrame& b) {
  return {a.rotation * b.rotation, a.place(b.position)};
}

// Rodrigues' rotation formula.
LongMat3 about(const Vec3& axis, Long angle) {
  const LongVec3 n = axis.cast<Long>().normalized();
  LongMat3 cross;
  cross << 0, -n.z(), n.y(), n.z(), 0, -n.x(), -n.y(), n.x(), 0;
  return LongMat3::Identity() + std::sin(angle) * cross + (1 - std::cos(angle)) * (cross * cross);
}

// A robot, and the numbers that its URDF would contain.
struct Written {
  Robot robot;
  std::vector<UrdfOrigin> origins;  // origins of the joints
  std::vector<JointVariable> variables;
};

// Trees of joints of all types. Some joints mimic an earlier one.
Written random_robot(Random& random, int joints, JointType only = JointType::kFixed) {
  Written written;
  written.robot.links.resize(1);
  written.robot.base.base_from_root = random.pose(2.0);
  for (int i = 0; i < joints; ++i) {
    RobotJoint joint;
    joint.type = only == JointType::kFixed ? static_cast<JointType>(random.integer(0, 5)) : only;
    joint.parent = static_cast<std::uint32_t>(random.integer(std::max(0, i - 2), i));
    const UrdfOrigin origin{random.in_box(0.5), random.in_box(3.2)};
    joint.parent_from_joint = pose_of(origin);
    joint.axis = random.direction();
    const auto turn = rotation_between(Vec3::UnitZ(), joint.axis);
    joint.plane_x = turn * Vec3::UnitX();
    joint.plane_y = turn * Vec3::UnitY();
    if (joint.type == JointType::kFloating) {
      joint.axis = Vec3::UnitZ();
      joint.plane_x = Vec3::UnitX();
      joint.plane_y = Vec3::UnitY();
    }
    joint.variable = static_cast<std::uint32_t>(written.variables.size());
    const bool one = variables_of(joint.type) == 1;
    const RobotJoint* followed =
        written.robot.joints.empty() ? nullptr : &written.robot.joints.back();
    if (one && followed != nullptr && variables_of(followed->type) == 1 && random.chance(0.2)) {
      joint.variable = followed->variable;
      joint.multiplier = random.uniform(-2.0, 2.0);
      joint.offset = random.uniform(-1.0, 1.0);
    } else {
      for (std::uint32_t k = 0; k < variables_of(joint.type); ++k) {
        written.variables.emplace_back().age_limit_ns = 20'000'000;
      }
    }
    written.robot.joints.push_back(joint);
    written.robot.links.emplace_back();
    written.origins.push_back(origin);
  }
  return written;
}

// Random states in which all variables are known, on time and moving.
std::vector<TrackedVariable> random_positions(Random& random, const Written& written) {
  std::vector<TrackedVariable> states(written.variables.size());
  for (TrackedVariable& state : states) {
    state.input.has_value = state.velocity_known = true;
    state.position = random.uniform(-4.0, 4.0);
    state.velocity = random.uniform(-2.0, 2.0);
    state.input.stamp_ns = random.integer(1, 1000);
  }
  for (const RobotJoint& joint : written.robot.joints) {
    if (joint.type != JointType::kFloating) continue;
    const Eigen::Quaterniond turn = random.rotation();
    for (std::uint32_t k = 0; k < 4; ++k)
      states[joint.variable + 3 + k].position = turn.coeffs()[k];
  }
  return states;
}

// The exact pose of every link in the world, `later` seconds after the positions.
std::vector<LongFrame> exactly(const Written& written, const std::vector<TrackedVariable>& states,
                               Long later = 0) {
  const Pose& base = written.robot.base.base_from_root;
  std::vector<LongFrame> links = {
      {base.orientation.cast<Long>().normalized().toRotationMatrix(), base.position.cast<Long>()}};
  for (std::size_t i = 0; i < written.robot.joints.size(); ++i) {
    const RobotJoint& joint = written.robot.joints[i];
    const UrdfOrigin& origin = written.origins[i];
    const auto value = [&](std::uint32_t k) -> Long {
      const TrackedVariable& state = states[joint.variable + k];
      return joint.multiplier * (state.position + later * state.velocity) + joint.offset;
    };
    LongFrame at{about(Vec3::UnitZ(), origin.rpy.z()) * about(Vec3::UnitY(), origin.rpy.y()) *
                     about(Vec3::UnitX(), origin.rpy.x()),
                 origin.xyz.cast<Long>()};
    LongFrame moved;
    const auto along = [](const Vec3& axis) { return axis.cast<Long>().eval(); };
    switch (joint.type) {
      case JointType::kFixed:
        break;
      case JointType::kRevolute:
      case JointType::kContinuous:
        moved.rotation = about(joint.axis, value(0));
        break;
      case JointType::kPrismatic:
        moved.position = value(0) * along(joint.axis);
        break;
      case JointType::kPlanar:
        moved.position = value(0) * along(joint.plane_x) + value(1) * along(joint.plane_y);
        moved.rotation = about(joint.axis, value(2));
        break;
      case JointType::kFloating:
        moved.position = LongVec3(value(0), value(1), value(2));
        moved.rotation = Eigen::Quaternion<Long>(value(6), value(3), value(4), value(5))
                             .normalized()
                             .toRotationMatrix();
        break;
    }
    links.push_back(links[joint.parent] * at * moved);
  }
  return links;
}

// The distance between the positions of a link's point in two poses.
Long apart(const LongFrame& a, const LongFrame& b, const Vec3& point) {
  const LongVec3 exact = point.cast<Long>();
  return (a.place(exact) - b.place(exact)).norm();
}

LongFrame frame_of(const Pose& pose) {
  return {pose.orientation.cast<Long>().normalized().toRotationMatrix(),
          pose.position.cast<Long>()};
}

TEST(ForwardKinematics, PlacesEveryLinkWithinItsError) {
  Random random(1);
  double widest = 0.0;
  Long worst = 0.0L;
  for (int i = 0; i < 400; ++i) {
    const Written written = random_robot(random, random.integer(1, 12));
    const auto states = random_positions(random, written);
    ForwardKinematics kinematics(std::span(&written.robot, 1));
    kinematics.place(states, {});
    const std::vector<LongFrame> exact = exactly(written, states);
    for (std::size_t link = 0; link < exact.size(); ++link) {
      const LinkState& state = kinematics.links(0)[link];
      ASSERT_TRUE(state.known);
      const Vec3 point = random.in_box(0.5);
      const Long off = apart(exact[link], frame_of(state.pose), point);
      const double bound = state.error(point.norm());
      ASSERT_LE(off, bound) << "case " << i << ", link " << link;
      ASSERT_TRUE(is_unit(state.pose.orientation));
      worst = std::max(worst, off);
      widest = std::max(widest, bound);
    }
  }
  EXPECT_LT(widest, 1e-11);  // m, for 12 joints that slide by metres
  EXPECT_LT(worst, 1e-13L);
}

TEST(ForwardKinematics, TwistsAreTheDerivativesOfPoses) {
  Random random(2);
  constexpr Long kStep = 1e-5L;
  for (int i = 0; i < 200; ++i) {
    const Written written = random_robot(random, random.integer(1, 8));
    const auto states = random_positions(random, written);
    ForwardKinematics kinematics(std::span(&written.robot, 1));
    kinematics.place(states, {});
    const auto before = exactly(written, states, -kStep), after = exactly(written, states, kStep);
    for (std::size_t link = 0; link < before.size(); ++link) {
      const LinkState& state = kinematics.links(0)[link];
      ASSERT_TRUE(state.velocity_known);
      const Vec3 point = random.in_box(0.5);
      const LongVec3 exact = point.cast<Long>();
      const LongVec3 difference =
          (after[link].place(exact) - before[link].place(exact)) / (2 * kStep);
      const Vec3 arm = transform(state.pose, point) - state.pose.position;
      const Vec3 velocity = state.twist.linear + state.twist.angular.cross(arm);
      ASSERT_LT((velocity - difference.cast<double>()).norm(), 2e-6 * (1.0 + velocity.norm()))
          << "case " << i << ", link " << link;
    }
  }
}

TEST(ForwardKinematics, NoPointOfALateLinkIsFartherThanItMayHaveMoved) {
  Random random(3);
  double tightest = 0.0;
  for (int i = 0; i < 400; ++i) {
    const Written written = random_robot(random, random.integer(1, 8));
    auto states = random_positions(random, written);
    for (TrackedVariable& state : states) {
      state.input.late = random.chance(0.4);
      if (state.input.late) state.may_have_moved = random.log_uniform(1e-4, 1.0);
    }
    ForwardKinematics kinematics(std::span(&written.robot, 1));
    kinematics.place(states, {});
    const auto stamped = exactly(written, states);
    auto moved = states;
    for (int k = 0; k < 20; ++k) {
      for (std::size_t v = 0; v < states.size(); ++v) {
        const double most = states[v].may_have_moved;
        moved[v].position =
            states[v].position + (k % 2 == 0 ? random.sign() * most : random.uniform(-most, most));
      }
      const auto now = exactly(written, moved);
      for (std::size_t link = 0; link < now.size(); ++link) {
        const Vec3 point = random.in_box(0.5);
        const Long off = apart(stamped[link], now[link], point);
        const double bound = kinematics.links(0)[link].may_have_moved(point.norm());
        ASSERT_LE(off, bound + 1e-13) << "case " << i << ", link " << link;
        if (bound > 1e-6) tightest = std::max(tightest, static_cast<double>(off) / bound);
      }
    }
  }
  EXPECT_GT(tightest, 0.8);
}

// A planar or floating joint is known if all of its positions are, and is as old as the oldest.
TEST(ForwardKinematics, OnlyWhatHangsOnAnUnknownJointIsUnknown) {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Written written = random_robot(random, 8);
    auto states = random_positions(random, written);
    for (TrackedVariable& state : states) state.input.has_value = random.chance(0.9);
    ForwardKinematics kinematics(std::span(&written.robot, 1));
    kinematics.place(states, {});
    std::vector<bool> known = {true};
    std::vector<std::int64_t> oldest = {std::numeric_limits<std::int64_t>::max()};
    for (std::size_t k = 0; k < written.robot.joints.size(); ++k) {
      const RobotJoint& joint = written.robot.joints[k];
      known.push_back(known[joint.parent]);
      oldest.push_back(oldest[joint.parent]);
      for (std::uint32_t v = 0; v < variables_of(joint.type); ++v) {
        const InputRecord& input = states[joint.variable + v].input;
        known.back() = known.back() && input.has_value;
        oldest.back() = std::min(oldest.back(), input.stamp_ns);
      }
      const LinkState& link = kinematics.links(0)[k + 1];
      ASSERT_EQ(link.known, known.back());
      if (!link.known) continue;
      ASSERT_EQ(link.stamp_ns, oldest.back());
    }
  }
}

TEST(ForwardKinematics, ALateJointMakesWhatItCarriesLateAndItsVelocityUnknown) {
  Random random(5);
  Written written = random_robot(random, 3, JointType::kRevolute);
  for (std::uint32_t i = 0; i < 3; ++i) {
    written.robot.joints[i].parent = i;
    written.robot.joints[i].variable = i;
    written.robot.joints[i].multiplier = 1.0;
  }
  std::vector<TrackedVariable> states(3);
  for (TrackedVariable& state : states) state.input.has_value = state.velocity_known = true;
  states[1].input.late = true;
  states[1].may_have_moved = std::numeric_limits<double>::infinity();
  ForwardKinematics kinematics(std::span(&written.robot, 1));
  kinematics.place(states, {});
  const auto links = kinematics.links(0);
  EXPECT_FALSE(links[1].late);
  EXPECT_TRUE(links[1].velocity_known);
  EXPECT_EQ(links[1].may_have_moved(1.0), 0.0);
  for (const std::size_t link : {2, 3}) {
    EXPECT_TRUE(links[link].late);
    EXPECT_FALSE(links[link].velocity_known);
    EXPECT_EQ(links[link].twist.linear, Vec3::Zero());
  }
  // However far the joint has rotated, the link that it carries moves on a circle about its axis.
  EXPECT_NEAR(links[2].may_have_moved(0.5), 1.0, 1e-12);
}

TEST(ForwardKinematics, ARobotStandsOnALinkOfAnotherOrOnAnObject) {
  Random random(6);
  std::vector<Robot> robots;
  for (int i = 0; i < 3; ++i) {
    robots.push_back(random_robot(random, 1, JointType::kRevolute).robot);
    robots.back().joints[0].variable = static_cast<std::uint32_t>(i);
  }
  robots[1].base.kind = RobotBase::Kind::kLink;
  robots[1].base.link = 1;
  robots[2].base.kind = RobotBase::Kind::kObject;
  std::vector<TrackedVariable> states(3);
  for (TrackedVariable& state : states) {
    state.input.has_value = state.velocity_known = true;
    state.position = random.uniform(-1.0, 1.0);
    state.velocity = 1.0;
  }
  std::vector<LinkState> bases(3);
  bases[2].known = bases[2].velocity_known = true;
  bases[2].stamp_ns = 7;
  bases[2].pose = random.pose(1.0);
  bases[2].twist = {random.in_box(1.0), random.in_box(1.0)};
  ForwardKinematics kinematics(robots);
  kinematics.place(states, bases);
  const auto holds = [&](const LinkState& under, const Pose& base_from_root,
                         const LinkState& root) {
    const Pose expected = compose(under.pose, base_from_root);
    EXPECT_LT((root.pose.position - expected.position).norm(), 1e-14);
    EXPECT_GT(std::abs(root.pose.orientation.dot(expected.orientation)), 1.0 - 1e-14);
    EXPECT_EQ(root.twist.angular, under.twist.angular);
    const Vec3 arm = root.pose.position - under.pose.position;
    EXPECT_LT((root.twist.linear - under.twist.linear - under.twist.angular.cross(arm)).norm(),
              1e-14);
  };
  holds(kinematics.links(0)[1], robots[1].base.base_from_root, kinematics.links(1)[0]);
  holds(bases[2], robots[2].base.base_from_root, kinematics.links(2)[0]);
  EXPECT_EQ(kinematics.links(2)[1].stamp_ns, 0);

  bases[2].late = true;
  states[0].input.has_value = false;
  kinematics.place(states, bases);
  EXPECT_EQ(kinematics.links(2)[1].may_have_moved(0.0), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(kinematics.links(0)[0].known);
  EXPECT_FALSE(kinematics.links(1)[0].known);
  EXPECT_FALSE(kinematics.links(1)[1].known);
}

TEST(ForwardKinematics, AnAngleThatMimicryMakesTooLargeIsUnknown) {
  Random random(9);
  Written written = random_robot(random, 1, JointType::kRevolute);
  std::vector<TrackedVariable> states(1);
  states[0].input.has_value = true;
  states[0].position = 1.0;
  for (const double multiplier : {1e3, 1e9}) {
    written.robot.joints[0].multiplier = multiplier;
    ForwardKinematics kinematics(std::span(&written.robot, 1));
    kinematics.place(states, {});
    EXPECT_EQ(kinematics.links(0)[1].known, multiplier < kLargestJoint);
  }
}

TEST(ForwardKinematics, AQuaternionThatIsNoneLeavesItsLinkUnknown) {
  Random random(7);
  const Written written = random_robot(random, 1, JointType::kFloating);
  auto states = random_positions(random, written);
  ForwardKinematics kinematics(std::span(&written.robot, 1));
  kinematics.place(states, {});
  EXPECT_TRUE(kinematics.links(0)[1].known);
  for (std::size_t k = 3; k < 7; ++k) states[k].position = 0.0;
  kinematics.place(states, {});
  EXPECT_FALSE(kinematics.links(0)[1].known);
}

TEST(ForwardKinematics, AllocatesNothingAndGivesTheSameBitsAgain) {
  Random random(8);
  const Written written = random_robot(random, 40);
  const auto states = random_positions(random, written);
  ForwardKinematics kinematics(std::span(&written.robot, 1));
  kinematics.place(states, {});
  const std::vector<LinkState> first(kinematics.links(0).begin(), kinematics.links(0).end());
  kinematics.place(random_positions(random, written), {});
  const std::uint64_t before = allocations();
  kinematics.place(states, {});
  EXPECT_EQ(allocations(), before);
  for (std::size_t link = 0; link < first.size(); ++link) {
    const LinkState& again = kinematics.links(0)[link];
    ASSERT_EQ(again.pose.position, first[link].pose.position);
    ASSERT_EQ(again.pose.orientation.coeffs(), first[link].pose.orientation.coeffs());
    ASSERT_EQ(again.twist.linear, first[link].twist.linear);
    ASSERT_EQ(again.twist.angular, first[link].twist.angular);
  }
}

}  // namespace
}  // namespace clearance
