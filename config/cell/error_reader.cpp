#include "config/cell/error_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "config/scene/stated_errors.hpp"
#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

// How an object gets its place.
enum class Placed { kByJoints, kFixed, kBySender, kAttached, kBySensor };

class ErrorReader {
 public:
  ErrorReader(const Quantities& quantities, RobotList& robots, ObjectList& list, Scene& scene)
      : quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        robots_(robots),
        list_(list),
        scene_(scene),
        placed_(list.objects.size(), Placed::kBySender) {
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      const Object& object = list.objects[i];
      if (object.fixed) placed_[i] = Placed::kFixed;
      if (object.resting_on.kind != RestingOn::Kind::kWorld) placed_[i] = Placed::kAttached;
      if (object.is_seen()) placed_[i] = Placed::kBySensor;
    }
    for (const Robot& robot : robots.robots) {
      for (const RobotLink& link : robot.links) {
        if (link.object == RobotLink::kNoObject) continue;
        placed_[link.object] = robot.is_attached ? Placed::kAttached : Placed::kByJoints;
      }
    }
  }

  void read(const YamlNode& node);

 private:
  void read_place(MapReader& map, PlaceError& error);
  void read_joint(MapReader& map, JointError& error);
  std::optional<PlaceError> read_places(MapReader& map, const char* key, const char* what);
  void state(Placed how, const PlaceError& error);
  void follow_masters();
  [[nodiscard]] const RobotJoint* master_of(const Robot& robot, const RobotJoint& joint) const;
  void read_exception(const YamlNode& node);
  void read_joint_exception(const YamlNode& name, MapReader& map);
  void read_base_exception(const YamlNode& name, MapReader& map);
  void read_object_exception(const YamlNode& name, MapReader& map);
  // The error of the object's place: its own, or that of the robot that it is by itself.
  PlaceError& place_of(std::uint32_t object);
  void refuse_name(const YamlNode& node, const std::string& name, const std::string& expected,
                   const std::vector<std::string>& names);

  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  RobotList& robots_;
  ObjectList& list_;
  Scene& scene_;
  std::vector<Placed> placed_;  // by object
};

// The base of a robot that follows a frame of tf is a floating joint, placed by a sender.
bool is_on_tf(const Robot& robot) { return !robot.base.frame.empty(); }

bool is_limb(std::span<const Robot> robots, std::uint32_t object) {
  return std::ranges::any_of(robots, [object](const Robot& robot) {
    return robot.person &&
           std::ranges::find(robot.links, object, &RobotLink::object) != robot.links.end();
  });
}

void ErrorReader::read_place(MapReader& map, PlaceError& error) {
  if (const YamlNode* node = map.optional("translation"))
    error.translation =
        quantities_.length(*node, "the largest error of a place", kNotNegative).value_or(0.0);
  if (const YamlNode* node = map.optional("rotation")) {
    const auto angle = quantities_.angle(*node, "the largest error of an orientation");
    if (angle && *angle < 0.0)
      diagnostics_.add(*node, fmt::format("found {}; expected an angle from 0 on", node->text));
    error.rotation = std::max(0.0, angle.value_or(0.0));
  }
}

void ErrorReader::read_joint(MapReader& map, JointError& error) {
  if (const YamlNode* node = map.optional("position")) {
    const auto angle = quantities_.angle(*node, "the largest error of a joint's angle");
    if (angle && *angle < 0.0)
      diagnostics_.add(*node, fmt::format("found {}; expected an angle from 0 on", node->text));
    error.position = std::max(0.0, angle.value_or(0.0));
  }
  if (const YamlNode* node = map.optional("slide"))
    error.slide = quantities_.length(*node, "the largest error of a sliding joint", kNotNegative)
                      .value_or(0.0);
  read_place(map, error.frame);
}

std::optional<PlaceError> ErrorReader::read_places(MapReader& map, const char* key,
                                                   const char* what) {
  const YamlNode* node = map.optional(key);
  if (node == nullptr) return std::nullopt;
  PlaceError error;
  MapReader places(*node, what, diagnostics_);
  read_place(places, error);
  places.refuse_unknown_keys();
  return error;
}

PlaceError& ErrorReader::place_of(std::uint32_t object) {
  for (Robot& robot : robots_.robots)
    if (robot.is_attached && robot.links.front().object == object) return robot.base_error;
  return list_.objects[object].place_error;
}

void ErrorReader::state(Placed how, const PlaceError& error) {
  for (std::uint32_t i = 0; i < placed_.size(); ++i)
    if (placed_[i] == how) place_of(i) = error;
}

void ErrorReader::read(const YamlNode& node) {
  MapReader map(node, "the stated errors", diagnostics_);
  if (const YamlNode* joints = map.optional("joints")) {
    JointError error;
    MapReader keys(*joints, "the errors of joints", diagnostics_);
    read_joint(keys, error);
    keys.refuse_unknown_keys();
    for (Robot& robot : robots_.robots) {
      for (std::size_t i = is_on_tf(robot) ? 1 : 0; i < robot.joints.size(); ++i)
        robot.joints[i].error = error;
    }
  }
  if (const auto bases = read_places(map, "bases", "the errors of robots' bases")) {
    for (Robot& robot : robots_.robots)
      if (!robot.is_attached && !is_on_tf(robot)) robot.base_error = *bases;
  }
  if (const auto poses = read_places(map, "poses", "the errors of poses as they are sent")) {
    state(Placed::kBySender, *poses);
    for (Robot& robot : robots_.robots)
      if (is_on_tf(robot)) robot.joints.front().error.frame = *poses;
  }
  if (const auto fixed = read_places(map, "fixed", "the errors of fixed objects"))
    state(Placed::kFixed, *fixed);
  if (const auto attached = read_places(map, "attached", "the errors of attached objects")) {
    scene_.attached_error = *attached;
    for (Object& object : list_.objects) object.attached_error = *attached;
    state(Placed::kAttached, *attached);
  }
  if (const auto mounts = read_places(map, "mounts", "the errors of sensors' mounts"))
    state(Placed::kBySensor, *mounts);
  if (const YamlNode* shapes = map.optional("shapes")) {
    const double error =
        quantities_.length(*shapes, "the largest error of a shape", kNotNegative).value_or(0.0);
    scene_.added_shape_error = error;
    for (Object& object : list_.objects)
      if (!object.is_seen()) object.shape_error = std::max(object.shape_error, error);
  }
  if (const YamlNode* except = map.optional("except")) {
    for (const YamlNode& item : read_list(*except, "exceptions", diagnostics_))
      read_exception(item);
  }
  map.refuse_unknown_keys();
  follow_masters();
}

// The position of a joint that mimics another is as wrong as that one's, times the factor.
void ErrorReader::follow_masters() {
  for (Robot& robot : robots_.robots) {
    for (RobotJoint& joint : robot.joints) {
      const RobotJoint* const master = master_of(robot, joint);
      if (master == nullptr) continue;
      const double error =
          master->type == JointType::kPrismatic ? master->error.slide : master->error.position;
      joint.error.position = joint.error.slide = error;
    }
  }
}

// Null: the joint mimics none.
const RobotJoint* ErrorReader::master_of(const Robot& robot, const RobotJoint& joint) const {
  if (variables_of(joint.type) != 1) return nullptr;
  const std::string& name = robots_.variables[joint.variable].name;
  if (joint.name == name) return nullptr;
  const auto master = std::ranges::find(robot.joints, name, &RobotJoint::name);
  return master == robot.joints.end() ? nullptr : &*master;
}

void ErrorReader::read_exception(const YamlNode& node) {
  MapReader map(node, "an exception", diagnostics_);
  const YamlNode* joint = map.optional("joint");
  const YamlNode* base = map.optional("base");
  const YamlNode* object = map.optional("object");
  const int named = (joint != nullptr) + (base != nullptr) + (object != nullptr);
  if (named != 1) {
    diagnostics_.add(node, fmt::format("found {} of 'joint', 'base' and 'object'; expected one of "
                                       "them, with a name",
                                       named == 0 ? "none" : "several"));
    return;
  }
  if (joint != nullptr) read_joint_exception(*joint, map);
  if (base != nullptr) read_base_exception(*base, map);
  if (object != nullptr) read_object_exception(*object, map);
  map.refuse_unknown_keys();
}

void ErrorReader::refuse_name(const YamlNode& node, const std::string& name,
                              const std::string& expected, const std::vector<std::string>& names) {
  if (!list_.names_known) return;
  diagnostics_.add(
      node, fmt::format("found '{}'; expected {}{}", name, expected, did_you_mean(name, names)));
}

void ErrorReader::read_joint_exception(const YamlNode& node, MapReader& map) {
  const auto name = read_name(node, "the name of a joint, with the robot's prefix", diagnostics_);
  JointError unused;
  JointError* error = &unused;
  std::vector<std::string> names;
  for (Robot& robot : robots_.robots) {
    for (std::size_t i = is_on_tf(robot) ? 1 : 0; i < robot.joints.size(); ++i) {
      names.push_back(robot.joints[i].name);
      if (!name || robot.joints[i].name != *name) continue;
      error = &robot.joints[i].error;
      const RobotJoint* const master = master_of(robot, robot.joints[i]);
      for (const char* key : {"position", "slide"}) {
        if (const YamlNode* stated = master == nullptr ? nullptr : map.optional(key))
          diagnostics_.add(*stated, fmt::format("found '{}' of '{}', which mimics another joint; "
                                                "expected it of '{}'",
                                                key, *name, master->name));
      }
    }
  }
  read_joint(map, *error);
  if (name && error == &unused)
    refuse_name(node, *name, "a joint of a robot, with the robot's prefix", names);
}

void ErrorReader::read_base_exception(const YamlNode& node, MapReader& map) {
  const auto name = read_name(node, "the name of a robot", diagnostics_);
  PlaceError unused;
  PlaceError* error = &unused;
  std::vector<std::string> names;
  for (Robot& robot : robots_.robots) {
    if (robot.is_attached) continue;
    names.push_back(robot.name);
    if (name && robot.name == *name)
      error = is_on_tf(robot) ? &robot.joints.front().error.frame : &robot.base_error;
  }
  read_place(map, *error);
  if (name && error == &unused) refuse_name(node, *name, "a robot", names);
}

void ErrorReader::read_object_exception(const YamlNode& node, MapReader& map) {
  const auto name = read_name(node, "the name of an object", diagnostics_);
  std::vector<std::string> names;
  std::optional<std::uint32_t> found;
  for (std::uint32_t i = 0; i < list_.objects.size(); ++i) {
    names.push_back(list_.objects[i].name);
    if (name && names.back() == *name) found = i;
  }
  if (const YamlNode* shape = map.optional("shape")) {
    const double error =
        quantities_.length(*shape, "the largest error of a shape", kNotNegative).value_or(0.0);
    if (found && list_.objects[*found].is_seen()) {
      diagnostics_.add(*shape, "found 'shape' of a sensor; expected 'depth_error' of that sensor");
    } else if (found && is_limb(robots_.robots, *found)) {
      diagnostics_.add(*shape, "found 'shape' of a person's limb; expected 'error' of the person");
    } else if (found) {
      list_.objects[*found].shape_error = error;
    }
  }
  if (found && placed_[*found] == Placed::kByJoints) {
    for (const char* key : {"translation", "rotation"}) {
      if (const YamlNode* place = map.optional(key))
        diagnostics_.add(*place, fmt::format("found '{}' of the link '{}'; expected it of the "
                                             "joint that carries the link",
                                             key, *name));
    }
    return;
  }
  PlaceError unused;
  PlaceError& place = found ? place_of(*found) : unused;
  read_place(map, place);
  PlaceError& attached = found ? list_.objects[*found].attached_error : unused;
  if (map.optional("translation") != nullptr) attached.translation = place.translation;
  if (map.optional("rotation") != nullptr) attached.rotation = place.rotation;
  if (name && !found) refuse_name(node, *name, "an object of the cell", names);
}

}  // namespace

void read_errors(const YamlNode& node, const Quantities& quantities, RobotList& robots,
                 ObjectList& list, Scene& scene) {
  ErrorReader(quantities, robots, list, scene).read(node);
}

void refuse_large_angles(const YamlNode& node, const Scene& scene, Diagnostics& diagnostics) {
  const StatedErrors errors(scene);
  if (const auto why = errors.too_large_angle(scene)) return diagnostics.add(node, *why);
  double most = 0.0;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i)
    most = std::max(most, errors.angle_of(i));
  if (most + scene.attached_error.rotation <= kMostAngle) return;
  diagnostics.add(node, fmt::format("found angles that add up to {:.3f} rad for what may be "
                                    "attached; expected at most {} rad",
                                    most + scene.attached_error.rotation, kMostAngle));
}

std::string unstated_errors(const Scene& scene) {
  if (!StatedErrors(scene).any()) return "";
  // By kind: is there one in the cell, and does one state an error?
  struct Kind {
    const char* name;
    bool is_there = false, is_stated = false;
    void add(bool stated) {
      is_there = true;
      is_stated = is_stated || stated;
    }
  };
  Kind positions{"positions of joints"}, frames{"frames of joints"}, bases{"bases"},
      fixed{"fixed objects"}, poses{"poses as sent"}, attached{"attached objects"},
      mounts{"mounts of sensors"}, shapes{"shapes"};
  std::vector<bool> is_link(scene.objects.size());
  for (const Robot& robot : scene.robots) {
    if (robot.is_attached) attached.add(robot.base_error.any());
    if (!robot.is_attached && !is_on_tf(robot)) bases.add(robot.base_error.any());
    for (std::size_t i = 0; i < robot.joints.size(); ++i) {
      const JointError& error = robot.joints[i].error;
      if (is_on_tf(robot) && i == 0) {
        poses.add(error.frame.any());
        continue;
      }
      frames.add(error.frame.any());
      const JointType type = robot.joints[i].type;
      if (variables_of(type) == 1)
        positions.add((type == JointType::kPrismatic ? error.slide : error.position) > 0.0);
    }
    for (const RobotLink& link : robot.links)
      if (link.object != RobotLink::kNoObject) is_link[link.object] = true;
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (!object.is_seen()) shapes.add(object.shape_error > 0.0);
    if (is_link[i]) continue;
    const bool is_carried = object.resting_on.kind != RestingOn::Kind::kWorld;
    (object.is_seen() ? mounts
     : is_carried     ? attached
     : object.fixed   ? fixed
                      : poses)
        .add(object.place_error.any());
  }
  std::vector<std::string> left;
  for (const Kind& kind : {positions, frames, bases, fixed, poses, attached, mounts, shapes}) {
    if (kind.is_there && !kind.is_stated) left.push_back(kind.name);
  }
  return left.empty() ? ""
                      : "errors taken as 0, since none is stated: " + listed(left, left.size());
}

}  // namespace clearance
