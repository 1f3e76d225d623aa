// A mistake is kept with its place and the reading goes on, so that one run finds all of them. Only
// XML that cannot be parsed, or that xacro has to expand first, ends it.
#include "config/urdf/urdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "config/text/printable.hpp"
#include "config/urdf/shape_element.hpp"
#include "config/urdf/xml_reader.hpp"

namespace clearance {
namespace {

using tinyxml2::XMLElement;

// A robot without shapes would give a cell that watches nothing, and is refused.
void read_links(XmlReader& xml, std::span<const std::string> visual_as_collision, UrdfOf of,
                UrdfRobot& robot) {
  std::set<std::string> names;
  bool any_shape = false;
  for (const XMLElement* at : xml.children(*xml.root(), "link")) {
    UrdfLink link{xml.attribute(*at, "name"), {}};
    if (!link.name.empty() && !names.insert(link.name).second)
      xml.report(*at, fmt::format("found the link '{}' again", link.name));
    const auto read = [&](const char* kind) {
      for (const XMLElement* part : xml.children(*at, kind)) {
        any_shape = true;
        if (auto shape = read_shape(xml, *part, link.name, robot.notes))
          link.collisions.push_back(std::move(*shape));
      }
    };
    read("collision");
    link.has_collision = at->FirstChildElement("collision") != nullptr;
    link.has_visual = at->FirstChildElement("visual") != nullptr;
    if (!link.has_collision &&
        std::ranges::find(visual_as_collision, link.name) != visual_as_collision.end()) {
      read("visual");
    }
    robot.links.push_back(std::move(link));
  }
  if (!any_shape && of == UrdfOf::kRobot) {
    xml.report(
        *xml.root(),
        "found no link with a collision shape; expected a robot to keep apart (a cell can take "
        "visual shapes: visual_as_collision: [...])");
  }
}

// Attributes that may be absent keep their defaults.
void read_number(XmlReader& xml, const XMLElement& element, const char* name, double& value) {
  if (xml.optional(element, name) != nullptr) value = xml.number(element, name);
}

// Limits of URDF 1.2. Nothing depends on the jerk, which has to be a number.
void read_dynamic_limits(XmlReader& xml, const XMLElement& limit, UrdfLimit& limits) {
  double jerk = 0.0;
  read_number(xml, limit, "acceleration", limits.acceleration);
  read_number(xml, limit, "deceleration", limits.deceleration);
  read_number(xml, limit, "jerk", jerk);
}

// A fixed joint has no axis and no position: what is said of them is not read.
UrdfJoint read_joint(XmlReader& xml, const XMLElement& element) {
  UrdfJoint joint{.type = xml.attribute(element, "type"),
                  .parent = xml.attribute_of_child(element, "parent", "link"),
                  .child = xml.attribute_of_child(element, "child", "link"),
                  .parent_from_child = xml.origin(element),
                  .place = xml.place_of(element)};
  if (const char* name = xml.optional(element, "name")) joint.name = name;
  if (joint.type == "fixed") return joint;
  if (const XMLElement* axis = xml.optional_child(element, "axis")) {
    joint.axis = xml.vector(*axis, "xyz");
  }
  if (const XMLElement* limit = xml.optional_child(element, "limit")) {
    UrdfLimit& limits = joint.limit.emplace();
    read_number(xml, *limit, "lower", limits.lower);
    read_number(xml, *limit, "upper", limits.upper);
    if (xml.optional(*limit, "velocity") != nullptr)
      limits.velocity = xml.number(*limit, "velocity");
    read_dynamic_limits(xml, *limit, limits);
  }
  if (const XMLElement* mimic = xml.optional_child(element, "mimic")) {
    UrdfMimic& follows = joint.mimic.emplace();
    follows.joint = xml.attribute(*mimic, "joint");
    read_number(xml, *mimic, "multiplier", follows.multiplier);
    read_number(xml, *mimic, "offset", follows.offset);
  }
  return joint;
}

// Tells whether this joint would make its child an ancestor of itself; the joints before it form
// trees.
bool closes_loop(const UrdfJoint& joint, const std::map<std::string, std::string>& parents) {
  std::string at = joint.parent;
  for (auto found = parents.find(at); at != joint.child; found = parents.find(at)) {
    if (found == parents.end()) return false;
    at = found->second;
  }
  return true;
}

// The joints must make a tree, in which every link has at most one parent.
void read_joints(XmlReader& xml, UrdfRobot& robot) {
  std::set<std::string> names;
  for (const UrdfLink& link : robot.links) names.insert(link.name);
  std::map<std::string, std::string> parents;  // by child
  for (const XMLElement* at : xml.children(*xml.root(), "joint")) {
    const UrdfJoint joint = read_joint(xml, *at);
    bool known = true;
    for (const std::string& link : {joint.parent, joint.child}) {
      known = known && !link.empty();
      if (link.empty() || names.contains(link)) continue;
      known = false;
      xml.report(*at, fmt::format("found a joint of the link '{}', which does not exist", link));
    }
    if (!known) continue;
    if (parents.contains(joint.child)) {
      xml.report(
          *at, fmt::format("found a second parent of the link '{}'; expected a tree", joint.child));
    } else if (closes_loop(joint, parents)) {
      xml.report(*at, fmt::format("found the link '{}' among its own parents; expected a tree",
                                  joint.child));
    } else {
      parents[joint.child] = joint.parent;
      robot.joints.push_back(joint);
    }
  }
}

// Reads the pairs of one kind of element. The reason is optional in an SRDF but required in a cell.
std::vector<SrdfDisabled> read_pairs_of(XmlReader& xml, const char* name) {
  std::vector<SrdfDisabled> pairs;
  for (const XMLElement* at : xml.children(*xml.root(), name)) {
    const char* reason = xml.optional(*at, "reason");
    const std::string link_a = xml.attribute(*at, "link1");
    pairs.push_back({link_a, xml.attribute(*at, "link2"),
                     reason == nullptr || *reason == '\0' ? "disabled in the SRDF" : reason,
                     xml.place_of(*at)});
  }
  return pairs;
}

// Returns the value, or, where the file has faults, all of them by place.
template <class Value>
std::variant<Value, UrdfFaults> value_or_faults(Value value, XmlReader& xml,
                                                const XmlFormat& format) {
  if (xml.root() != nullptr) {
    if (const std::string note = xml.account_for_the_rest(format); !note.empty())
      value.notes.push_back(note);
  }
  UrdfFaults faults = xml.faults();
  if (faults.empty()) return value;
  sort_by_place(faults);
  return faults;
}

}  // namespace

UrdfFault fault_at(const std::string& file, UrdfPlace place, const std::string& text) {
  return {place, fmt::format("{}:{}:{}: {}", file, place.line, place.column, excerpt(text))};
}

void sort_by_place(UrdfFaults& faults) {
  std::ranges::stable_sort(faults, {}, [](const UrdfFault& fault) {
    return std::pair(fault.place.line, fault.place.column);
  });
}

std::variant<UrdfRobot, UrdfFaults> read_urdf(const std::filesystem::path& file,
                                              std::span<const std::string> visual_as_collision,
                                              UrdfOf of) {
  XmlReader xml(file);
  UrdfRobot robot;
  if (xml.root() != nullptr) {
    xml.read_version();
    robot.name = xml.attribute(*xml.root(), "name");
    read_links(xml, visual_as_collision, of, robot);
    read_joints(xml, robot);
  }
  return value_or_faults(std::move(robot), xml, urdf_format());
}

std::variant<Srdf, UrdfFaults> read_srdf(const std::filesystem::path& file) {
  XmlReader xml(file);
  Srdf srdf;
  if (xml.root() != nullptr) {
    srdf.robot = xml.attribute(*xml.root(), "name");
    srdf.place = xml.place_of(*xml.root());
    srdf.disabled = read_pairs_of(xml, "disable_collisions");
    srdf.enabled = read_pairs_of(xml, "enable_collisions");
    for (const XMLElement* at : xml.children(*xml.root(), "disable_default_collisions"))
      srdf.disabled_by_default.push_back({xml.attribute(*at, "link"), xml.place_of(*at)});
    for (const XMLElement* at : xml.children(*xml.root(), "virtual_joint")) {
      const char* const type = xml.optional(*at, "type");
      const char* const frame = xml.optional(*at, "parent_frame");
      const std::string_view kind = type == nullptr ? "" : type;
      if (kind == "planar" || kind == "floating")
        srdf.moving_base = fmt::format("{} in frame '{}'", kind, frame == nullptr ? "" : frame);
    }
  }
  return value_or_faults(std::move(srdf), xml, srdf_format());
}

}  // namespace clearance
