#include "motion_scene.hpp"

#include "pair_query.hpp"

#include <algorithm>
#include <config/scene/chain_rounding.hpp>
#include <cstddef>
#include <cstdint>
#include <map>

#include <moveit/robot_model/prismatic_joint_model.hpp>
#include <moveit/robot_model/revolute_joint_model.hpp>

namespace clearance_moveit {
namespace {

using clearance::JointType;
using clearance::Scene;
using moveit::core::JointModel;
using moveit::core::LinkModel;

// More parts near the robot would take too much memory.
constexpr std::size_t kMostParts = 20'000;

JointType type_of(const JointModel& joint) {
  switch (joint.getType()) {
    case JointModel::REVOLUTE:
      return static_cast<const moveit::core::RevoluteJointModel&>(joint).isContinuous()
                 ? JointType::kContinuous
                 : JointType::kRevolute;
    case JointModel::PRISMATIC:
      return JointType::kPrismatic;
    default:
      return JointType::kFixed;
  }
}

Vec3 axis_of(const JointModel& joint) {
  if (joint.getType() == JointModel::REVOLUTE)
    return static_cast<const moveit::core::RevoluteJointModel&>(joint).getAxis();
  if (joint.getType() == JointModel::PRISMATIC)
    return static_cast<const moveit::core::PrismaticJointModel&>(joint).getAxis();
  return Vec3::UnitZ();
}

clearance::JointVariable variable_of(const JointModel& joint, std::uint32_t index) {
  clearance::JointVariable variable;
  variable.name = joint.getVariableNames().front();
  variable.first_of_joint = index;
  const moveit::core::VariableBounds& bounds = joint.getVariableBounds().front();
  if (bounds.position_bounded_ && joint.getType() == JointModel::PRISMATIC) {
    variable.lower = bounds.min_position_;
    variable.upper = bounds.max_position_;
  }
  return variable;
}

// The first link is the frame of the world, in which MoveIt's root joint places the robot. Parents
// come before their children in MoveIt's order, too.
clearance::Robot robot_of(const moveit::core::RobotModel& model, std::span<const Pose> rests,
                          Scene& scene) {
  clearance::Robot robot;
  robot.name = model.getName();
  robot.links.push_back({});
  std::map<const JointModel*, std::uint32_t> variable;
  for (const JointModel* joint : model.getJointModels()) {
    if (joint->getMimic() != nullptr || type_of(*joint) == JointType::kFixed) continue;
    variable[joint] = static_cast<std::uint32_t>(scene.variables.size());
    scene.variables.push_back(variable_of(*joint, variable[joint]));
  }
  for (const LinkModel* link : model.getLinkModels()) {
    const JointModel& model_joint = *link->getParentJointModel();
    clearance::RobotJoint joint;
    joint.name = model_joint.getName();
    joint.type = type_of(model_joint);
    if (const LinkModel* parent = link->getParentLinkModel())
      joint.parent = static_cast<std::uint32_t>(parent->getLinkIndex() + 1);
    joint.parent_from_joint = rests[link->getLinkIndex()];
    if (joint.type == JointType::kFixed) {
      robot.joints.push_back(std::move(joint));
      robot.links.push_back({link->getName()});
      continue;
    }
    joint.axis = axis_of(model_joint);
    const JointModel* leader = model_joint.getMimic();
    joint.variable = variable.at(leader != nullptr ? leader : &model_joint);
    if (leader != nullptr) {
      joint.multiplier = model_joint.getMimicFactor();
      joint.offset = model_joint.getMimicOffset();
    }
    robot.joints.push_back(std::move(joint));
    robot.links.push_back({link->getName()});
  }
  return robot;
}

void add_objects(const PosedParts& of, bool fixed, Scene& scene) {
  const std::size_t first = scene.objects.size();
  for (const Owner& owner : of.owners) {
    clearance::Object& object = scene.objects.emplace_back();
    object.name = owner.name;
    object.fixed = fixed;
  }
  for (const PosedPart& part : of.parts)
    scene.objects[first + part.owner].parts.push_back({"", *part.body, part.world_from_part});
}

}  // namespace

std::vector<Pose> rests_of(const moveit::core::RobotState& state) {
  std::vector<Pose> rests;
  for (const LinkModel* link : state.getRobotModel()->getLinkModels()) {
    const JointModel* joint = link->getParentJointModel();
    const bool moves = type_of(*joint) != JointType::kFixed;
    rests.push_back(
        pose_of(moves ? link->getJointOriginTransform()
                      : link->getJointOriginTransform() * state.getJointTransform(joint)));
  }
  return rests;
}

double reach(const moveit::core::RobotModel& model, std::span<const Pose> rests,
             const PosedParts& links) {
  double sum = 0.0;
  for (const LinkModel* link : model.getLinkModels()) {
    if (link->getParentLinkModel() != nullptr) sum += rests[link->getLinkIndex()].position.norm();
  }
  double farthest = 0.0;
  for (const Box& box : links.boxes)
    farthest = std::max(farthest, box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs()).norm());
  return sum + farthest;
}

PosedParts with_leaves(const PosedParts& world, const PosedParts& robot, double within) {
  Box around{Vec3::Constant(clearance::kInfinity), Vec3::Constant(-clearance::kInfinity)};
  for (const Box& box : robot.boxes) {
    around.low = around.low.cwiseMin(box.low);
    around.high = around.high.cwiseMax(box.high);
  }
  PosedParts near;
  near.owners = world.owners;
  for (std::size_t i = 0; i < world.parts.size(); ++i) {
    const PosedPart& part = world.parts[i];
    if (part.shape->octree == nullptr) {
      near.parts.push_back(part);
      near.boxes.push_back(world.boxes[i]);
      continue;
    }
    visit_leaves(part, around, within, [&](const clearance::ConvexBody& cube, const Pose& pose) {
      near.parts.push_back({part.shape, &cube, pose, part.owner});
      near.boxes.emplace_back();
      return near.parts.size() <= kMostParts;
    });
  }
  return near;
}

std::vector<clearance::ObjectPair> watched_pairs(const PosedParts& links, const PosedParts& world,
                                                 PairFilter& filter) {
  std::vector<bool> has_part(world.owners.size(), false);
  for (const PosedPart& part : world.parts) has_part[part.owner] = true;
  const auto first = static_cast<std::uint32_t>(world.owners.size());
  std::vector<clearance::ObjectPair> pairs;
  for (std::uint32_t w = 0; w < first; ++w) {
    if (!has_part[w]) continue;
    for (std::uint32_t i = 0; i < links.owners.size(); ++i) {
      if (filter.decide(i, w) != PairFilter::Decision::kLeftOut) pairs.push_back({w, first + i});
    }
  }
  return pairs;
}

std::variant<Scene, std::string> motion_scene(const moveit::core::RobotModel& model,
                                              std::span<const Pose> rests, const PosedParts& links,
                                              const PosedParts& world,
                                              std::vector<clearance::ObjectPair> pairs) {
  for (const PosedParts* parts : {&links, &world}) {
    for (const PosedPart& part : parts->parts) {
      if (part.body == nullptr)
        return "'" + parts->owners[part.owner].name + "' has a shape without convex parts";
    }
  }
  if (world.parts.size() > kMostParts)
    return "more than " + std::to_string(kMostParts) + " parts are in the world";
  Scene scene;
  scene.name = model.getName();
  scene.revision = 1;
  add_objects(world, true, scene);
  add_objects(links, false, scene);
  const auto first = static_cast<std::uint32_t>(world.owners.size());
  scene.robots.push_back(robot_of(model, rests, scene));
  auto errors = clearance::chain_rounding(scene.robots, scene.variables);
  for (std::uint32_t i = 0; i < links.owners.size(); ++i) {
    const Owner& owner = links.owners[i];
    const auto link = static_cast<std::uint32_t>(owner.link->getLinkIndex() + 1);
    if (owner.attached == nullptr) {
      scene.robots.front().links[link].object = first + i;
      clearance::account_for(errors[link], scene.objects[first + i]);
      continue;
    }
    clearance::Robot& carried = scene.robots.emplace_back();
    carried.name = owner.name;
    carried.is_attached = true;
    carried.base.kind = clearance::RobotBase::Kind::kLink;
    carried.base.link = link;
    carried.links.push_back({owner.name, first + i});
    clearance::account_for(clearance::chain_rounding(scene.robots, scene.variables).front(),
                           scene.objects[first + i]);
  }
  scene.pairs = std::move(pairs);
  return scene;
}

}  // namespace clearance_moveit
