// The plug-in that MoveIt loads where the parameter collision_detector is "Clearance".
#include "clearance_moveit/collision_env.hpp"

#include <moveit/collision_detection/collision_plugin.hpp>
#include <pluginlib/class_list_macros.hpp>

namespace clearance_moveit {

class CollisionPlugin : public collision_detection::CollisionPlugin {
 public:
  bool initialize(const planning_scene::PlanningScenePtr& scene) const override {
    scene->allocateCollisionDetector(CollisionDetectorAllocator::create());
    return true;
  }
};

}  // namespace clearance_moveit

PLUGINLIB_EXPORT_CLASS(clearance_moveit::CollisionPlugin, collision_detection::CollisionPlugin)
