// Reads the XML elements that a cell needs and ignores the others (visual, inertial, transmission).
// A mistake is kept with its line and the reading goes on, so that one run finds all of them. Only
// XML that cannot be parsed, or that xacro has to expand first, ends it.
#include "config/urdf/urdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "config/urdf/shape_element.hpp"
#include "config/urdf/xml_reader.hpp"

namespace clearance {
namespace {

using tinyxml2::XMLElement;

// A robot without shapes would give a cell that watches nothing, and is refused.
void read_links(XmlReader& xml, UrdfRobot& robot) {
  std::set<std::string> names;
  bool any_shape = false;
  for (const XMLElement* at : children(*xml.root(), "link")) {
    UrdfLink link{xml.attribute(*at, "name"), {}};
    if (!link.name.empty() && !names.insert(link.name).second)
      xml.report(*at, fmt::format("found the link '{}' again", link.name));
    for (const XMLElement* part : children(*at, "collision")) {
      link.collisions.push_back(read_shape(xml, *part));
    }
    any_shape = any_shape || !link.collisions.empty();
    robot.links.push_back(std::move(link));
  }
  if (!any_shape) {
    xml.report(*xml.root(), "found no link with a collision shape; expected a robot to keep apart");
  }
}

// Attributes that may be absent keep their defaults.
void read_number(XmlReader& xml, const XMLElement& element, const char* name, double& value) {
  if (element.Attribute(name) != nullptr) value = xml.number(element, name);
}

// Reads the whole element, whatever its type needs.
UrdfJoint read_joint(XmlReader& xml, const XMLElement& element) {
  UrdfJoint joint{.type = xml.attribute(element, "type"),
                  .parent = xml.attribute_of_child(element, "parent", "link"),
                  .child = xml.attribute_of_child(element, "child", "link"),
                  .parent_from_child = xml.origin(element),
                  .line = element.GetLineNum()};
  if (const char* name = element.Attribute("name")) joint.name = name;
  if (const XMLElement* axis = element.FirstChildElement("axis")) {
    joint.axis = xml.vector(*axis, "xyz");
  }
  if (const XMLElement* limit = element.FirstChildElement("limit")) {
    UrdfLimit& limits = joint.limit.emplace();
    read_number(xml, *limit, "lower", limits.lower);
    read_number(xml, *limit, "upper", limits.upper);
    if (limit->Attribute("velocity") != nullptr) limits.velocity = xml.number(*limit, "velocity");
  }
  if (const XMLElement* mimic = element.FirstChildElement("mimic")) {
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
  for (const XMLElement* at : children(*xml.root(), "joint")) {
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
  for (const XMLElement* at : children(*xml.root(), name)) {
    const char* reason = at->Attribute("reason");
    const std::string link_a = xml.attribute(*at, "link1");
    pairs.push_back({link_a, xml.attribute(*at, "link2"),
                     reason == nullptr || *reason == '\0' ? "disabled in the SRDF" : reason,
                     at->GetLineNum()});
  }
  return pairs;
}

// Returns the value, or, where the file has faults, all of them by line.
template <class Value>
std::variant<Value, UrdfFaults> value_or_faults(Value value, const XmlReader& xml) {
  UrdfFaults faults = xml.faults();
  if (faults.empty()) return value;
  std::ranges::stable_sort(faults, {}, &UrdfFault::line);
  return faults;
}

}  // namespace

std::variant<UrdfRobot, UrdfFaults> read_urdf(const std::filesystem::path& file) {
  XmlReader xml(file);
  UrdfRobot robot;
  if (xml.root() != nullptr) {
    robot.name = xml.attribute(*xml.root(), "name");
    read_links(xml, robot);
    read_joints(xml, robot);
  }
  return value_or_faults(std::move(robot), xml);
}

std::variant<Srdf, UrdfFaults> read_srdf(const std::filesystem::path& file) {
  XmlReader xml(file);
  Srdf srdf;
  if (xml.root() != nullptr) {
    srdf.robot = xml.attribute(*xml.root(), "name");
    srdf.line = xml.root()->GetLineNum();
    srdf.disabled = read_pairs_of(xml, "disable_collisions");
    srdf.enabled = read_pairs_of(xml, "enable_collisions");
    for (const XMLElement* at : children(*xml.root(), "disable_default_collisions"))
      srdf.disabled_by_default.push_back({xml.attribute(*at, "link"), at->GetLineNum()});
  }
  return value_or_faults(std::move(srdf), xml);
}

}  // namespace clearance
