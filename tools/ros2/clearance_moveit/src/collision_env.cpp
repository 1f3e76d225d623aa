#include "clearance_moveit/collision_env.hpp"

#include "collision_check.hpp"
#include "distance_check.hpp"
#include "motion_check.hpp"
#include "moveit_log.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <variant>

namespace clearance_moveit {

using collision_detection::World;
using moveit::core::RobotState;

const std::string CollisionDetectorAllocator::NAME("Clearance");

namespace {

// The distance that a collision request asks for beside its verdict.
template <class Measure>
void add_distance(const collision_detection::CollisionRequest& request,
                  collision_detection::CollisionResult& result,
                  const collision_detection::AllowedCollisionMatrix* matrix,
                  const moveit::core::RobotModelConstPtr& model, const Measure& measure) {
  if (!request.distance) return;
  collision_detection::DistanceRequest asked;
  asked.group_name = request.group_name;
  asked.acm = matrix;
  asked.enableGroup(model);
  collision_detection::DistanceResult found;
  measure(asked, found);
  result.distance = std::min(result.distance, found.minimum_distance.distance);
  if (request.detailed_distance) result.distance_result = found;
}

void refuse_cost(const collision_detection::CollisionRequest& request) {
  if (request.cost) RCLCPP_WARN_ONCE(logger(), "Clearance has no cost sources: none are returned");
}

}  // namespace

CollisionEnv::CollisionEnv(const moveit::core::RobotModelConstPtr& model, double padding,
                           double scale)
    : CollisionEnv(model, std::make_shared<World>(), padding, scale) {}

CollisionEnv::CollisionEnv(const moveit::core::RobotModelConstPtr& model,
                           const collision_detection::WorldPtr& world, double padding, double scale)
    : collision_detection::CollisionEnv(model, world, padding, scale),
      link_shapes_(model->getLinkGeometryCount()),
      world_parts_(std::make_unique<PosedParts>()) {
  for (const auto* link : model->getLinkModelsWithCollisionGeometry()) make_link(*link);
  observe(true);
}

CollisionEnv::CollisionEnv(const CollisionEnv& other, const collision_detection::WorldPtr& world)
    : collision_detection::CollisionEnv(other, world),
      link_shapes_(other.link_shapes_),
      world_parts_(std::make_unique<PosedParts>(*other.world_parts_)) {
  observe(false);
}

CollisionEnv::~CollisionEnv() { getWorld()->removeObserver(observer_); }

void CollisionEnv::observe(bool tell_all) {
  observer_ = getWorld()->addObserver([this](const World::ObjectConstPtr& object,
                                             World::Action action) { change(object, action); });
  if (tell_all) getWorld()->notifyObserverAllObjects(observer_, World::CREATE);
}

void CollisionEnv::setWorld(const collision_detection::WorldPtr& world) {
  if (world == getWorld()) return;
  getWorld()->removeObserver(observer_);
  *world_parts_ = {};
  collision_detection::CollisionEnv::setWorld(world);
  observe(true);
}

void CollisionEnv::change(const ObjectConstPtr& object, World::Action action) {
  world_parts_->remove(object->id_);
  if (action == World::DESTROY) return;
  world_parts_->owners.push_back({.name = object->id_});
  for (std::size_t i = 0; i < object->shapes_.size(); ++i) {
    const auto shape = parts_of(object->shapes_[i]);
    if (!shape->fault.empty()) {
      RCLCPP_ERROR(logger(), "Object '%s' collides with everything: %s", object->id_.c_str(),
                   shape->fault.c_str());
    }
    world_parts_->add(shape, object->global_shape_poses_[i]);
  }
}

void CollisionEnv::make_link(const moveit::core::LinkModel& link) {
  for (std::size_t i = 0; i < link.getShapes().size(); ++i) {
    const auto shape =
        parts_of(link.getShapes()[i], getLinkScale(link.getName()), getLinkPadding(link.getName()));
    if (!shape->fault.empty()) {
      RCLCPP_ERROR(logger(), "Link '%s' collides with everything: %s", link.getName().c_str(),
                   shape->fault.c_str());
    }
    link_shapes_[static_cast<std::size_t>(link.getFirstCollisionBodyTransformIndex()) + i] = shape;
  }
}

void CollisionEnv::updatedPaddingOrScaling(const std::vector<std::string>& links) {
  for (const std::string& name : links) {
    if (!robot_model_->hasLinkModel(name)) {
      RCLCPP_ERROR(logger(), "The robot has no link '%s' to pad or scale", name.c_str());
      continue;
    }
    make_link(*robot_model_->getLinkModel(name));
  }
}

// Returns the parts in the world, or in the frames of the links that carry them.
PosedParts CollisionEnv::robot_at(const RobotState& state, bool in_links) const {
  PosedParts robot;
  robot.parts.reserve(2 * link_shapes_.size());
  robot.boxes.reserve(2 * link_shapes_.size());
  for (const auto* link : robot_model_->getLinkModelsWithCollisionGeometry()) {
    robot.owners.push_back({link->getName(), collision_detection::BodyTypes::ROBOT_LINK, link});
    for (std::size_t i = 0; i < link->getShapes().size(); ++i) {
      robot.add(
          link_shapes_[static_cast<std::size_t>(link->getFirstCollisionBodyTransformIndex()) + i],
          in_links ? link->getCollisionOriginTransforms()[i]
                   : state.getCollisionBodyTransform(link, i));
    }
  }
  std::vector<const moveit::core::AttachedBody*> attached;
  state.getAttachedBodies(attached);
  for (const auto* body : attached) {
    robot.owners.push_back({body->getName(), collision_detection::BodyTypes::ROBOT_ATTACHED,
                            body->getAttachedLink(), body});
    for (std::size_t i = 0; i < body->getShapes().size(); ++i) {
      robot.add(parts_of(body->getShapes()[i], getLinkScale(body->getAttachedLinkName()),
                         getLinkPadding(body->getAttachedLinkName())),
                in_links ? body->getShapePosesInLinkFrame()[i]
                         : body->getGlobalCollisionBodyTransforms()[i]);
    }
  }
  return robot;
}

void CollisionEnv::check_self(const collision_detection::CollisionRequest& request,
                              collision_detection::CollisionResult& result, const RobotState& state,
                              const Matrix* matrix) const {
  refuse_cost(request);
  const PosedParts robot = robot_at(state);
  PairFilter filter(matrix, PairFilter::links_of(*robot_model_, request.group_name), robot, robot);
  CollisionCheck(request, result).check(robot, robot, filter);
  add_distance(request, result, matrix, robot_model_,
               [&](const auto& asked, auto& found) { distanceSelf(asked, found, state); });
}

void CollisionEnv::check_robot(const collision_detection::CollisionRequest& request,
                               collision_detection::CollisionResult& result,
                               const RobotState& state, const Matrix* matrix) const {
  refuse_cost(request);
  const PosedParts robot = robot_at(state);
  PairFilter filter(matrix, PairFilter::links_of(*robot_model_, request.group_name), robot,
                    *world_parts_);
  CollisionCheck(request, result).check(robot, *world_parts_, filter);
  add_distance(request, result, matrix, robot_model_,
               [&](const auto& asked, auto& found) { distanceRobot(asked, found, state); });
}

void CollisionEnv::check_motion(const collision_detection::CollisionRequest& request,
                                collision_detection::CollisionResult& result,
                                const RobotState& from, const RobotState& to,
                                const Matrix* matrix) const {
  refuse_cost(request);
  const PosedParts robot = robot_at(from), links = robot_at(from, true);
  PairFilter filter(matrix, PairFilter::links_of(*robot_model_, request.group_name), robot,
                    *world_parts_);
  const auto checked = clearance_moveit::check_motion(from, to, robot, links, *world_parts_, filter,
                                                      {request.distance, request.contacts});
  if (const auto* text = std::get_if<std::string>(&checked)) {
    RCLCPP_ERROR(logger(), "The motion counts as a collision: %s", text->c_str());
    result.collision = true;
    if (request.distance) result.distance = std::min(result.distance, 0.0);
    return;
  }
  const auto& verdict = std::get<MotionVerdict>(checked);
  if (request.distance) result.distance = std::min(result.distance, verdict.distance);
  if (verdict.is_free) return;
  result.collision = true;
  if (!request.contacts) return;
  collision_detection::CollisionRequest at_contact = request;
  at_contact.distance = false;
  at_contact.max_contacts -= std::min(result.contact_count, request.max_contacts);
  collision_detection::CollisionResult found;
  check_robot(at_contact, found, state_at(from, to, verdict.contact_at), matrix);
  for (auto& [pair, contacts] : found.contacts) {
    for (collision_detection::Contact& contact : contacts) {
      contact.percent_interpolation = verdict.contact_at;
      result.contacts[pair].push_back(contact);
      ++result.contact_count;
    }
  }
}

void CollisionEnv::distanceSelf(const collision_detection::DistanceRequest& request,
                                collision_detection::DistanceResult& result,
                                const RobotState& state) const {
  const PosedParts robot = robot_at(state);
  PairFilter filter(request.acm, request.active_components_only, robot, robot);
  DistanceCheck(request, result).check(robot, robot, filter);
}

void CollisionEnv::distanceRobot(const collision_detection::DistanceRequest& request,
                                 collision_detection::DistanceResult& result,
                                 const RobotState& state) const {
  const PosedParts robot = robot_at(state);
  PairFilter filter(request.acm, request.active_components_only, robot, *world_parts_);
  DistanceCheck(request, result).check(robot, *world_parts_, filter);
}

void CollisionEnv::checkSelfCollision(const collision_detection::CollisionRequest& request,
                                      collision_detection::CollisionResult& result,
                                      const RobotState& state) const {
  check_self(request, result, state, nullptr);
}

void CollisionEnv::checkSelfCollision(const collision_detection::CollisionRequest& request,
                                      collision_detection::CollisionResult& result,
                                      const RobotState& state, const Matrix& matrix) const {
  check_self(request, result, state, &matrix);
}

void CollisionEnv::checkRobotCollision(const collision_detection::CollisionRequest& request,
                                       collision_detection::CollisionResult& result,
                                       const RobotState& state) const {
  check_robot(request, result, state, nullptr);
}

void CollisionEnv::checkRobotCollision(const collision_detection::CollisionRequest& request,
                                       collision_detection::CollisionResult& result,
                                       const RobotState& state, const Matrix& matrix) const {
  check_robot(request, result, state, &matrix);
}

void CollisionEnv::checkRobotCollision(const collision_detection::CollisionRequest& request,
                                       collision_detection::CollisionResult& result,
                                       const RobotState& from, const RobotState& to) const {
  check_motion(request, result, from, to, nullptr);
}

void CollisionEnv::checkRobotCollision(const collision_detection::CollisionRequest& request,
                                       collision_detection::CollisionResult& result,
                                       const RobotState& from, const RobotState& to,
                                       const Matrix& matrix) const {
  check_motion(request, result, from, to, &matrix);
}

}  // namespace clearance_moveit
