// Reads the XML elements that a cell needs and ignores the others (visual, inertial, transmission).
// A mistake is kept with its line and the reading goes on, so that one run finds all of them. Only
// XML that cannot be parsed ends it.
#include "config/urdf/urdf.hpp"

#include <fmt/format.h>

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <system_error>

#include "config/text/printable.hpp"

namespace clearance {
namespace {

using tinyxml2::XMLElement;

// Returns the children of this name, in order.
std::vector<const XMLElement*> children(const XMLElement& element, const char* name) {
  std::vector<const XMLElement*> found;
  for (const XMLElement* at = element.FirstChildElement(name); at != nullptr;
       at = at->NextSiblingElement(name)) {
    found.push_back(at);
  }
  return found;
}

enum class Sign { kAny, kPositive };

// An XML file and its mistakes. A value that cannot be read is reported and keeps its default.
class XmlReader {
 public:
  explicit XmlReader(const std::filesystem::path& file) : file_(file.string()) {
    if (document_.LoadFile(file_.c_str()) == tinyxml2::XML_SUCCESS) {
      root_ = document_.FirstChildElement("robot");
      if (root_ == nullptr) add(1, "found no <robot>; expected it as the root");
    } else {
      add(std::max(1, document_.ErrorLineNum()),
          fmt::format("not readable as XML: {}; expected URDF or SRDF, with xacro expanded",
                      document_.ErrorName()));
    }
  }

  // Returns <robot>, of URDF or SRDF; null after a fault.
  const XMLElement* root() const { return root_; }

  void report(const XMLElement& at, const std::string& text) { add(at.GetLineNum(), text); }

  [[nodiscard]] UrdfFaults faults() const { return faults_; }

  // Returns an attribute, which is required.
  std::string attribute(const XMLElement& element, const char* name) {
    const char* value = element.Attribute(name);
    if (value != nullptr) return value;
    report(element, fmt::format("found <{}> without '{}'", element.Name(), name));
    return "";
  }

  // Returns the first child element of this name, which is required; null after a fault.
  const XMLElement* child(const XMLElement& element, const char* name) {
    const XMLElement* found = element.FirstChildElement(name);
    if (found == nullptr) {
      report(element, fmt::format("found <{}> without <{}>", element.Name(), name));
    }
    return found;
  }

  // Returns an attribute of a child element; both are required.
  std::string attribute_of_child(const XMLElement& element, const char* child_name,
                                 const char* name) {
    const XMLElement* found = child(element, child_name);
    return found == nullptr ? "" : attribute(*found, name);
  }

  // Reads finite numbers in SI units; lengths and radii have to be positive.
  double number(const XMLElement& element, const char* name, Sign sign = Sign::kAny) {
    double value = 0.0;
    numbers(element, name, std::span(&value, 1), sign);
    return value;
  }
  Vec3 vector(const XMLElement& element, const char* name, Sign sign = Sign::kAny) {
    std::array<double, 3> values{};
    numbers(element, name, values, sign);
    return {values[0], values[1], values[2]};
  }
  double length(const XMLElement& element, const char* name) {
    return number(element, name, Sign::kPositive);
  }

  // <origin xyz="..." rpy="..."/>: the element and both attributes are optional, zero by default.
  UrdfOrigin origin(const XMLElement& element) {
    UrdfOrigin origin;
    if (const XMLElement* found = element.FirstChildElement("origin")) {
      if (found->Attribute("xyz") != nullptr) origin.xyz = vector(*found, "xyz");
      if (found->Attribute("rpy") != nullptr) origin.rpy = vector(*found, "rpy");
    }
    return origin;
  }

 private:
  // Reads exactly values.size() finite numbers, separated by blanks.
  void numbers(const XMLElement& element, const char* name, std::span<double> values, Sign sign) {
    if (element.Attribute(name) == nullptr) {
      static_cast<void>(attribute(element, name));
      return;
    }
    const std::string text = element.Attribute(name);
    const char* at = text.data();
    const char* end = text.data() + text.size();
    const auto skip_blanks = [&] {
      while (at != end && std::string_view(" \t\r\n").find(*at) != std::string_view::npos) ++at;
    };
    bool good = true;
    for (double& value : values) {
      skip_blanks();
      if (at != end && *at == '+') ++at;
      const auto result = std::from_chars(at, end, value);
      good = good && result.ec == std::errc() && std::isfinite(value) &&
             (sign == Sign::kAny || value > 0.0);
      at = result.ptr;
    }
    skip_blanks();
    if (!good || at != end) {
      report(element,
             fmt::format("found {}=\"{}\"; expected {} number{}{}", name, text, values.size(),
                         values.size() == 1 ? "" : "s", sign == Sign::kPositive ? " above 0" : ""));
    }
  }

  void add(int line, const std::string& text) {
    faults_.push_back({line, fmt::format("{}:{}: {}", file_, line, excerpt(text))});
  }

  std::string file_;
  tinyxml2::XMLDocument document_;
  const XMLElement* root_ = nullptr;
  UrdfFaults faults_;
};

// Reads one collision shape with its place in the link; the shape is unset after a fault. Visual
// geometry is not read.
UrdfCollision read_collision(XmlReader& xml, const XMLElement& element) {
  UrdfCollision collision;
  collision.link_from_shape = xml.origin(element);
  const XMLElement* geometry = xml.child(element, "geometry");
  if (geometry == nullptr) return collision;
  if (const XMLElement* mesh = geometry->FirstChildElement("mesh")) {
    UrdfMesh shape{.file = xml.attribute(*mesh, "filename"), .line = mesh->GetLineNum()};
    if (mesh->Attribute("scale") != nullptr) shape.scale = xml.vector(*mesh, "scale");
    collision.shape = shape;
  } else if (const XMLElement* box = geometry->FirstChildElement("box")) {
    collision.shape = UrdfBox{xml.vector(*box, "size", Sign::kPositive)};
  } else if (const XMLElement* cylinder = geometry->FirstChildElement("cylinder")) {
    const double radius = xml.length(*cylinder, "radius");
    collision.shape = UrdfCylinder{radius, xml.length(*cylinder, "length")};
  } else if (const XMLElement* sphere = geometry->FirstChildElement("sphere")) {
    collision.shape = UrdfSphere{xml.length(*sphere, "radius")};
  } else if (const XMLElement* capsule = geometry->FirstChildElement("capsule")) {
    const double radius = xml.length(*capsule, "radius");
    collision.shape = UrdfCapsule{radius, xml.length(*capsule, "length")};
  } else {
    xml.report(
        *geometry,
        "found a geometry of an unknown kind; expected mesh, box, cylinder, sphere or capsule");
  }
  return collision;
}

// A robot without shapes would give a cell that watches nothing, and is refused.
void read_links(XmlReader& xml, UrdfRobot& robot) {
  for (const XMLElement* at = xml.root()->FirstChildElement(); at != nullptr;
       at = at->NextSiblingElement()) {
    if (!std::string_view(at->Name()).starts_with("xacro:")) continue;
    xml.report(*at,
               fmt::format("found <{}>; expected a URDF: expand it first (xacro R.urdf.xacro > "
                           "R.urdf)",
                           at->Name()));
    return;
  }
  std::set<std::string> names;
  bool any_shape = false;
  for (const XMLElement* at : children(*xml.root(), "link")) {
    UrdfLink link{xml.attribute(*at, "name"), {}};
    if (!link.name.empty() && !names.insert(link.name).second)
      xml.report(*at, fmt::format("found the link '{}' again", link.name));
    for (const XMLElement* part : children(*at, "collision")) {
      link.collisions.push_back(read_collision(xml, *part));
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
