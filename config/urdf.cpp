// Reads the XML elements that a cell needs and ignores the others (visual, inertial, transmission).
// The first mistake ends the reading by an exception that does not leave this file.
#include "config/urdf.hpp"

#include <fmt/format.h>

#include <tinyxml2.h>

#include <array>
#include <charconv>
#include <cmath>
#include <exception>
#include <set>
#include <span>
#include <string_view>
#include <system_error>

namespace clearance {
namespace {

using tinyxml2::XMLElement;

// Left through read_file() only.
struct Refusal : std::exception {
  explicit Refusal(std::string what) : text(std::move(what)) {}
  std::string text;
};

// An XML file with messages that name its lines. Throws Refusal at the first mistake: XML that is
// wrong in one place rarely makes sense after it.
class XmlReader {
 public:
  explicit XmlReader(const std::filesystem::path& file) : file_(file.string()) {
    if (document_.LoadFile(file_.c_str()) != tinyxml2::XML_SUCCESS) {
      throw Refusal(
          fmt::format("{}:{}: not readable as XML: {}; expected URDF or SRDF, with xacro expanded",
                      file_, std::max(1, document_.ErrorLineNum()), document_.ErrorName()));
    }
  }

  // The root element of this name; URDF and SRDF both have <robot>.
  const XMLElement& root(const char* name) const {
    const XMLElement* robot = document_.FirstChildElement(name);
    if (robot == nullptr)
      throw Refusal(fmt::format("{}:1: found no <{}>; expected it as the root", file_, name));
    return *robot;
  }

  [[noreturn]] void refuse(const XMLElement& at, const std::string& text) const {
    throw Refusal(fmt::format("{}:{}: {}", file_, at.GetLineNum(), text));
  }

  // An attribute that must be there.
  std::string attribute(const XMLElement& element, const char* name) const {
    const char* value = element.Attribute(name);
    if (value == nullptr) {
      refuse(element, fmt::format("found <{}> without '{}'", element.Name(), name));
    }
    return value;
  }

  // A child element that must be there; the first one if there are more.
  const XMLElement& child(const XMLElement& element, const char* name) const {
    const XMLElement* found = element.FirstChildElement(name);
    if (found == nullptr) {
      refuse(element, fmt::format("found <{}> without <{}>", element.Name(), name));
    }
    return *found;
  }

  // One finite number. URDF is in SI units.
  double number(const XMLElement& element, const char* name) const {
    double value = 0.0;
    numbers(element, name, std::span(&value, 1));
    return value;
  }

  // Three finite numbers.
  Vec3 vector(const XMLElement& element, const char* name) const {
    std::array<double, 3> values{};
    numbers(element, name, values);
    return {values[0], values[1], values[2]};
  }

  // <origin xyz="..." rpy="..."/>: the element and both attributes are optional, zero by default.
  UrdfOrigin origin(const XMLElement& element) const {
    UrdfOrigin origin;
    if (const XMLElement* found = element.FirstChildElement("origin")) {
      if (found->Attribute("xyz") != nullptr) origin.xyz = vector(*found, "xyz");
      if (found->Attribute("rpy") != nullptr) origin.rpy = vector(*found, "rpy");
    }
    return origin;
  }

 private:
  // Exactly values.size() finite numbers, separated by blanks.
  void numbers(const XMLElement& element, const char* name, std::span<double> values) const {
    const std::string text = attribute(element, name);
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
      good = good && result.ec == std::errc() && std::isfinite(value);
      at = result.ptr;
    }
    skip_blanks();
    if (!good || at != end) {
      refuse(element, fmt::format("found {}=\"{}\"; expected {}{}", name, text, values.size(),
                                  values.size() == 1 ? " number" : " numbers"));
    }
  }

  std::string file_;
  tinyxml2::XMLDocument document_;
};

// One collision shape with its place in the link. Visual geometry is not read.
UrdfCollision read_collision(const XmlReader& xml, const XMLElement& element) {
  UrdfCollision collision;
  collision.link_from_shape = xml.origin(element);
  const XMLElement& geometry = xml.child(element, "geometry");
  if (const XMLElement* mesh = geometry.FirstChildElement("mesh")) {
    UrdfMesh shape{xml.attribute(*mesh, "filename")};
    if (mesh->Attribute("scale") != nullptr) shape.scale = xml.vector(*mesh, "scale");
    collision.shape = shape;
  } else if (const XMLElement* box = geometry.FirstChildElement("box")) {
    collision.shape = UrdfBox{xml.vector(*box, "size")};
  } else if (const XMLElement* cylinder = geometry.FirstChildElement("cylinder")) {
    collision.shape =
        UrdfCylinder{xml.number(*cylinder, "radius"), xml.number(*cylinder, "length")};
  } else if (const XMLElement* sphere = geometry.FirstChildElement("sphere")) {
    collision.shape = UrdfSphere{xml.number(*sphere, "radius")};
  } else {
    xml.refuse(geometry,
               "found a geometry of an unknown kind; expected mesh, box, cylinder or sphere");
  }
  return collision;
}

// Links and joints; the joints must make a tree, in which every link has at most one parent.
UrdfRobot read_robot(const std::filesystem::path& file) {
  const XmlReader xml(file);
  const XMLElement& root = xml.root("robot");
  UrdfRobot robot;
  robot.name = xml.attribute(root, "name");
  std::set<std::string> names, children;
  // A robot of frames only would give a cell that watches nothing.
  bool any_shape = false;
  for (const XMLElement* at = root.FirstChildElement("link"); at;
       at = at->NextSiblingElement("link")) {
    UrdfLink link{xml.attribute(*at, "name"), {}};
    if (!names.insert(link.name).second)
      xml.refuse(*at, fmt::format("found the link '{}' again", link.name));
    for (const XMLElement* part = at->FirstChildElement("collision"); part;
         part = part->NextSiblingElement("collision")) {
      link.collisions.push_back(read_collision(xml, *part));
    }
    any_shape = any_shape || !link.collisions.empty();
    robot.links.push_back(std::move(link));
  }
  if (!any_shape) {
    xml.refuse(root, "found no link with a collision shape; expected a robot to keep apart");
  }
  for (const XMLElement* at = root.FirstChildElement("joint"); at;
       at = at->NextSiblingElement("joint")) {
    const UrdfJoint joint{xml.attribute(*at, "type"),
                          xml.attribute(xml.child(*at, "parent"), "link"),
                          xml.attribute(xml.child(*at, "child"), "link"), xml.origin(*at)};
    for (const std::string& link : {joint.parent, joint.child}) {
      if (!names.contains(link))
        xml.refuse(*at, fmt::format("found a joint of the link '{}', which does not exist", link));
    }
    if (!children.insert(joint.child).second) {
      xml.refuse(
          *at, fmt::format("found a second parent of the link '{}'; expected a tree", joint.child));
    }
    robot.joints.push_back(joint);
  }
  return robot;
}

// Only pairs that are disabled one by one. Newer elements that change the default are refused:
// leaving them out would watch, or not watch, other pairs than the file says.
std::vector<SrdfDisabled> read_disabled(const std::filesystem::path& file) {
  const XmlReader xml(file);
  const XMLElement& root = xml.root("robot");
  for (const char* newer : {"disable_default_collisions", "enable_collisions"}) {
    if (const XMLElement* found = root.FirstChildElement(newer)) {
      xml.refuse(*found, fmt::format("found <{}>; expected <disable_collisions> only", newer));
    }
  }
  std::vector<SrdfDisabled> disabled;
  for (const XMLElement* at = root.FirstChildElement("disable_collisions"); at;
       at = at->NextSiblingElement("disable_collisions")) {
    // The reason is optional in an SRDF but required in a cell.
    const char* reason = at->Attribute("reason");
    disabled.push_back({xml.attribute(*at, "link1"), xml.attribute(*at, "link2"),
                        reason == nullptr || *reason == '\0' ? "disabled in the SRDF" : reason});
  }
  return disabled;
}

// Turns the exception of the readers into a value.
template <class Result, class Reader>
std::variant<Result, UrdfFault> read_file(const std::filesystem::path& file, Reader reader) {
  try {
    return reader(file);
  } catch (const Refusal& refusal) {
    return UrdfFault{refusal.text};
  }
}

}  // namespace

// Neither function throws: both end in read_file().
std::variant<UrdfRobot, UrdfFault> read_urdf(const std::filesystem::path& file) {
  return read_file<UrdfRobot>(file, read_robot);
}

std::variant<std::vector<SrdfDisabled>, UrdfFault> read_srdf(const std::filesystem::path& file) {
  return read_file<std::vector<SrdfDisabled>>(file, read_disabled);
}

}  // namespace clearance
