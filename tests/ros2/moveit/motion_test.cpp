// Checks of whole motions: closed forms, and exact distances at many instants.
#include "arm_scene.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>

static thread_local std::size_t taken_from_heap = 0;  // calls of new
void* operator new(std::size_t size) {
  ++taken_from_heap;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

using collision_detection::AllowedCollisionMatrix;
using collision_detection::CollisionRequest;
using collision_detection::CollisionResult;
using moveit::core::RobotState;

constexpr double kTip = 1.22, kRadius = 0.06;

struct Motion {
  ArmScene& scene;
  RobotState from, to;

  Motion(ArmScene& in, const std::vector<double>& begin, const std::vector<double>& end)
      : scene(in), from(in.state), to(in.state) {
    from.setJointGroupActivePositions("all", begin);
    to.setJointGroupActivePositions("all", end);
    from.update();
    to.update();
  }
  // Every joint moves linearly. The tests that use it keep away from half a turn.
  [[nodiscard]] RobotState at(double share) const {
    RobotState state(from);
    for (std::size_t i = 0; i < state.getVariableCount(); ++i) {
      const double begin = from.getVariablePosition(static_cast<int>(i));
      const double end = to.getVariablePosition(static_cast<int>(i));
      state.setVariablePosition(static_cast<int>(i), begin + share * (end - begin));
    }
    state.update();
    return state;
  }
  [[nodiscard]] CollisionResult check(bool distance = false,
                                      const AllowedCollisionMatrix& matrix = {}) const {
    CollisionRequest request;
    request.contacts = true;
    request.distance = distance;
    CollisionResult result;
    scene.ours.checkRobotCollision(request, result, from, to, matrix);
    return result;
  }
  [[nodiscard]] double share_of_contact() const {
    const CollisionResult result = check();
    if (result.contacts.size() != 1) return std::nan("");
    return result.contacts.begin()->second.front().percent_interpolation;
  }
};

struct MoveItMotions : testing::Test {
  ArmScene scene;
  Motion sweep{scene, {0.0, 0.0, -0.3}, {0.0, 0.0, 0.3}};  // of the ball, along x
};

TEST_F(MoveItMotions, MeetAThinSheetThatBothEndsMiss) {
  scene.add("sheet", box_thing({0.001, 0.5, 0.05}), Eigen::Vector3d(0.1, 0.0, kTip + 0.025));
  CollisionResult end;
  scene.ours.checkRobotCollision({}, end, sweep.from);
  scene.ours.checkRobotCollision({}, end, sweep.to);
  EXPECT_FALSE(end.collision);
  EXPECT_TRUE(sweep.check().collision);
  EXPECT_NEAR(sweep.share_of_contact(), (0.3 + 0.1 - 0.0005 - kRadius) / 0.6, 1e-6);
}

TEST_F(MoveItMotions, PassBesideWhatTheyMissByAMicrometre) {
  for (const double gap : {1e-6, -1e-6}) {
    scene.add("ball", ball_thing(0.05), Eigen::Vector3d(0.0, 0.0, kTip + kRadius + 0.05 + gap));
    const CollisionResult result = sweep.check(true);
    EXPECT_EQ(result.collision, gap < 0.0);
    EXPECT_NEAR(result.distance, std::max(gap, 0.0), 1.1e-6);
    scene.world->removeObject("ball");
  }
}

TEST_F(MoveItMotions, OfContinuousJointsTakeTheShorterArc) {
  const Motion motion(scene, {3.0, 1.0, 0.0}, {-3.0, 1.0, 0.0});
  const double reach = 0.5 * std::sin(1.0), height = 0.72 + 0.5 * std::cos(1.0);
  scene.add("ahead", ball_thing(0.02), Eigen::Vector3d(reach, 0.0, height));
  EXPECT_FALSE(motion.check().collision);
  scene.add("behind", ball_thing(0.02), Eigen::Vector3d(-reach, 0.0, height));
  EXPECT_TRUE(motion.check().collision);
}

// MoveIt has the follower at half of where the leader stands: from 1.5 to -1.5.
TEST(MoveItMimics, OfAJointThatTakesTheShorterArcCannotBeChecked) {
  ArmScene scene(robot_model(
      R"(<robot name="mimic"><link name="base"/><link name="a"/>
    <link name="b"><collision><origin xyz="0.5 0 0"/><geometry><sphere radius="0.05"/></geometry></collision></link>
    <joint name="lead" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
    <joint name="follow" type="revolute"><parent link="base"/><child link="b"/><axis xyz="0 0 1"/>
      <limit lower="-3.2" upper="3.2" velocity="1" effort="1"/><mimic joint="lead" multiplier="0.5"/></joint>
    </robot>)",
      R"(<robot name="mimic"><group name="all"><joint name="lead"/><joint name="follow"/></group></robot>)"));
  scene.add("ball", ball_thing(0.05),
            Eigen::Vector3d(0.5 * std::cos(-1.5), 0.5 * std::sin(-1.5), 0.0));
  const Motion wraps(scene, {3.0}, {-3.0}), arrives(scene, {-2.0}, {-3.0}),
      stays(scene, {2.0}, {3.0});
  CollisionResult end;
  scene.ours.checkRobotCollision({}, end, wraps.to);
  EXPECT_TRUE(end.collision);
  const auto collides = [&](const Motion& motion) {
    CollisionResult result;
    scene.ours.checkRobotCollision({}, result, motion.from, motion.to);
    return result.collision;
  };
  EXPECT_TRUE(collides(wraps));
  EXPECT_TRUE(collides(arrives));
  EXPECT_FALSE(collides(stays));
}

TEST_F(MoveItMotions, CarryAttachedBodies) {
  scene.add("sheet", box_thing({0.001, 0.5, 0.05}), Eigen::Vector3d(0.1, 0.0, kTip + 0.3));
  EXPECT_FALSE(sweep.check().collision);
  const Eigen::Isometry3d above(Eigen::Translation3d(0.0, 0.0, 0.3));
  for (RobotState* state : {&sweep.from, &sweep.to}) {
    state->attachBody(std::make_unique<moveit::core::AttachedBody>(
        scene.model->getLinkModel("tip"), "held", Eigen::Isometry3d::Identity(),
        std::vector<shapes::ShapeConstPtr>{std::make_shared<shapes::Box>(0.02, 0.02, 0.02)},
        EigenSTL::vector_Isometry3d{above}, std::set<std::string>{},
        trajectory_msgs::msg::JointTrajectory()));
    state->update();
  }
  EXPECT_TRUE(sweep.check().collision);
  EXPECT_NEAR(sweep.share_of_contact(), (0.3 + 0.1 - 0.0005 - 0.01) / 0.6, 1e-6);
  AllowedCollisionMatrix matrix;
  matrix.setEntry("held", "sheet", true);
  EXPECT_FALSE(sweep.check(false, matrix).collision);
}

TEST_F(MoveItMotions, MeetTheLeavesOfOctrees) {
  const auto tree = std::make_shared<octomap::OcTree>(0.01);
  tree->updateNode(octomap::point3d(0.105F, 0.005F, 0.005F), true);
  tree->updateNode(octomap::point3d(-0.105F, 0.005F, 0.005F), false);
  scene.world->addToObject("map", std::make_shared<shapes::OcTree>(tree),
                           Eigen::Isometry3d(Eigen::Translation3d(0.0, -0.005, kTip - 0.005)));
  EXPECT_TRUE(sweep.check().collision);
  EXPECT_NEAR(sweep.share_of_contact(), (0.3 + 0.1 - kRadius) / 0.6, 1e-6);
}

constexpr const char* kSlides = R"(<robot name="slides">
  <link name="base"/><link name="a"/>
  <link name="b"><collision><geometry><box size="0.043 0.043 0.043"/></geometry></collision></link>
  <link name="c"><collision><origin xyz="0 0.1 0"/><geometry><box size="0.043 0.043 0.043"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.1" velocity="1" effort="1"/></joint>
  <joint name="follow" type="prismatic"><parent link="a"/><child link="c"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.45" velocity="1" effort="1"/><mimic joint="slide" multiplier="4" offset="0.05"/></joint>
  </robot>)";

struct MoveItSlides : testing::Test {
  ArmScene scene{robot_model(kSlides, R"(<robot name="slides"><group name="all">
    <joint name="turn"/><joint name="slide"/><joint name="follow"/></group></robot>)")};

  // The motion of the robot among only the leaf of 1 cm that holds a point.
  bool collides(const Motion& motion, const Eigen::Vector3d& leaf) const {
    const auto tree = std::make_shared<octomap::OcTree>(0.01);
    tree->updateNode(leaf.x(), leaf.y(), leaf.z(), true);
    scene.world->removeObject("map");
    scene.world->addToObject("map", std::make_shared<shapes::OcTree>(tree),
                             Eigen::Isometry3d::Identity());
    CollisionResult result;
    scene.ours.checkRobotCollision({}, result, motion.from, motion.to);
    return result.collision;
  }
};

TEST_F(MoveItSlides, OfRobotsSmallerThanAMetreMeetTheLeavesBetweenTheirEnds) {
  const Motion motion(scene, {0.0, 0.0}, {0.0, 0.1});
  for (const double row : {0.0, 0.1}) {  // the leader moves from 0 to 0.1, its mimic from 0.05
    const double low = 0.5 * row, high = low + 0.1 + 3.0 * row;
    for (int x = -5; x < 55; ++x) {
      for (int y = -4; y < 4; ++y) {
        const Eigen::Vector3d leaf(0.01 * x + 0.005, 0.01 * y + 0.005 + row, 0.005);
        const bool meets = leaf.x() > low - 0.0265 && leaf.x() < high + 0.0265 &&
                           std::abs(leaf.y() - row) < 0.0265;
        ASSERT_EQ(collides(motion, leaf), meets) << leaf.transpose();
      }
    }
  }
}

TEST_F(MoveItSlides, ThatStandOutTurnFar) {
  const Motion motion(scene, {0.0, 0.1}, {0.6, 0.1});
  const auto turned = [](double angle) -> Eigen::Vector3d {
    return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d(0.45, 0.1, 0.0);
  };
  EXPECT_TRUE(collides(motion, turned(0.6)));
  EXPECT_FALSE(collides(motion, turned(0.8)));
}

TEST_F(MoveItMotions, CountAsCollisionsWhereTheyCannotBeChecked) {
  scene.world->addToObject("nothing", std::make_shared<shapes::Mesh>(0, 0),
                           Eigen::Isometry3d::Identity());
  const CollisionResult result = sweep.check(true);
  EXPECT_TRUE(result.collision);
  EXPECT_EQ(result.distance, 0.0);
}

TEST_F(MoveItMotions, WithoutNumbersAreCollisions) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto tree = std::make_shared<octomap::OcTree>(0.1);
  tree->updateNode(octomap::point3d(5.05F, 0.05F, 0.05F), true);
  scene.world->addToObject("map", std::make_shared<shapes::OcTree>(tree),
                           Eigen::Isometry3d::Identity());
  EXPECT_FALSE(sweep.check().collision);
  EXPECT_TRUE(Motion(scene, {0.0, nan, 0.0}, {0.0, 0.0, 0.0}).check().collision);
  EXPECT_TRUE(Motion(scene, {0.0, 0.0, 0.0}, {0.0, nan, 0.0}).check().collision);
  scene.world->setObjectPose("map", Eigen::Isometry3d(Eigen::Translation3d(nan, 0.0, 0.0)));
  EXPECT_TRUE(sweep.check().collision);
}

// Counts what this thread takes from the heap: to make a scene takes far more than to ask in it.
TEST_F(MoveItMotions, OfACopiedStateWithAnAttachedBodyAskInTheSameScene) {
  scene.add("ball", ball_thing(0.05), Eigen::Vector3d(0.0, 0.5, kTip));
  const auto held = std::make_shared<const shapes::Box>(0.02, 0.02, 0.02);
  const Eigen::Isometry3d above(Eigen::Translation3d(0.0, 0.0, 0.3));
  const auto attach = [&](const std::string& name) {
    for (RobotState* state : {&sweep.from, &sweep.to}) {
      state->clearAttachedBodies();
      state->attachBody(std::make_unique<moveit::core::AttachedBody>(
          scene.model->getLinkModel("tip"), name, Eigen::Isometry3d::Identity(),
          std::vector<shapes::ShapeConstPtr>{held}, EigenSTL::vector_Isometry3d{above},
          std::set<std::string>{}, trajectory_msgs::msg::JointTrajectory()));
      state->update();
    }
  };
  std::vector<RobotState> copies;  // they live on, so no address comes again
  copies.reserve(10);
  const auto allocations = [&] {
    RobotState& from = copies.emplace_back(sweep.from);
    RobotState& to = copies.emplace_back(sweep.to);
    from.update();
    to.update();
    const std::size_t before = taken_from_heap;
    CollisionResult result;
    scene.ours.checkRobotCollision({}, result, from, to);
    EXPECT_FALSE(result.collision);
    return taken_from_heap - before;
  };
  attach("held");
  const std::size_t first = allocations(), second = allocations();
  EXPECT_LT(second, first);
  EXPECT_EQ(allocations(), second);
  attach("other");
  EXPECT_GT(allocations(), second);
}

TEST_F(MoveItMotions, AreFreeOrInContactAsTheExactDistancesSay) {
  constexpr int kSamples = 100;
  Draw draw(11);
  int free = 0, met = 0;
  for (int i = 0; i < 60; ++i) {
    ArmScene random;
    draw.fill(random, 5);
    std::vector<double> begin, end;
    for (const double most : {1.5, 2.0, 0.3}) {
      begin.push_back(draw.between(-most, most));
      end.push_back(draw.between(-most, most));
    }
    const Motion motion(random, begin, end);
    const CollisionResult result = motion.check(true);
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= kSamples; ++k)
      least =
          std::min(least, random.exact_distance_at(motion.at(static_cast<double>(k) / kSamples)));
    EXPECT_LE(result.distance, std::max(0.0, least) + 1e-12);
    if (!result.collision) {
      EXPECT_GT(least, 0.0);
      EXPECT_GT(result.distance, least - 0.05);  // the samples are 5 cm apart, or less
      ++free;
      continue;
    }
    ASSERT_FALSE(result.contacts.empty());
    const double share = result.contacts.begin()->second.front().percent_interpolation;
    EXPECT_LE(random.exact_distance_at(motion.at(share)), 1e-9);
    for (int k = 0; k < kSamples * share - 1e-3; ++k)
      EXPECT_GT(random.exact_distance_at(motion.at(static_cast<double>(k) / kSamples)), 0.0);
    ++met;
  }
  EXPECT_GT(free, 10);
  EXPECT_GT(met, 10);
}

}  // namespace
