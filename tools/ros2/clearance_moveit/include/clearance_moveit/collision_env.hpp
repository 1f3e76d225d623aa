// Collision checks and certified distances of MoveIt's scenes by the core of Clearance.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <moveit/collision_detection/collision_detector_allocator.hpp>
#include <moveit/collision_detection/collision_env.hpp>

namespace clearance_moveit {

struct PosedParts;
struct ShapeParts;

// Distances are certified lower bounds, and bodies that are not certified disjoint collide. README
// names the bodies. Several threads may call the const functions at once.
class CollisionEnv : public collision_detection::CollisionEnv {
 public:
  explicit CollisionEnv(const moveit::core::RobotModelConstPtr& model, double padding = 0.0,
                        double scale = 1.0);
  CollisionEnv(const moveit::core::RobotModelConstPtr& model,
               const collision_detection::WorldPtr& world, double padding = 0.0,
               double scale = 1.0);
  CollisionEnv(const CollisionEnv& other, const collision_detection::WorldPtr& world);
  CollisionEnv(const CollisionEnv&) = delete;
  CollisionEnv& operator=(const CollisionEnv&) = delete;
  ~CollisionEnv() override;

  void checkSelfCollision(const collision_detection::CollisionRequest& request,
                          collision_detection::CollisionResult& result,
                          const moveit::core::RobotState& state) const override;
  void checkSelfCollision(const collision_detection::CollisionRequest& request,
                          collision_detection::CollisionResult& result,
                          const moveit::core::RobotState& state,
                          const collision_detection::AllowedCollisionMatrix& matrix) const override;
  void checkRobotCollision(const collision_detection::CollisionRequest& request,
                           collision_detection::CollisionResult& result,
                           const moveit::core::RobotState& state) const override;
  void checkRobotCollision(
      const collision_detection::CollisionRequest& request,
      collision_detection::CollisionResult& result, const moveit::core::RobotState& state,
      const collision_detection::AllowedCollisionMatrix& matrix) const override;
  // The whole motion from one state to the other, on which every joint moves linearly in time.
  void checkRobotCollision(const collision_detection::CollisionRequest& request,
                           collision_detection::CollisionResult& result,
                           const moveit::core::RobotState& from,
                           const moveit::core::RobotState& to) const override;
  void checkRobotCollision(
      const collision_detection::CollisionRequest& request,
      collision_detection::CollisionResult& result, const moveit::core::RobotState& from,
      const moveit::core::RobotState& to,
      const collision_detection::AllowedCollisionMatrix& matrix) const override;
  void distanceSelf(const collision_detection::DistanceRequest& request,
                    collision_detection::DistanceResult& result,
                    const moveit::core::RobotState& state) const override;
  void distanceRobot(const collision_detection::DistanceRequest& request,
                     collision_detection::DistanceResult& result,
                     const moveit::core::RobotState& state) const override;
  void setWorld(const collision_detection::WorldPtr& world) override;

 protected:
  void updatedPaddingOrScaling(const std::vector<std::string>& links) override;

 private:
  using Matrix = collision_detection::AllowedCollisionMatrix;

  void observe(bool tell_all);
  void change(const ObjectConstPtr& object, collision_detection::World::Action action);
  void make_link(const moveit::core::LinkModel& link);
  [[nodiscard]] PosedParts robot_at(const moveit::core::RobotState& state,
                                    bool in_links = false) const;
  void check_self(const collision_detection::CollisionRequest& request,
                  collision_detection::CollisionResult& result,
                  const moveit::core::RobotState& state, const Matrix* matrix) const;
  void check_robot(const collision_detection::CollisionRequest& request,
                   collision_detection::CollisionResult& result,
                   const moveit::core::RobotState& state, const Matrix* matrix) const;
  void check_motion(const collision_detection::CollisionRequest& request,
                    collision_detection::CollisionResult& result,
                    const moveit::core::RobotState& from, const moveit::core::RobotState& to,
                    const Matrix* matrix) const;

  // By the index of a link's collision body in a robot state.
  std::vector<std::shared_ptr<const ShapeParts>> link_shapes_;
  std::unique_ptr<PosedParts> world_parts_;
  collision_detection::World::ObserverHandle observer_;
};

class CollisionDetectorAllocator
    : public collision_detection::CollisionDetectorAllocatorTemplate<CollisionEnv,
                                                                     CollisionDetectorAllocator> {
 public:
  static const std::string NAME;
};

}  // namespace clearance_moveit
