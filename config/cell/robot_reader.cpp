// Each robot is read by itself: its description, its tree of joints, its base, and then its links,
// which need all of these.
#include "config/cell/robot_reader.hpp"
#include "config/scene/body_id.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "config/cell/combined_srdf.hpp"
#include "config/cell/joint_reader.hpp"
#include "config/cell/link_parts.hpp"
#include "config/cell/robot_description.hpp"
#include "config/cell/robot_keys.hpp"
#include "config/cell/robot_membership.hpp"
#include "config/cell/stopping_reader.hpp"
#include "config/scene/chain_rounding.hpp"
#include "config/scene/plausible_joints.hpp"
#include "config/urdf/person.hpp"
#include "config/urdf/robot_exceptions.hpp"
#include "config/urdf/robot_files.hpp"

namespace clearance {
namespace {

class RobotReader {
 public:
  RobotReader(const std::filesystem::path& file, const ObjectDefaults& defaults,
              const Quantities& quantities, ShapeReader& shapes, Revision& revision,
              ObjectList& objects)
      : file_(file),
        defaults_(defaults),
        quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        shapes_(shapes),
        revision_(revision),
        objects_(objects) {}

  // Returns false when the robot's links are not known.
  bool read(const YamlNode& node, RobotList& list);
  [[nodiscard]] PosesAtRest take_at_rest() noexcept { return std::move(at_rest_); }

 private:
  void refuse_same_name(const YamlNode& node, const RobotKeys& keys);
  void refuse_without_speed(const RobotKeys& keys, const RobotModel& model);
  StatedBase read_base(const RobotKeys& keys, const RobotList& list);
  bool has_names_of_its_own(const RobotKeys& keys, const RobotModel& model);
  void add_links(const RobotKeys& keys, const RobotDescription& description,
                 const Membership& membership, Robot& robot);
  void allow(const RobotKeys& keys, const RobotDescription& description, Robot& robot,
             PairExceptions& may_touch);
  void account_for_rounding(const RobotList& list);

  const std::filesystem::path& file_;
  const ObjectDefaults& defaults_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  ShapeReader& shapes_;
  Revision& revision_;
  ObjectList& objects_;
  std::map<std::string, int> names_;         // of robots, with their lines
  std::set<std::string> links_, variables_;  // of all robots
  PosesAtRest at_rest_;                      // of all robots
  std::vector<Membership> memberships_;      // of all robots that could be read
};

// A negative limit is one that was not known.
void RobotReader::refuse_without_speed(const RobotKeys& keys, const RobotModel& model) {
  for (const auto& [name, fault] : model.without_speed) {
    const auto variable = std::ranges::find(model.variables, name, &JointVariable::name);
    if (variable != model.variables.end() && !std::isfinite(variable->max_speed))
      refuse_robot(keys.description(), {fault}, diagnostics_);
  }
}

void RobotReader::refuse_same_name(const YamlNode& node, const RobotKeys& keys) {
  if (keys.name.empty()) return;
  if (const auto [same, is_new] = names_.emplace(keys.name, node.line); !is_new) {
    diagnostics_.add(*keys.name_node,
                     fmt::format("found the robot name '{}' again; expected it once (first in line "
                                 "{})",
                                 keys.name, same->second));
  }
}

// Poses and joint states could not distinguish two links or joints of one name.
bool RobotReader::has_names_of_its_own(const RobotKeys& keys, const RobotModel& model) {
  const auto take = [&](std::set<std::string>& taken, const std::string& name, const char* what) {
    if (taken.insert(name).second) return true;
    diagnostics_.add(*keys.name_node,
                     fmt::format("found the {} '{}' of '{}', which another robot has as well; "
                                 "expected another prefix for each",
                                 what, name, keys.name));
    return false;
  };
  for (const RobotLink& link : model.robot.links) {
    if (!take(links_, link.name, "link")) return false;
  }
  for (const JointVariable& variable : model.variables) {
    if (!take(variables_, variable.name, "joint")) return false;
  }
  return true;
}

// Joints are sorted so that a parent link precedes its children: whether it moves is then known.
void RobotReader::add_links(const RobotKeys& keys, const RobotDescription& description,
                            const Membership& membership, Robot& robot) {
  std::map<std::string, const UrdfLink*> written;
  for (const UrdfLink& link : description.robot.links) written[keys.prefix + link.name] = &link;
  LinkParts parts({description.urdf, keys.packages, revision_.root()}, keys.description(), shapes_,
                  keys.limits.mesh_limits, diagnostics_);
  for (std::uint32_t i = 0; i < robot.links.size(); ++i) {
    RobotLink& link = robot.links[i];
    if (i == 0) {
      if (robot.base.kind == RobotBase::Kind::kWorld)
        at_rest_[link.name] = robot.base.base_from_root;
    } else if (const RobotJoint& joint = robot.joints[i - 1]; joint.type == JointType::kFixed) {
      const auto parent = at_rest_.find(robot.links[joint.parent].name);
      if (parent != at_rest_.end())
        at_rest_[link.name] = compose(parent->second, joint.parent_from_joint);
    }
    const auto description_of = written.find(link.name);
    if (description_of == written.end() || description_of->second->collisions.empty()) continue;
    YamlNode name = *keys.name_node;
    name.text = link.name;
    name.quoted = true;
    static_cast<void>(read_name(name, "the name of a link with its prefix", diagnostics_));
    Object object;
    object.name = link.name;
    object.groups = membership.groups;
    object.absent = membership.absent;
    object.margin = keys.limits.margin;
    if (keys.person_node != nullptr) {
      object.shape_error = keys.person.error;
      object.approach_speed = approach_speed_of(link.name);
    }
    if (const double error = parts.add(*description_of->second, object); error > 0.0) {
      objects_.mesh_errors[object.name] = error;
    }
    if (const auto place = at_rest_.find(link.name); place != at_rest_.end()) {
      object.fixed = true;
      object.world_from_object = place->second;
      object.max_speed = 0.0;
    } else {
      object.age_limit_ns = keys.limits.age_limit_ns;
      object.may_jump = keys.limits.may_jump;
      object.source = keys.limits.source;
    }
    link.object = static_cast<std::uint32_t>(objects_.objects.size());
    if (membership.carrier) objects_.attachments.push_back({link.object, *membership.carrier});
    objects_.objects.push_back(std::move(object));
    objects_.places.push_back(keys.name_node);
  }
}

// Descriptions name pairs that may touch by links, without the prefix.
void RobotReader::allow(const RobotKeys& keys, const RobotDescription& description, Robot& robot,
                        PairExceptions& may_touch) {
  LinkNames shaped, fixed;
  std::map<std::string, std::uint32_t> objects;
  for (const RobotLink& link : robot.links) {
    const std::string name = link.name.substr(keys.prefix.size());
    if (at_rest_.contains(link.name)) fixed.insert(name);
    if (link.object == RobotLink::kNoObject) continue;
    shaped.insert(name);
    objects[name] = link.object;
  }
  note_visuals(description.robot, robot.notes);
  if (description.srdf && !description.srdf->moving_base.empty() && keys.base_node == nullptr) {
    robot.notes.push_back(
        fmt::format("the base stands still, though the SRDF lets it move ({}): if it does, state "
                    "base: {{frame: NAME}}, or pose if it does not",
                    description.srdf->moving_base));
  }
  std::vector<std::string> expected;  // not shown: a person has no SRDF
  std::vector<std::string>& notes = keys.person_node != nullptr ? expected : robot.notes;
  const std::vector<SrdfDisabled> pairs =
      description.srdf ? exceptions_of(*description.srdf, shaped, fixed, robot.notes)
                       : neighbours_of(description.robot, shaped, fixed, notes);
  for (const SrdfDisabled& pair : pairs) {
    may_touch.emplace_back(pair_key(objects[pair.link_a], objects[pair.link_b]),
                           keys.name_node->line);
  }
}

// Adds the rounding of forward kinematics to the errors of the links of the robot that was read
// last. Fixed links have none: they are exactly where the cell places them.
void RobotReader::account_for_rounding(const RobotList& list) {
  const std::vector<ChainError> errors = chain_rounding(list.robots, list.variables);
  const std::vector<RobotLink>& links = list.robots.back().links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].object == RobotLink::kNoObject) continue;
    Object& object = objects_.objects[links[i].object];
    if (!object.fixed) account_for(errors[i], object);
  }
}

// Near a posture where two axes of a shoulder are one, as with arms down, its angles may leap. A
// body turns and runs faster than the base of a robot.
void move_as_people(const Robot& person, std::uint32_t first,
                    std::vector<JointVariable>& variables) {
  constexpr double kLeap = 1e5;                // rad/s: a turn in a tenth of a millisecond
  constexpr double kRun = 12.0, kTurn = 30.0;  // m/s, rad/s
  constexpr std::uint32_t kFirstOfQuaternion = 3;
  for (std::uint32_t i = first; i < variables.size(); ++i) {
    const bool is_place = i - variables[i].first_of_joint < kFirstOfQuaternion;
    variables[i].unstated_speed = !person.is_of_base(i) ? kLeap : is_place ? kRun : 0.5 * kTurn;
  }
}

StatedBase RobotReader::read_base(const RobotKeys& keys, const RobotList& list) {
  StatedBase stated;
  if (keys.base_node != nullptr) {
    stated = read_robot_base(*keys.base_node, list.robots, at_rest_, objects_, quantities_);
  }
  if (keys.attached_node != nullptr) {
    stated.base =
        read_robot_attachment(*keys.attached_node, list.robots, at_rest_, objects_, quantities_);
  }
  if (keys.person_node != nullptr && !stated.base.frame.empty()) {
    diagnostics_.add(*keys.base_node,
                     "found 'frame' of a person's base; expected none: its frame is body_ID");
  }
  if (keys.person_node != nullptr && keys.base_node == nullptr) {
    stated.base.frame = "body_" + body_name(keys.person.id, keys.name);
  }
  return stated;
}

bool RobotReader::read(const YamlNode& node, RobotList& list) {
  const RobotKeys keys =
      read_robot_keys(node, defaults_, {file_.parent_path(), revision_.root()}, quantities_);
  refuse_same_name(node, keys);
  auto description = read_description(
      {.urdf = keys.urdf_node,
       .srdf = keys.srdf_node,
       .files = {file_, keys.packages, revision_.root()},
       .prefix = keys.prefix,
       .visual_as_collision = keys.visual_as_collision,
       .person = {keys.person_node, keys.name, keys.person.stature, keys.person.id}},
      diagnostics_, revision_);
  const StatedBase stated = read_base(keys, list);
  const RobotBase& base = stated.base;
  Robot robot;
  if (description) {
    if (!base.frame.empty()) float_root(description->model, keys.prefix, keys.name);
    robot = std::move(description->model.robot);
  }
  robot.base = base;
  robot.name = keys.name;
  robot.prefix = keys.prefix;
  robot.joint_states = keys.joint_states;
  robot.stamps = keys.stamps;
  robot.mass = keys.mass;
  if (keys.person_node != nullptr) robot.person = Person{keys.person.id};
  if (!description || keys.name.empty()) return false;
  if (!has_names_of_its_own(keys, {robot, description->model.variables})) return false;
  Membership membership =
      keys.attached_node == nullptr
          ? Membership{.groups = {keys.name}, .carrier = {}, .absent = keys.absent}
          : membership_of({keys.name, keys.absent}, base, list.robots, memberships_, objects_);
  if (!keys.groups.empty()) objects_.optional_groups.insert(keys.name);
  for (const std::string& group : keys.groups)
    if (std::ranges::find(membership.groups, group) == membership.groups.end())
      membership.groups.push_back(group);
  const auto first = static_cast<std::uint32_t>(list.variables.size());
  std::vector<JointVariable>& variables = description->model.variables;
  for (JointVariable& variable : variables) {
    variable.age_limit_ns = keys.limits.age_limit_ns;
    variable.source = keys.limits.source;
    variable.frozen_limit_ns = keys.frozen_limit_ns;
    variable.robot = static_cast<std::uint32_t>(list.robots.size());
    variable.is_read = !membership.absent;
  }
  if (!base.frame.empty()) limit_base(stated, variables);
  if (keys.joints_node != nullptr)
    read_joints(*keys.joints_node, keys.prefix, quantities_, variables);
  refuse_without_speed(keys, description->model);
  list.variables.insert(list.variables.end(), variables.begin(), variables.end());
  for (RobotJoint& joint : robot.joints) joint.variable += first;
  set_plausible_motion(robot, list.variables);
  if (robot.person) move_as_people(robot, first, list.variables);
  if (keys.joints_node != nullptr) {
    refuse_positions_outside(*keys.joints_node, std::span(list.variables).subspan(first),
                             diagnostics_);
  }
  if (keys.stopping_node != nullptr)
    read_stopping(*keys.stopping_node, file_, quantities_, revision_, list.variables, robot);
  add_links(keys, *description, membership, robot);
  allow(keys, *description, robot, list.may_touch);
  if (keys.combined_node != nullptr) {
    read_combined_srdfs(*keys.combined_node, {file_, keys.packages, revision_.root()}, list.robots,
                        keys.name_node->line, robot, list.may_touch, diagnostics_, revision_);
  }
  memberships_.push_back(membership);
  list.robots.push_back(std::move(robot));
  account_for_rounding(list);
  return true;
}

}  // namespace

RobotList read_robots(const YamlNode& node, const std::filesystem::path& file,
                      const ObjectDefaults& defaults, const Quantities& quantities,
                      ShapeReader& shapes, Revision& revision, ObjectList& objects) {
  RobotList list;
  RobotReader reader(file, defaults, quantities, shapes, revision, objects);
  const std::vector<YamlNode>& items = read_list(node, "robots", quantities.diagnostics());
  if (items.empty()) objects.names_known = false;
  if (node.kind == YamlNode::Kind::kSequence && items.empty()) {
    quantities.diagnostics().add(node, "found an empty list; expected at least one robot");
  }
  for (const YamlNode& item : items) {
    objects.names_known = reader.read(item, list) && objects.names_known;
    if (objects.objects.size() <= kMaxObjects) continue;
    quantities.diagnostics().add(
        item,
        fmt::format("found {} objects with the links of this robot; expected at most {}, which "
                    "is what a report can carry",
                    objects.objects.size(), kMaxObjects));
    break;
  }
  list.at_rest = reader.take_at_rest();
  return list;
}

}  // namespace clearance
