// Links are put in an order in which parents come first. Then each joint is made from the elements
// that its type needs. Mimic joints are resolved last, when every joint has its variable.
#include "config/urdf/robot_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/urdf/robot_files.hpp"
#include "core/model/rotation_between.hpp"

namespace clearance {
namespace {

const std::array<std::string, 6> kTypes = {"fixed",     "revolute", "continuous",
                                           "prismatic", "planar",   "floating"};  // as JointType

// The names of MoveIt.
constexpr std::array<std::string_view, 3> kPlanar = {"/x", "/y", "/theta"};
constexpr std::array<std::string_view, 7> kFloating = {"/trans_x", "/trans_y", "/trans_z", "/rot_x",
                                                       "/rot_y",   "/rot_z",   "/rot_w"};

std::string_view suffix(JointType type, std::size_t variable) {
  if (type == JointType::kPlanar) return kPlanar[variable];
  return type == JointType::kFloating ? kFloating[variable] : "";
}

class ModelBuilder {
 public:
  ModelBuilder(const UrdfRobot& description, const std::filesystem::path& urdf,
               const std::string& prefix)
      : description_(description), urdf_(urdf), prefix_(prefix) {}

  std::variant<RobotModel, UrdfFaults> build();

 private:
  std::optional<std::string> root();
  void order_links(const std::string& root);
  void add_joint(const UrdfJoint& joint, std::uint32_t parent);
  void read_axis(const UrdfJoint& joint, RobotJoint& made);
  void add_variables(const UrdfJoint& joint, RobotJoint& made);
  void read_limits(const UrdfJoint& joint, JointVariable& variable);
  void resolve_mimics();
  bool follow(const UrdfJoint& mimic, RobotJoint& made);
  void refuse(UrdfPlace place, const std::string& text);

  const UrdfRobot& description_;
  const std::filesystem::path& urdf_;
  const std::string& prefix_;
  RobotModel model_;
  std::vector<const UrdfJoint*> written_;  // as model_.robot.joints
  std::map<std::string, const UrdfJoint*> by_name_;
  std::map<std::string, std::uint32_t> variables_;  // first one, by name of the joint
  UrdfFaults faults_;
};

void ModelBuilder::refuse(UrdfPlace place, const std::string& text) {
  faults_.push_back(fault_at(urdf_.string(), place, text));
}

// Returns the link that no joint carries.
std::optional<std::string> ModelBuilder::root() {
  std::set<std::string> carried;
  for (const UrdfJoint& joint : description_.joints) carried.insert(joint.child);
  std::optional<std::string> found;
  for (const UrdfLink& link : description_.links) {
    if (carried.contains(link.name)) continue;
    if (found) {
      refuse({1, 1},
             fmt::format("found the links '{}' and '{}', which no joint carries; expected one "
                         "root",
                         *found, link.name));
      return std::nullopt;
    }
    found = link.name;
  }
  return found;
}

// Goes from the root outwards. The URDF is a tree: every link is met once.
void ModelBuilder::order_links(const std::string& root) {
  std::map<std::string, std::vector<const UrdfJoint*>> below;
  for (const UrdfJoint& joint : description_.joints) below[joint.parent].push_back(&joint);
  std::vector<std::string> order = {root};
  model_.robot.links.push_back({prefix_ + root});
  for (std::uint32_t parent = 0; parent < order.size(); ++parent) {
    for (const UrdfJoint* joint : below[order[parent]]) {
      order.push_back(joint->child);
      model_.robot.links.push_back({prefix_ + joint->child});
      add_joint(*joint, parent);
    }
  }
}

// A joint of an unknown type counts as fixed until the fault is reported.
void ModelBuilder::add_joint(const UrdfJoint& joint, std::uint32_t parent) {
  RobotJoint made{.name = prefix_ + joint.name,
                  .parent = parent,
                  .parent_from_joint = pose_of(joint.parent_from_child)};
  if (const auto found = std::ranges::find(kTypes, joint.type); found != kTypes.end()) {
    made.type = static_cast<JointType>(found - kTypes.begin());
  } else {
    refuse(joint.place, fmt::format("found a joint of type '{}'; expected {}{}", joint.type,
                                    one_of(kTypes), did_you_mean(joint.type, kTypes)));
  }
  if (made.type != JointType::kFixed) {
    if (joint.name.empty()) {
      refuse(joint.place,
             "found a joint that moves without a name; expected one, by which joint "
             "states name it");
    } else if (!by_name_.emplace(joint.name, &joint).second) {
      refuse(joint.place, fmt::format("found the joint '{}' again", joint.name));
    }
    read_axis(joint, made);
    if (!joint.mimic) add_variables(joint, made);
  }
  written_.push_back(&joint);
  model_.robot.joints.push_back(made);
}

// URDF's default axis is x, but MoveIt takes the plane of a planar joint to be x y: the file has to
// state the normal.
void ModelBuilder::read_axis(const UrdfJoint& joint, RobotJoint& made) {
  if (made.type == JointType::kFloating) return;
  if (made.type == JointType::kPlanar && !joint.axis) {
    refuse(joint.place,
           fmt::format("found the planar joint '{}' without <axis>; expected the normal "
                       "of its plane",
                       joint.name));
  }
  const Vec3 axis = joint.axis.value_or(Vec3::UnitX());
  if (axis.isZero(0.0)) {
    refuse(joint.place,
           fmt::format("found the axis 0 0 0 of the joint '{}'; expected a direction", joint.name));
    return;
  }
  made.axis = unit_along(axis);
  const auto turn = rotation_between(Vec3::UnitZ(), made.axis);
  made.plane_x = turn * Vec3::UnitX();
  made.plane_y = turn * Vec3::UnitY();
}

void ModelBuilder::add_variables(const UrdfJoint& joint, RobotJoint& made) {
  made.variable = static_cast<std::uint32_t>(model_.variables.size());
  variables_[joint.name] = made.variable;
  for (std::size_t i = 0; i < variables_of(made.type); ++i) {
    model_.variables.emplace_back().name = made.name + std::string(suffix(made.type, i));
  }
  // Limits of joints with several variables have no meaning in URDF.
  if (variables_of(made.type) == 1) read_limits(joint, model_.variables.back());
}

// Many files state a velocity of 0 where the limit is not known: it counts as none.
void ModelBuilder::read_limits(const UrdfJoint& joint, JointVariable& variable) {
  const bool bounded = joint.type == "revolute" || joint.type == "prismatic";
  if (!joint.limit) {
    if (bounded) {
      refuse(joint.place, fmt::format("found the {} joint '{}' without <limit>; expected its lower "
                                      "and upper limit",
                                      joint.type, joint.name));
    }
    return;
  }
  if (bounded) {
    variable.lower = joint.limit->lower;
    variable.upper = joint.limit->upper;
    if (!(variable.lower <= variable.upper)) {
      refuse(joint.place, fmt::format("found limits from {} to {} of the joint '{}'; expected the "
                                      "lower one first",
                                      variable.lower, variable.upper, joint.name));
    }
  }
  if (joint.limit->acceleration > 0.0) variable.urdf_acceleration = joint.limit->acceleration;
  if (joint.limit->deceleration > 0.0) variable.urdf_deceleration = joint.limit->deceleration;
  const double velocity = joint.limit->velocity.value_or(0.0);
  if (velocity < 0.0) {
    model_.without_speed.emplace_back(
        variable.name,
        fault_at(urdf_.string(), joint.place,
                 fmt::format("found a velocity limit of {} of the joint '{}'; expected a positive "
                             "one, here or in a cell: joints: {{{}: {{velocity: 1.5}}}}",
                             velocity, joint.name, joint.name)));
  } else if (velocity > 0.0) {
    variable.max_speed = velocity;
  } else {
    model_.robot.notes.push_back(fmt::format(
        "the joint '{}' states no velocity limit: what it carries is unknown when it is late",
        variable.name));
  }
}

// One mimic joint may follow another; the last in the chain has the variable.
bool ModelBuilder::follow(const UrdfJoint& mimic, RobotJoint& made) {
  const UrdfJoint* at = &mimic;
  for (std::size_t steps = 0; at->mimic; ++steps) {
    const auto next = by_name_.find(at->mimic->joint);
    if (next == by_name_.end() || steps > by_name_.size()) return false;
    made.offset += made.multiplier * at->mimic->offset;
    made.multiplier *= at->mimic->multiplier;
    at = next->second;
  }
  made.variable = variables_[at->name];
  return at->type != "planar" && at->type != "floating" && variables_of(made.type) == 1;
}

void ModelBuilder::resolve_mimics() {
  for (std::size_t i = 0; i < written_.size(); ++i) {
    RobotJoint& made = model_.robot.joints[i];
    if (!written_[i]->mimic || made.type == JointType::kFixed) continue;
    if (!follow(*written_[i], made)) {
      refuse(written_[i]->place,
             fmt::format("found the joint '{}' that mimics '{}'; expected a moving joint with one "
                         "position, that does not follow this one",
                         written_[i]->name, written_[i]->mimic->joint));
    }
  }
}

std::variant<RobotModel, UrdfFaults> ModelBuilder::build() {
  model_.robot.name = description_.name;
  model_.robot.notes = description_.notes;
  if (const auto name = root()) {
    order_links(*name);
    resolve_mimics();
  } else if (faults_.empty()) {
    refuse({1, 1}, "found no link that no joint carries; expected a root");
  }
  if (faults_.empty()) return std::move(model_);
  sort_by_place(faults_);
  return faults_;
}

}  // namespace

std::variant<RobotModel, UrdfFaults> robot_model(const UrdfRobot& description,
                                                 const std::filesystem::path& urdf,
                                                 const std::string& prefix) {
  return ModelBuilder(description, urdf, prefix).build();
}

void float_root(RobotModel& model, const std::string& prefix, const std::string& name) {
  constexpr std::uint32_t kAdded = variables_of(JointType::kFloating);
  RobotJoint joint;
  joint.name = prefix + name + "_base";
  joint.type = JointType::kFloating;
  for (RobotJoint& below : model.robot.joints) {
    ++below.parent;
    below.variable += kAdded;
  }
  model.robot.links.insert(model.robot.links.begin(), {prefix + name + "_world"});
  model.robot.joints.insert(model.robot.joints.begin(), joint);
  std::vector<JointVariable> added(kAdded);
  for (std::uint32_t i = 0; i < kAdded; ++i) {
    added[i].name = joint.name + std::string(suffix(JointType::kFloating, i));
    added[i].velocity_is_difference = true;
  }
  model.variables.insert(model.variables.begin(), added.begin(), added.end());
}

}  // namespace clearance
