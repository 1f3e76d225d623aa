// Verdicts, distances and contacts of the plug-in, against exact_bodies.hpp.
#include "arm_scene.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

namespace {

using collision_detection::BodyTypes::ROBOT_LINK;
namespace types = collision_detection::DistanceRequestTypes;

constexpr int kScenes = 40, kStates = 10, kThings = 6;

// Calls use(scene) for many random states.
template <class Use>
void in_random_scenes(unsigned seed, const Use& use) {
  Draw draw(seed);
  for (int s = 0; s < kScenes; ++s) {
    ArmScene scene;
    draw.fill(scene, kThings);
    for (int i = 0; i < kStates; ++i) {
      draw.pose(scene);
      use(scene);
    }
  }
}

TEST(MoveItDistances, AreExactInRandomScenesAndNeverAboveTheTruth) {
  int colliding = 0, apart = 0;
  in_random_scenes(1, [&](ArmScene& scene) {
    collision_detection::DistanceRequest request;
    request.enable_signed_distance = true;
    collision_detection::DistanceResult result;
    scene.ours.distanceRobot(request, result, scene.state);
    const double truth = scene.exact_distance_at(scene.state);
    EXPECT_NEAR(result.minimum_distance.distance, truth, 1e-9);
    EXPECT_LE(result.minimum_distance.distance, truth + (truth > 0.0 ? 1e-15 : 1e-9));
    EXPECT_EQ(result.collision, truth <= 0.0);
    ++(truth > 0.0 ? apart : colliding);
  });
  EXPECT_GT(colliding, 50);
  EXPECT_GT(apart, 50);
}

TEST(MoveItDistances, OfEachPairAreExact) {
  in_random_scenes(2, [&](ArmScene& scene) {
    collision_detection::DistanceRequest request;
    request.enable_signed_distance = true;
    request.type = types::SINGLE;
    collision_detection::DistanceResult result;
    scene.ours.distanceRobot(request, result, scene.state);
    ASSERT_EQ(result.distances.size(), 4u * kThings);
    for (const auto& [pair, found] : result.distances) {
      ASSERT_EQ(found.size(), 1u);
      const bool link_first = found.front().body_types[0] == ROBOT_LINK;
      EXPECT_NEAR(found.front().distance,
                  scene.exact_distance(found.front().link_names[link_first ? 0 : 1],
                                       found.front().link_names[link_first ? 1 : 0]),
                  1e-9);
    }
  });
}

TEST(MoveItDistances, OfTheLinksOfTheRobotToEachOtherAreExact) {
  Draw draw(3);
  ArmScene scene;
  for (int i = 0; i < 200; ++i) {
    draw.pose(scene);
    collision_detection::DistanceRequest request;
    request.enable_signed_distance = true;
    request.type = types::SINGLE;
    collision_detection::DistanceResult result;
    scene.ours.distanceSelf(request, result, scene.state);
    ASSERT_EQ(result.distances.size(), 6u);
    for (const auto& [pair, found] : result.distances) {
      double truth = std::numeric_limits<double>::infinity();
      for (const exact::Body& body : scene.link(pair.second, scene.state))
        truth = std::min(truth, scene.exact_distance(pair.first, body, scene.state));
      EXPECT_NEAR(found.front().distance, truth, 1e-9) << pair.first << " " << pair.second;
    }
  }
}

TEST(MoveItDistances, JoinTwoPointsOfTheBodiesAlongTheNormal) {
  in_random_scenes(4, [&](ArmScene& scene) {
    collision_detection::DistanceRequest request;
    request.enable_nearest_points = true;
    collision_detection::DistanceResult result;
    scene.ours.distanceRobot(request, result, scene.state);
    if (result.collision) return;
    const auto& least = result.minimum_distance;
    EXPECT_EQ(least.body_types[0], ROBOT_LINK);
    EXPECT_NEAR(
        (least.nearest_points[1] - least.nearest_points[0] - least.distance * least.normal).norm(),
        0.0, 1e-7);
    const auto at = [](const Eigen::Vector3d& p) {
      return exact::Body{{p.cast<exact::Real>()}, {}, 0};
    };
    EXPECT_LE(scene.exact_distance(least.link_names[0], at(least.nearest_points[0]), scene.state),
              1e-12);
    EXPECT_LE(exact::distance(at(least.nearest_points[1]), scene.things.at(least.link_names[1])),
              1e-12);
  });
}

constexpr double kTip = 1.22, kRadius = 0.06;

TEST(MoveItDistanceTypes, WithAtMostNoDistanceOfAPairStillKnowTheLeast) {
  ArmScene scene;
  const auto ball = std::make_shared<shapes::Sphere>(0.02);
  for (int i = 2; i > 0; --i) {
    scene.world->addToObject("balls", ball,
                             Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.2 * i, kTip)));
  }
  collision_detection::DistanceRequest request;
  request.type = types::LIMITED;
  request.max_contacts_per_body = 0;
  collision_detection::DistanceResult result;
  result.distances[{"balls", "tip"}].clear();  // an empty list, as an earlier request leaves it
  scene.ours.distanceRobot(request, result, scene.state);
  EXPECT_NEAR(result.minimum_distance.distance, 0.2 - 0.02 - kRadius, 1e-12);
}

TEST(MoveItDistanceTypes, OfOverlapsHaveTheDeepestLeafInWhateverOrder) {
  for (const auto type : {types::GLOBAL, types::SINGLE, types::LIMITED, types::ALL}) {
    ArmScene scene;
    scene.add("box", box_thing({0.1, 0.1, 0.1}),
              Eigen::Vector3d(0.0, 0.05 + kRadius - 0.005, kTip));
    const auto tree = std::make_shared<octomap::OcTree>(0.1);
    tree->updateNode(octomap::point3d(0.05F, 0.05F, 0.05F), true);
    const auto map = std::make_shared<shapes::OcTree>(tree);
    for (const double depth : {0.01, 0.02}) {
      scene.world->addToObject(
          "map", map,
          Eigen::Isometry3d(Eigen::Translation3d(-0.05, -0.1 - kRadius + depth, kTip - 0.05)));
    }
    collision_detection::DistanceRequest request;
    request.type = type;
    request.max_contacts_per_body = 1;
    request.enable_signed_distance = true;
    collision_detection::DistanceResult result;
    scene.ours.distanceRobot(request, result, scene.state);
    EXPECT_NEAR(result.minimum_distance.distance, -0.02, 1e-12) << type;
  }
}

TEST(MoveItVerdicts, AreExactInRandomScenesAndDifferFromFclInFewOfThem) {
  int different_from_fcl = 0;
  in_random_scenes(5, [&](ArmScene& scene) {
    const double truth = scene.exact_distance_at(scene.state);
    collision_detection::CollisionRequest request;
    collision_detection::CollisionResult ours, fcl;
    scene.ours.checkRobotCollision(request, ours, scene.state);
    scene.fcl.checkRobotCollision(request, fcl, scene.state);
    EXPECT_EQ(ours.collision, truth <= 0.0) << truth;
    // A mesh of FCL's is a surface: a body inside of one is free.
    if (ours.collision != fcl.collision) ++different_from_fcl;
  });
  EXPECT_LE(different_from_fcl, 4);
}

TEST(MoveItVerdicts, DecideAGapOfANanometre) {
  ArmScene scene;
  for (const double gap : {1e-9, -1e-9}) {
    scene.add("near", ball_thing(0.05), Eigen::Vector3d(0.15 + 0.05 + gap, 0.0, 0.0));
    collision_detection::CollisionResult result;
    scene.ours.checkRobotCollision({}, result, scene.state);
    EXPECT_EQ(result.collision, gap < 0.0);
    scene.world->removeObject("near");
  }
}

TEST(MoveItContacts, MoveBodiesApartByTheirDepthAlongTheirNormal) {
  int contacts = 0;
  in_random_scenes(6, [&](ArmScene& scene) {
    collision_detection::CollisionRequest request;
    request.contacts = true;
    request.max_contacts = 100;
    collision_detection::CollisionResult result;
    scene.ours.checkRobotCollision(request, result, scene.state);
    std::size_t exact_pairs = 0;
    for (const std::string& link : scene.model->getLinkModelNames()) {
      for (const auto& thing : scene.things)
        exact_pairs += scene.exact_distance(link, thing.first) < 0.0;
    }
    EXPECT_EQ(result.contacts.size(), exact_pairs);
    EXPECT_EQ(result.contact_count, exact_pairs);
    for (const auto& [pair, found] : result.contacts) {
      const collision_detection::Contact& contact = found.front();
      if (contact.body_name_1 == "upper") continue;  // of two bodies
      EXPECT_NEAR(contact.depth, -scene.exact_distance(contact.body_name_1, contact.body_name_2),
                  1e-9);
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
      const exact::Body moved =
          exact::shifted(scene.things.at(contact.body_name_2),
                         (contact.depth * contact.normal).cast<exact::Real>());
      EXPECT_NEAR(scene.exact_distance(contact.body_name_1, moved, scene.state), 0.0, 1e-9);
      ++contacts;
    }
  });
  EXPECT_GT(contacts, 50);
}

}  // namespace
