#include "config/cell/published_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

namespace clearance {
namespace {

using Places = std::vector<std::optional<Pose>>;  // of objects in the world

// Joints with several variables stay at zero.
Pose parent_from_child(const RobotJoint& joint, std::span<const JointVariable> variables) {
  if (joint.type == JointType::kFixed || variables_of(joint.type) != 1)
    return joint.parent_from_joint;
  const JointVariable& variable = variables[joint.variable];
  const double position =
      joint.multiplier * std::clamp(0.0, variable.lower, variable.upper) + joint.offset;
  Pose moved;
  if (joint.type == JointType::kPrismatic) {
    moved.position = position * joint.axis;
  } else {
    moved.orientation = Eigen::AngleAxisd(position, joint.axis);
  }
  return compose(joint.parent_from_joint, moved);
}

Places places_of(const PlacedObjects& placed) {
  Places places(placed.objects.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    if (placed.objects[i].fixed) places[i] = placed.objects[i].world_from_object;
  std::vector<Places> links;  // by robot; what a robot stands on comes before it
  for (const Robot& robot : placed.robots) {
    Places& of = links.emplace_back(robot.links.size());
    std::optional<Pose> carrier = Pose{};
    if (robot.base.kind == RobotBase::Kind::kObject) carrier = places[robot.base.object];
    if (robot.base.kind == RobotBase::Kind::kLink)
      carrier = links[robot.base.robot][robot.base.link];
    // A robot whose carrier has no place still has its links in the right places to each other.
    of[0] = compose(carrier.value_or(Pose{}), robot.base.base_from_root);
    for (std::size_t i = 0; i < robot.joints.size(); ++i) {
      of[i + 1] = compose(*of[robot.joints[i].parent],
                          parent_from_child(robot.joints[i], placed.variables));
    }
    for (std::size_t i = 0; i < of.size(); ++i)
      if (robot.links[i].object != RobotLink::kNoObject) places[robot.links[i].object] = of[i];
  }
  return places;
}

struct Ball {
  Vec3 centre;
  double radius;
};

std::vector<Ball> balls_of(const Object& object, const Pose& world_from_object) {
  std::vector<Ball> balls;
  for (const Part& part : object.parts) {
    double radius = part.shape.bounded() ? 0.0 : kInfinity;
    for (const Vec3& anchor : part.shape.anchors)
      radius = std::max(radius, (anchor - part.shape.interior).norm());
    balls.push_back(
        {transform(world_from_object, transform(part.object_from_part, part.shape.interior)),
         radius + part.shape.radius});
  }
  return balls;
}

double distance(const std::vector<Ball>& a, const std::vector<Ball>& b) {
  double least = kInfinity;
  for (const Ball& one : a)
    for (const Ball& other : b)
      least = std::min(least, (one.centre - other.centre).norm() - one.radius - other.radius);
  return a.empty() || b.empty() ? -kInfinity : least;
}

}  // namespace

std::string publish_open_pairs(const PlacedObjects& placed, std::span<const Zone> zones,
                               PairList& pairs) {
  const auto stated =
      static_cast<std::size_t>(std::ranges::count(pairs.pairs, true, &ObjectPair::publish));
  std::vector<std::uint32_t> open;
  for (const std::uint32_t pair : pairs.open)
    if (!pairs.pairs[pair].publish) open.push_back(pair);
  const std::size_t room = kMaxPublished - std::min(stated, kMaxPublished);
  if (open.size() > room) {
    std::vector<bool> in_zone(pairs.pairs.size(), false);
    for (const Zone& zone : zones)
      for (const std::uint32_t pair : zone.pairs) in_zone[pair] = true;
    const Places places = places_of(placed);
    std::vector<std::vector<Ball>> balls;
    for (std::size_t i = 0; i < places.size(); ++i)
      balls.push_back(places[i] ? balls_of(placed.objects[i], *places[i]) : std::vector<Ball>());
    std::vector<std::tuple<bool, double, std::uint32_t>> order;
    for (const std::uint32_t pair : open) {
      const ObjectPair& of = pairs.pairs[pair];
      order.emplace_back(!in_zone[pair], distance(balls[of.first], balls[of.second]), pair);
    }
    std::ranges::sort(order);
    for (std::size_t i = 0; i < open.size(); ++i) open[i] = std::get<2>(order[i]);
  }
  for (std::size_t i = 0; i < std::min(room, open.size()); ++i) pairs.pairs[open[i]].publish = true;
  if (open.size() <= room) return "";
  return fmt::format(
      "of {} watched pairs, reports carry {}: those of zones, and those that are nearest with all "
      "joints at zero (a rule of a cell states others: publish: true); the others are watched too",
      pairs.pairs.size(), kMaxPublished);
}

}  // namespace clearance
