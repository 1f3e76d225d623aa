// MoveIt's own suites for collision detectors, which it runs for FCL and Bullet.
#include <clearance_moveit/collision_env.hpp>
#include <moveit/collision_detection/test_collision_common_panda.hpp>
#include <moveit/collision_detection/test_collision_common_pr2.hpp>

using clearance_moveit::CollisionDetectorAllocator;

INSTANTIATE_TYPED_TEST_SUITE_P(MoveItSuite, CollisionDetectorPandaTest, CollisionDetectorAllocator);
INSTANTIATE_TYPED_TEST_SUITE_P(MoveItSuite, DistanceCheckPandaTest, CollisionDetectorAllocator);
INSTANTIATE_TYPED_TEST_SUITE_P(MoveItSuite, DistanceFullPandaTest, CollisionDetectorAllocator);
INSTANTIATE_TYPED_TEST_SUITE_P(MoveItSuite, CollisionDetectorTest, CollisionDetectorAllocator);
