// Sources come in the order objects, robots, sensors, so that each one comes after what carries it.
#include "config/scene/stated_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "config/scene/chain_rounding.hpp"
#include "config/scene/robot_reach.hpp"
#include "config/scene/scene.hpp"

namespace clearance {
namespace {

constexpr double kOutward = 1.0 + 1e-9;

// Returns the pose of a link that no joint moves.
Pose rest_pose(const Scene& scene, std::uint32_t robot, std::uint32_t link) {
  const Robot& of = scene.robots[robot];
  if (link == 0) return of.base.base_from_root;
  const RobotJoint& joint = of.joints[link - 1];
  return compose(rest_pose(scene, robot, joint.parent), joint.parent_from_joint);
}

ErrorSource of_place(const PlaceError& error) {
  ErrorSource source;
  source.translation = error.translation;
  source.rotation = error.rotation;
  return source;
}

ErrorSource of_object(const Scene& scene, std::uint32_t object) {
  ErrorSource source = of_place(scene.objects[object].place_error);
  source.object = object;
  return source;
}

// A planar or floating joint carries its link anywhere, so its frame is where the link is.
ErrorSource of_joint(const RobotJoint& joint, std::uint32_t robot, std::uint32_t link) {
  ErrorSource source = of_place(joint.error.frame);
  source.on_link = true;
  source.robot = robot;
  source.link = link;
  source.joint = link - 1;
  if (variables_of(joint.type) > 1) return source;
  source.link = joint.parent;
  source.origin = joint.parent_from_joint.position;
  source.axis = joint.parent_from_joint.orientation.normalized() * joint.axis;
  const double factor = std::abs(joint.multiplier);
  if (joint.type == JointType::kPrismatic) source.slide = factor * joint.error.slide;
  if (joint.type == JointType::kRevolute || joint.type == JointType::kContinuous)
    source.turn = factor * joint.error.position;
  return source;
}

}  // namespace

// Walks from a body to the world, and lists the sources that carry it, the last one first, each
// with the distance, m, of the body's farthest point from the place of the source.
class StatedErrors::ChainWalk {
 public:
  struct Met {
    std::uint32_t source;
    double reach;
  };
  ChainWalk(const Scene& scene, const StatedErrors& errors) : scene_(scene), errors_(errors) {
    for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
      for (std::uint32_t l = 0; l < scene.robots[r].links.size(); ++l) {
        const std::uint32_t object = scene.robots[r].links[l].object;
        if (object != RobotLink::kNoObject) links_[object] = {r, l};
      }
    }
  }
  [[nodiscard]] std::span<const Met> met() const noexcept { return met_; }

  void of_object(std::uint32_t object) {
    met_.clear();
    const Object& of = scene_.objects[object];
    // No element of a sensor is farther away than its extent.
    const double radius = of.is_seen() ? scene_.sensors[of.sensor].extent() : radius_of(of);
    object_from(object, radius);
  }
  // From what stands on this base, whose farthest point is `reach` from its origin.
  void below(const RobotBase& base, double reach) {
    const double length = base.base_from_root.position.norm();
    if (base.kind == RobotBase::Kind::kObject) return object_from(base.object, reach + length);
    if (base.kind == RobotBase::Kind::kLink)
      return link_from(base.robot, base.link, reach + length);
    rest_on(base.resting_on, base.base_from_root, reach);
  }

 private:
  void object_from(std::uint32_t object, double reach) {
    if (const auto link = links_.find(object); link != links_.end())
      return link_from(link->second.first, link->second.second, reach);
    const Object& of = scene_.objects[object];
    const std::uint32_t source = errors_.objects_[object].source;
    if (of.is_seen()) return meet(source, ErrorSource::kNone, reach);
    meet(source, errors_.source_below(of.resting_on), reach);
    rest_on(of.resting_on, of.world_from_object, reach);
  }
  void rest_on(const RestingOn& on, const Pose& place, double reach) {
    if (on.kind == RestingOn::Kind::kWorld) return;
    const bool on_link = on.kind == RestingOn::Kind::kLink;
    const Pose below = on_link ? rest_pose(scene_, on.robot, on.link)
                               : scene_.objects[on.object].world_from_object;
    reach += (place.position - below.position).norm();
    if (on_link) return link_from(on.robot, on.link, reach);
    object_from(on.object, reach);
  }
  void link_from(std::uint32_t robot, std::uint32_t link, double reach) {
    const Robot& of = scene_.robots[robot];
    const std::vector<std::uint32_t>& sources = errors_.of_link_[robot];
    while (link > 0) {
      const RobotJoint& joint = of.joints[link - 1];
      const double slide = largest_slide(joint, scene_.variables);
      meet(sources[link], sources[joint.parent],
           variables_of(joint.type) > 1 ? reach : reach + slide);
      reach += joint.parent_from_joint.position.norm() + slide;
      link = joint.parent;
    }
    meet(sources[0], errors_.source_below(of.base), reach);
    below(of.base, reach);
  }
  void meet(std::uint32_t source, std::uint32_t below, double reach) {
    if (source != below) met_.push_back({source, reach});
  }

  const Scene& scene_;
  const StatedErrors& errors_;
  std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> links_;  // by object
  std::vector<Met> met_;
};

std::string text_of(const ErrorSource& source, const Scene& scene) {
  if (!source.on_link) {
    const Object& object = scene.objects[source.object];
    return fmt::format("the {} '{}'", object.is_seen() ? "mount of" : "place of", object.name);
  }
  const Robot& robot = scene.robots[source.robot];
  if (source.joint != ErrorSource::kNone)
    return fmt::format("the joint '{}'", robot.joints[source.joint].name);
  return robot.is_attached ? fmt::format("the grasp of '{}'", robot.name)
                           : fmt::format("the base of '{}'", robot.name);
}

StatedErrors::StatedErrors(const Scene& scene) : objects_(scene.objects.size()) {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    objects_[i].shape = scene.objects[i].shape_error;
    any_ = any_ || objects_[i].shape > 0.0;
  }
  add_objects(scene);
  add_robots(scene);
  add_sensors(scene);
  any_ = any_ || !sources_.empty();
  if (any_) measure(scene);
}

// Returns the parent itself if the source adds nothing.
std::uint32_t StatedErrors::add(ErrorSource source, std::uint32_t parent) {
  if (!(source.translation > 0.0) && !(source.angle() > 0.0) && !(source.slide > 0.0))
    return parent;
  source.parent = parent;
  source.depth = parent == ErrorSource::kNone ? 1 : sources_[parent].depth + 1;
  sources_.push_back(source);
  return static_cast<std::uint32_t>(sources_.size() - 1);
}

void StatedErrors::add_objects(const Scene& scene) {
  std::vector<bool> is_link(scene.objects.size());
  for (const Robot& robot : scene.robots) {
    for (const RobotLink& link : robot.links)
      if (link.object != RobotLink::kNoObject) is_link[link.object] = true;
  }
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (!is_link[i] && !object.is_seen() && object.resting_on.kind == RestingOn::Kind::kWorld)
      objects_[i].source = add(of_object(scene, i), ErrorSource::kNone);
  }
}

// What a body stands on comes before it.
std::uint32_t StatedErrors::source_below(const RobotBase& base) const noexcept {
  switch (base.kind) {
    case RobotBase::Kind::kObject:
      return objects_[base.object].source;
    case RobotBase::Kind::kLink:
      return of_link_[base.robot][base.link];
    case RobotBase::Kind::kWorld:
      return source_below(base.resting_on);
  }
  return ErrorSource::kNone;
}

std::uint32_t StatedErrors::source_below(const RestingOn& on) const noexcept {
  switch (on.kind) {
    case RestingOn::Kind::kObject:
      return objects_[on.object].source;
    case RestingOn::Kind::kLink:
      return of_link_[on.robot][on.link];
    case RestingOn::Kind::kWorld:
      break;
  }
  return ErrorSource::kNone;
}

void StatedErrors::add_robots(const Scene& scene) {
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    const Robot& robot = scene.robots[r];
    ErrorSource base = of_place(robot.base_error);
    base.on_link = true;
    base.robot = r;
    const std::uint32_t below = source_below(robot.base);
    std::vector<std::uint32_t>& links = of_link_.emplace_back();
    links.push_back(add(base, below));
    for (std::uint32_t i = 0; i < robot.joints.size(); ++i)
      links.push_back(add(of_joint(robot.joints[i], r, i + 1), links[robot.joints[i].parent]));
    for (std::size_t link = 0; link < links.size(); ++link) {
      if (robot.links[link].object != RobotLink::kNoObject)
        objects_[robot.links[link].object].source = links[link];
    }
  }
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.is_seen() || object.resting_on.kind == RestingOn::Kind::kWorld) continue;
    objects_[i].source = add(of_object(scene, i), source_below(object.resting_on));
  }
}

// A frame is placed by where its carrier was at the stamp. Since then the carrier may have come
// elsewhere, so its errors do not cancel with those of other bodies on it: they become the
// sensor's own.
void StatedErrors::add_sensors(const Scene& scene) {
  for (const Sensor& sensor : scene.sensors) {
    ErrorSource source = of_object(scene, sensor.object);
    ChainWalk walk(scene, *this);
    walk.below(sensor.mount, 0.0);
    double angle = 0.0, error = 0.0;
    for (const auto& [index, reach] : walk.met()) {
      const ErrorSource& met = sources_[index];
      error += met.translation + met.slide + met.angle() * reach;
      angle += met.angle();
    }
    source.translation += (1.0 + angle + angle * angle) * error;
    source.rotation += angle;
    objects_[sensor.object].source = add(source, ErrorSource::kNone);
  }
}

// Every source of the object's chain, the last one first, with how far the object reaches from it.
void StatedErrors::measure(const Scene& scene) {
  ChainWalk walk(scene, *this);
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    walk.of_object(i);
    objects_[i].first = reach_.size();
    for (const auto& [index, reach] : walk.met()) reach_.push_back(kOutward * reach);
  }
}

// The sources of the object's chain down to, and without, `end`.
double StatedErrors::chain_error(const OfObject& of, std::uint32_t end,
                                 double& angle) const noexcept {
  double error = of.shape;
  std::size_t at = of.first;
  for (std::uint32_t s = of.source; s != end; s = sources_[s].parent, ++at) {
    const ErrorSource& source = sources_[s];
    error += source.translation + source.slide;
    if (source.angle() > 0.0) error += source.angle() * reach_[at];
    angle += source.angle();
  }
  return error;
}

double StatedErrors::angle_of(std::uint32_t object) const noexcept {
  double angle = 0.0;
  for (std::uint32_t s = objects_[object].source; s != ErrorSource::kNone; s = sources_[s].parent)
    angle += sources_[s].angle();
  return angle;
}

std::optional<std::string> StatedErrors::too_large_angle(const Scene& scene) const {
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const double angle = angle_of(i);
    if (angle <= kMostAngle) continue;
    return fmt::format(
        "found angles that add up to {:.3f} rad for '{}'; expected at most {} rad over all that "
        "carries an object",
        angle, scene.objects[i].name, kMostAngle);
  }
  return std::nullopt;
}

// One source after the other shifts and turns what those behind it have displaced. So the sum of
// the errors grows by the product of 1 + angle, which is at most 1 + angle + angle^2 of the sum of
// all angles, since the reader of cells limits that.
ErrorsBetween StatedErrors::between(std::uint32_t a, std::uint32_t b) const noexcept {
  const std::uint32_t common = common_source(objects_[a].source, objects_[b].source);
  double angle = 0.0;
  const double error =
      chain_error(objects_[a], common, angle) + chain_error(objects_[b], common, angle);
  return {error > 0.0 ? kOutward * (1.0 + angle + angle * angle) * error : 0.0, common};
}

std::uint32_t StatedErrors::common_source(std::uint32_t a, std::uint32_t b) const noexcept {
  const auto depth = [this](std::uint32_t s) {
    return s == ErrorSource::kNone ? 0 : sources_[s].depth;
  };
  while (a != b) {
    if (depth(a) > depth(b)) {
      a = sources_[a].parent;
    } else {
      b = sources_[b].parent;
    }
  }
  return a;
}

}  // namespace clearance
