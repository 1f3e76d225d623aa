#include "config/cell/robot_base_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "config/cell/ros_reader.hpp"
#include "config/scene/source_name.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/map_reader.hpp"

namespace clearance {
namespace {

class BaseReader {
 public:
  BaseReader(const std::vector<Robot>& robots, const PosesAtRest& at_rest,
             const ObjectList& objects, const Quantities& quantities)
      : robots_(robots),
        at_rest_(at_rest),
        objects_(objects),
        quantities_(quantities),
        diagnostics_(quantities.diagnostics()) {}

  StatedBase read(const YamlNode& node);

 private:
  void read_limits(MapReader& map, StatedBase& stated);

  const std::vector<Robot>& robots_;
  const PosesAtRest& at_rest_;
  const ObjectList& objects_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
};

StatedBase BaseReader::read(const YamlNode& node) {
  StatedBase stated;
  RobotBase& base = stated.base;
  MapReader map(node, "a robot's base", diagnostics_);
  Pose pose;
  if (const YamlNode* given = map.optional("pose"))
    pose = quantities_.pose(*given).value_or(Pose{});
  const YamlNode* on = map.optional("on");
  const YamlNode* frame = map.optional("frame");
  if (frame != nullptr) {
    base.frame = read_frame(*frame, diagnostics_).value_or("");
    base.frame_from_root = pose;
    if (on != nullptr) {
      diagnostics_.add(*on, "found 'on' of a base that follows a frame; expected one of the two");
    }
    read_limits(map, stated);
  } else {
    base.base_from_root = pose;
    if (on != nullptr) {
      read_what_carries(*on, robots_, at_rest_, objects_,
                        "an object, or a link of a robot that stands before this one", diagnostics_,
                        base);
    }
  }
  map.refuse_unknown_keys();
  return stated;
}

// Reads the keys that apply to a base that follows a frame of tf.
void BaseReader::read_limits(MapReader& map, StatedBase& stated) {
  if (const YamlNode* age = map.optional("age_limit_ms")) {
    stated.limits.age_limit_ns =
        quantities_.milliseconds(*age, "the age limit", kPositive).value_or(0);
  }
  if (const YamlNode* frozen = map.optional("frozen_limit_ms")) {
    stated.limits.frozen_limit_ns =
        quantities_.milliseconds(*frozen, "the frozen limit", kPositive).value_or(0);
  }
  if (const YamlNode* speed = map.optional("max_speed")) {
    stated.limits.max_speed =
        quantities_.speed(*speed, "the largest speed of the base").value_or(kInfinity);
  }
  if (const YamlNode* speed = map.optional("max_turn_speed")) {
    stated.max_turn_speed =
        quantities_.turn_speed(*speed, "the largest turning speed of the base").value_or(kInfinity);
  }
  if (const YamlNode* source = map.optional("source")) {
    stated.limits.source = read_source(*source, diagnostics_).value_or("");
  }
}

}  // namespace

void read_what_carries(const YamlNode& node, const std::vector<Robot>& robots,
                       const PosesAtRest& at_rest, const ObjectList& objects,
                       const std::string& expected, Diagnostics& diagnostics, RobotBase& base) {
  const auto name = read_name(node, "an object, or a link of a robot", diagnostics);
  if (!name) return;
  std::vector<std::string> names;
  for (std::uint32_t robot = 0; robot < robots.size(); ++robot) {
    const std::vector<RobotLink>& links = robots[robot].links;
    for (std::uint32_t link = 0; link < links.size(); ++link) {
      names.push_back(links[link].name);
      if (links[link].name != *name) continue;
      const auto place = at_rest.find(*name);
      if (place != at_rest.end()) {
        base.base_from_root = compose(place->second, base.base_from_root);
        base.resting_on = {.kind = RestingOn::Kind::kLink, .robot = robot, .link = link};
      } else {
        base.kind = RobotBase::Kind::kLink;
      }
      base.robot = robot;
      base.link = link;
      return;
    }
  }
  for (std::uint32_t i = 0; i < objects.objects.size(); ++i) {
    const Object& object = objects.objects[i];
    if (object.is_seen()) continue;  // it has no place
    names.push_back(object.name);
    if (object.name != *name) continue;
    if (object.fixed) {
      base.base_from_root = compose(object.world_from_object, base.base_from_root);
      base.resting_on = {.kind = RestingOn::Kind::kObject, .object = i};
    } else {
      base.kind = RobotBase::Kind::kObject;
      base.object = i;
    }
    return;
  }
  if (std::ranges::any_of(objects.stated, [&](const StatedAttachment& stated) {
        return stated.object.name == *name;
      })) {
    diagnostics.add(node, fmt::format("found the attached object '{}'; expected an object that is "
                                      "not attached, or the carrier of this one",
                                      *name));
    return;
  }
  if (!objects.names_known) return;
  diagnostics.add(node, fmt::format("found the unknown name '{}'; expected {}{}", *name, expected,
                                    did_you_mean(*name, names)));
}

StatedBase read_robot_base(const YamlNode& node, const std::vector<Robot>& robots,
                           const PosesAtRest& at_rest, const ObjectList& objects,
                           const Quantities& quantities) {
  return BaseReader(robots, at_rest, objects, quantities).read(node);
}

RobotBase read_robot_attachment(const YamlNode& node, const std::vector<Robot>& robots,
                                const PosesAtRest& at_rest, const ObjectList& objects,
                                const Quantities& quantities) {
  RobotBase base;
  MapReader map(node, "what a robot is attached to", quantities.diagnostics());
  const YamlNode* to = map.required("to");
  if (const YamlNode* pose = map.optional("pose"))
    base.base_from_root = quantities.pose(*pose).value_or(Pose{});
  map.refuse_unknown_keys();
  if (to != nullptr) {
    read_what_carries(*to, robots, at_rest, objects,
                      "a link of a robot that stands before this one, or an object",
                      quantities.diagnostics(), base);
  }
  return base;
}

void limit_base(const StatedBase& stated, std::vector<JointVariable>& variables) {
  constexpr std::uint32_t kFirstOfQuaternion = 3;
  // The root swings about the frame's origin.
  const double arm = stated.base.frame_from_root.position.norm();
  const double swings = arm == 0.0 ? 0.0 : (1.0 + 0x1p-50) * arm * stated.max_turn_speed;
  for (std::uint32_t i = 0; i < variables_of(JointType::kFloating); ++i) {
    JointVariable& variable = variables[i];
    variable.source = stated.limits.source.empty() ? "" : base_source(stated.limits.source);
    if (stated.limits.age_limit_ns > 0) variable.age_limit_ns = stated.limits.age_limit_ns;
    variable.frozen_limit_ns = stated.limits.frozen_limit_ns;
    variable.speed_tolerance = 1.0;
    variable.max_speed =
        i < kFirstOfQuaternion ? stated.limits.max_speed + swings : 0.5 * stated.max_turn_speed;
  }
}

}  // namespace clearance
