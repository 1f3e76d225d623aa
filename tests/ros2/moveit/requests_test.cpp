// What requests, matrices, attached bodies and changes of the world mean to the plug-in.
#include "arm_scene.hpp"
#include "shape_parts.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>
#include <moveit/collision_detection/collision_plugin.hpp>
#include <moveit/planning_scene/planning_scene.hpp>
#include <pluginlib/class_loader.hpp>

namespace {

using collision_detection::AllowedCollisionMatrix;
using collision_detection::CollisionRequest;
using collision_detection::CollisionResult;
namespace types = collision_detection::DistanceRequestTypes;

bool collides(const ArmScene& scene, const AllowedCollisionMatrix& matrix = {},
              const std::string& group = "") {
  CollisionRequest request;
  request.group_name = group;
  CollisionResult result;
  scene.ours.checkRobotCollision(request, result, scene.state, matrix);
  return result.collision;
}
bool collides_itself(const ArmScene& scene, const AllowedCollisionMatrix& matrix = {}) {
  CollisionResult result;
  scene.ours.checkSelfCollision({}, result, scene.state, matrix);
  return result.collision;
}
double distance(const ArmScene& scene) {
  collision_detection::DistanceRequest request;
  request.enable_signed_distance = true;
  collision_detection::DistanceResult result;
  scene.ours.distanceRobot(request, result, scene.state);
  return result.minimum_distance.distance;
}

// The arm stands: the ball is at a height of 1.22 m, and its radius is 0.06 m.
constexpr double kTip = 1.22, kRadius = 0.06;

struct MoveItMatrix : testing::Test {
  ArmScene scene;
  AllowedCollisionMatrix matrix;
  MoveItMatrix() {
    scene.add("thing", box_thing({0.1, 0.1, 0.1}), Eigen::Vector3d(0.0, 0.0, kTip));
  }
};

TEST_F(MoveItMatrix, LeavesOutPairsThatMayAlwaysTouch) {
  EXPECT_TRUE(collides(scene));
  matrix.setEntry("thing", "tip", false);
  EXPECT_TRUE(collides(scene, matrix));
  matrix.setEntry("thing", "tip", true);
  EXPECT_FALSE(collides(scene, matrix));
  matrix = {};
  matrix.setDefaultEntry("thing", true);
  EXPECT_FALSE(collides(scene, matrix));
}

TEST_F(MoveItMatrix, AsksAFunctionAboutEachContact) {
  double deepest = 0.0;
  bool allow = true;
  collision_detection::DecideContactFn decide = [&](collision_detection::Contact& contact) {
    deepest = contact.depth;
    return allow;
  };
  matrix.setEntry("thing", "tip", decide);
  EXPECT_FALSE(collides(scene, matrix));
  EXPECT_NEAR(deepest, 0.05 + kRadius, 1e-12);
  allow = false;
  EXPECT_TRUE(collides(scene, matrix));
}

TEST_F(MoveItMatrix, CountsInDistancesToo) {
  collision_detection::DistanceRequest request;
  collision_detection::DistanceResult result;
  matrix.setEntry("thing", "tip", true);
  request.acm = &matrix;
  scene.ours.distanceRobot(request, result, scene.state);
  EXPECT_NEAR(result.minimum_distance.distance, kTip - 0.05 - 1.12, 1e-12);
  EXPECT_EQ(result.minimum_distance.link_names[0], "upper");
}

TEST(MoveItGroups, LeaveOutLinksThatTheyDoNotMove) {
  ArmScene scene;
  scene.add("thing", box_thing({0.1, 0.1, 0.1}),
            Eigen::Vector3d(0.0, 0.0, 0.4));  // in the lower link
  EXPECT_TRUE(collides(scene, {}, "all"));
  EXPECT_FALSE(collides(scene, {}, "wrist"));
  scene.add("other", box_thing({0.1, 0.1, 0.1}), Eigen::Vector3d(0.0, 0.0, kTip));
  EXPECT_TRUE(collides(scene, {}, "wrist"));
}

TEST(MoveItContacts, AreAtMostAsManyAsAskedFor) {
  ArmScene scene;
  for (int i = 0; i < 5; ++i)
    scene.add("thing" + std::to_string(i), ball_thing(0.05), Eigen::Vector3d(0.0, 0.01 * i, kTip));
  CollisionRequest request;
  request.contacts = true;
  for (const std::size_t most : {1u, 3u, 100u}) {
    request.max_contacts = most;
    CollisionResult result;
    scene.ours.checkRobotCollision(request, result, scene.state);
    EXPECT_EQ(result.contact_count, std::min<std::size_t>(most, 5));
    EXPECT_EQ(result.contacts.size(), result.contact_count);
  }
  int calls = 0;
  request.is_done = [&](const CollisionResult& so_far) {
    return ++calls == 2 && so_far.contact_count == 2;
  };
  CollisionResult result;
  scene.ours.checkRobotCollision(request, result, scene.state);
  EXPECT_EQ(result.contact_count, 2u);
}

TEST(MoveItContacts, OfOnePairAreAtMostAsManyAsAskedFor) {
  ArmScene scene;
  const auto ball = std::make_shared<shapes::Sphere>(0.02);
  for (int i = 0; i < 4; ++i) {
    scene.world->addToObject("balls", ball,
                             Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.01 * i, kTip)));
  }
  CollisionRequest request;
  request.contacts = true;
  request.max_contacts = 100;
  for (const std::size_t most : {1u, 3u, 100u}) {
    request.max_contacts_per_pair = most;
    CollisionResult result;
    scene.ours.checkRobotCollision(request, result, scene.state);
    EXPECT_EQ(result.contacts.size(), 1u);
    EXPECT_EQ(result.contact_count, std::min<std::size_t>(most, 4));
  }
}

TEST(MoveItDistanceTypes, KeepTheLeastOrSomeOrAllOfAPair) {
  ArmScene scene;
  const auto ball = std::make_shared<shapes::Sphere>(0.02);
  for (int i = 4; i > 0; --i) {
    scene.world->addToObject("balls", ball,
                             Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.2 * i, kTip)));
  }
  const auto found = [&](types::DistanceRequestType type, double threshold = 10.0) {
    collision_detection::DistanceRequest request;
    request.type = type;
    request.max_contacts_per_body = 3;
    request.distance_threshold = threshold;
    collision_detection::DistanceResult result;
    scene.ours.distanceRobot(request, result, scene.state);
    EXPECT_NEAR(result.minimum_distance.distance, 0.2 - 0.02 - kRadius, 1e-12);
    std::vector<double> distances;
    for (const auto& of : result.distances[{"balls", "tip"}]) distances.push_back(of.distance);
    return distances;
  };
  EXPECT_EQ(found(types::GLOBAL).size(), 0u);
  ASSERT_EQ(found(types::SINGLE).size(), 1u);
  EXPECT_NEAR(found(types::SINGLE).front(), 0.2 - 0.02 - kRadius, 1e-12);
  EXPECT_EQ(found(types::LIMITED).size(), 3u);
  EXPECT_EQ(found(types::ALL).size(), 4u);
  EXPECT_EQ(found(types::ALL, 0.5).size(), 2u);
}

TEST(MoveItDistances, ComeWithAVerdictWhereARequestAsksForThem) {
  ArmScene scene;
  scene.add("thing", ball_thing(0.05), Eigen::Vector3d(0.0, 0.0, kTip + 0.31));
  CollisionRequest request;
  request.distance = request.detailed_distance = true;
  CollisionResult result;
  AllowedCollisionMatrix matrix;
  for (const auto* name : {"base", "lower", "upper"}) matrix.setEntry(name, "tip", true);
  matrix.setEntry("base", "lower", true);
  matrix.setEntry("upper", "lower", true);
  scene.ours.checkCollision(request, result, scene.state, matrix);
  EXPECT_FALSE(result.collision);
  EXPECT_NEAR(result.distance, 0.2, 1e-12);
  EXPECT_EQ(result.distance_result.minimum_distance.link_names[1], "thing");
}

TEST(MoveItPadding, IsThatOfTheShapesOfMoveIt) {
  ArmScene scene;
  scene.add("thing", ball_thing(0.05), Eigen::Vector3d(0.0, 0.0, kTip + 0.31));
  EXPECT_NEAR(distance(scene), 0.2, 1e-12);
  scene.ours.setLinkPadding("tip", 0.03);
  EXPECT_NEAR(distance(scene), 0.17, 1e-12);
  scene.ours.setLinkScale("tip", 2.0);
  EXPECT_NEAR(distance(scene), 0.11, 1e-12);
  scene.ours.setPadding(0.0);
  scene.ours.setScale(1.0);
  EXPECT_NEAR(distance(scene), 0.2, 1e-12);
  const clearance_moveit::CollisionEnv padded(scene.model, scene.world, 0.05);
  collision_detection::DistanceResult result;
  padded.distanceRobot({}, result, scene.state);
  EXPECT_NEAR(result.minimum_distance.distance, 0.15, 1e-12);
}

struct MoveItAttached : testing::Test {
  ArmScene scene;
  AllowedCollisionMatrix links;
  const Eigen::Isometry3d above{Eigen::Translation3d(0.0, 0.0, 0.1)};

  MoveItAttached() {
    const auto& names = scene.model->getLinkModelNames();
    for (const auto& a : names)
      for (const auto& b : names) links.setEntry(a, b, true);
  }
  void attach(const std::string& name, const std::string& link, const std::set<std::string>& touch,
              const Eigen::Isometry3d& at) {
    scene.state.attachBody(std::make_unique<moveit::core::AttachedBody>(
        scene.model->getLinkModel(link), name, Eigen::Isometry3d::Identity(),
        std::vector<shapes::ShapeConstPtr>{std::make_shared<shapes::Box>(0.1, 0.1, 0.1)},
        EigenSTL::vector_Isometry3d{at}, touch, trajectory_msgs::msg::JointTrajectory()));
    scene.state.update();
  }
};

TEST_F(MoveItAttached, MoveWithTheirLinkAndCountAgainstTheWorld) {
  scene.add("thing", ball_thing(0.05), Eigen::Vector3d(0.2, 0.0, kTip + 0.31));
  attach("held", "tip", {"tip"}, above);
  EXPECT_NEAR(distance(scene), std::hypot(0.15, 0.16) - 0.05, 1e-12);
  scene.set(0.0, 0.0, 0.2);
  EXPECT_NEAR(distance(scene), 0.16 - 0.05, 1e-12);
}

TEST_F(MoveItAttached, MayTouchTheLinksThatTheyName) {
  attach("held", "tip", {}, above);
  EXPECT_TRUE(collides_itself(scene, links));
  attach("held", "tip", {"tip"}, above);
  EXPECT_FALSE(collides_itself(scene, links));
}

TEST_F(MoveItAttached, OfOneLinkMayTouchAndOthersOnlyByName) {
  attach("first", "tip", {"tip"}, above);
  attach("second", "tip", {"tip"}, above);
  EXPECT_FALSE(collides_itself(scene, links));
  const Eigen::Isometry3d same(Eigen::Translation3d(0.0, 0.0, 0.6));
  attach("second", "upper", {"tip", "upper"}, same);
  EXPECT_TRUE(collides_itself(scene, links));
  attach("second", "upper", {"tip", "upper", "first"}, same);
  EXPECT_FALSE(collides_itself(scene, links));
}

TEST_F(MoveItAttached, ArePaddedLikeTheirLink) {
  scene.add("thing", ball_thing(0.05), Eigen::Vector3d(0.0, 0.0, kTip + 0.4));
  attach("held", "tip", {"tip"}, above);
  EXPECT_NEAR(distance(scene), 0.2, 1e-12);
  scene.ours.setLinkPadding("tip", 0.02);
  EXPECT_NEAR(distance(scene), 0.18, 1e-12);
}

TEST(MoveItWorld, ChangesAreSeenAtOnce) {
  ArmScene scene;
  const auto thing = box_thing({0.1, 0.1, 0.1});
  EXPECT_FALSE(collides(scene));
  scene.add("thing", thing, Eigen::Vector3d(0.5, 0.0, kTip));
  EXPECT_NEAR(distance(scene), 0.5 - 0.05 - kRadius, 1e-12);
  scene.world->moveObject("thing", Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.0, 0.0)));
  EXPECT_NEAR(distance(scene), 0.6 - 0.05 - kRadius, 1e-12);
  scene.world->addToObject("thing", thing.shape,
                           Eigen::Isometry3d(Eigen::Translation3d(-0.4, 0.0, 0.0)));
  EXPECT_NEAR(distance(scene), 0.2 - 0.05 - kRadius, 1e-12);
  const clearance_moveit::CollisionEnv copy(
      scene.ours, std::make_shared<collision_detection::World>(*scene.world));
  scene.world->removeObject("thing");
  EXPECT_EQ(distance(scene), std::numeric_limits<double>::max());
  collision_detection::DistanceResult result;
  copy.distanceRobot({}, result, scene.state);
  EXPECT_NEAR(result.minimum_distance.distance, 0.2 - 0.05 - kRadius, 1e-12);
  const auto other = std::make_shared<collision_detection::World>();
  other->addToObject("other", thing.shape, Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.3, kTip)));
  scene.ours.setWorld(other);
  EXPECT_NEAR(distance(scene), 0.3 - 0.05 - kRadius, 1e-12);
}

TEST(MoveItShapes, ConesCylindersAndPlanesAreExact) {
  ArmScene scene;
  const std::set<const moveit::core::LinkModel*> tip = {scene.model->getLinkModel("tip")};
  const auto alone = [&](const shapes::Shape* shape, const Eigen::Vector3d& at) {
    scene.world->removeObject("thing");
    scene.world->addToObject("thing", shapes::ShapeConstPtr(shape),
                             Eigen::Isometry3d(Eigen::Translation3d(at)));
    collision_detection::DistanceRequest request;
    request.enable_signed_distance = true;
    request.active_components_only = &tip;
    collision_detection::DistanceResult result;
    scene.ours.distanceRobot(request, result, scene.state);
    return result.minimum_distance.distance;
  };
  EXPECT_NEAR(alone(new shapes::Cylinder(0.1, 0.2), {0.4, 0.0, kTip}), 0.3 - kRadius, 1e-12);
  // The side of the cone rises by 0.2 m in 0.1 m.
  EXPECT_NEAR(alone(new shapes::Cone(0.1, 0.2), {0.4, 0.0, kTip - 0.1}),
              0.8 / std::sqrt(5.0) - kRadius, 1e-12);
  EXPECT_NEAR(alone(new shapes::Plane(0.0, 0.0, 1.0, 0.4), {0.0, 0.0, 0.0}), kTip + 0.4 - kRadius,
              1e-12);
  EXPECT_NEAR(alone(new shapes::Plane(0.0, 0.0, 1.0, -1.3), {0.0, 0.0, 0.0}), kTip - 1.3 - kRadius,
              1e-12);
}

TEST(MoveItShapes, OctreesAreTheirOccupiedLeavesAsTheyAreNow) {
  ArmScene scene;
  const auto tree = std::make_shared<octomap::OcTree>(0.1);
  tree->updateNode(octomap::point3d(0.55F, 0.05F, 0.05F), true);
  tree->updateNode(octomap::point3d(0.25F, 0.05F, 0.05F), false);
  scene.world->addToObject("map", std::make_shared<shapes::OcTree>(tree),
                           Eigen::Isometry3d(Eigen::Translation3d(0.0, -0.05, kTip - 0.05)));
  EXPECT_NEAR(distance(scene), 0.5 - kRadius, 1e-12);
  tree->updateNode(octomap::point3d(0.35F, 0.05F, 0.05F), true);
  EXPECT_NEAR(distance(scene), 0.3 - kRadius, 1e-12);
  EXPECT_FALSE(collides(scene));
  tree->updateNode(octomap::point3d(0.05F, 0.05F, 0.05F), true);
  EXPECT_TRUE(collides(scene));
}

TEST(MoveItStates, WithoutNumbersCollide) {
  ArmScene scene;
  scene.add("thing", box_thing({0.1, 0.1, 0.1}), Eigen::Vector3d(5.0, 0.0, 0.0));
  EXPECT_FALSE(collides(scene));
  scene.set(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  EXPECT_TRUE(collides(scene));
  EXPECT_TRUE(collides_itself(scene));
  EXPECT_LE(distance(scene), 0.0);
}

TEST(MoveItStates, CollideWithObjectsWithoutAPose) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto tree = std::make_shared<octomap::OcTree>(0.1);
  tree->updateNode(octomap::point3d(5.05F, 0.05F, 0.05F), true);
  const std::vector<shapes::ShapeConstPtr> all = {
      std::make_shared<shapes::Box>(0.1, 0.1, 0.1), std::make_shared<shapes::Sphere>(0.1),
      std::make_shared<shapes::Plane>(0.0, 0.0, 1.0, 5.0), std::make_shared<shapes::OcTree>(tree),
      std::make_shared<shapes::Sphere>(nan)};
  for (const auto& shape : all) {
    for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
      for (const bool turned : {false, true}) {
        ArmScene scene;
        Eigen::Isometry3d place(Eigen::Translation3d(5.0, 0.0, 0.0));
        (turned ? place.matrix()(1, 2) : place.matrix()(1, 3)) = bad;
        scene.world->addToObject("thing", shape, place);
        EXPECT_TRUE(collides(scene)) << shape->type << " " << bad << " " << turned;
        EXPECT_LE(distance(scene), 0.0) << shape->type << " " << bad << " " << turned;
      }
    }
  }
}

TEST(MoveItShapes, ThatAreGoneDoNotKeepTheirOctrees) {
  const ArmScene scene;
  const auto world = std::make_shared<collision_detection::World>();  // FCL keeps the trees of its
  const clearance_moveit::CollisionEnv ours(scene.model, world);
  auto tree = std::make_shared<octomap::OcTree>(0.1);
  tree->updateNode(octomap::point3d(5.05F, 0.05F, 0.05F), true);
  world->addToObject("map", std::make_shared<shapes::OcTree>(tree), Eigen::Isometry3d::Identity());
  CollisionResult result;
  ours.checkRobotCollision({}, result, scene.state);
  EXPECT_FALSE(result.collision);
  world->removeObject("map");
  const std::weak_ptr<octomap::OcTree> seen = tree;
  tree.reset();
  EXPECT_TRUE(seen.expired());
}

TEST(MoveItShapes, MeshesOfOneContentAreSplitOnce) {
  const auto first = clearance_moveit::parts_of(wedge_thing({0.1, 0.2, 0.3}).shape);
  EXPECT_EQ(first, clearance_moveit::parts_of(wedge_thing({0.1, 0.2, 0.3}).shape));
  EXPECT_NE(first, clearance_moveit::parts_of(wedge_thing({0.1, 0.2, 0.31}).shape));
}

TEST(MoveItShapes, WithoutABodyCollideWithEverything) {
  ArmScene scene;
  const auto nothing = std::make_shared<shapes::Mesh>(0, 0);
  scene.world->addToObject("thing", nothing,
                           Eigen::Isometry3d(Eigen::Translation3d(9.0, 0.0, 0.0)));
  EXPECT_TRUE(collides(scene));
}

TEST(MoveItPlugin, IsLoadedByItsNameAndChecksAPlanningScene) {
  pluginlib::ClassLoader<collision_detection::CollisionPlugin> loader(
      "moveit_core", "collision_detection::CollisionPlugin");
  const auto plugin = loader.createSharedInstance("Clearance");
  const auto scene = std::make_shared<planning_scene::PlanningScene>(arm_model());
  ASSERT_TRUE(plugin->initialize(scene));
  EXPECT_EQ(scene->getCollisionDetectorName(), "Clearance");
  const auto diff = scene->diff();
  diff->getWorldNonConst()->addToObject("thing", std::make_shared<shapes::Sphere>(0.1),
                                        Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, kTip)));
  CollisionRequest request;
  request.contacts = true;
  CollisionResult with, without;
  diff->getAllowedCollisionMatrixNonConst().setEntry(true);
  diff->getAllowedCollisionMatrixNonConst().setEntry("thing", "tip", false);
  diff->checkCollision(request, with);
  EXPECT_TRUE(with.collision);
  EXPECT_EQ(with.contacts.size(), 1u);
  diff->getWorldNonConst()->removeObject("thing");
  diff->checkCollision(request, without);
  EXPECT_FALSE(without.collision);
}

}  // namespace
