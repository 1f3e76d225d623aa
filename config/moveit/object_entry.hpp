// The body of a collision object as an entry of `objects` of a cell.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/moveit/message.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance::moveit {

// The form of a mesh in the text of a cell.
enum class MeshForm {
  kFile,  // a file "sent:NAME", whose bytes are returned
  kHull,  // its convex hull, as a polyhedron
};

// The bytes of a mesh that a cell names "sent:NAME". The name is made of the content.
struct MeshFile {
  std::string name;
  std::string bytes;  // PLY
};

struct Body {
  YamlNode parts;          // the value of `parts`, in the unit of the cell
  Pose frame_from_object;  // in the frame of the message
  bool is_bounded = true;  // false: it has a plane
  std::vector<MeshFile> files = {};
};

// Translates the shapes and poses of a message. The frame of the object is where MoveIt has it: an
// only shape gives its pose to an object without one. A plane is solid on the side that its normal
// points away from. The hull of a prism's polygon is taken.
[[nodiscard]] std::variant<Body, FieldFault> body_of(const CollisionObject& object, LengthUnit unit,
                                                     MeshForm meshes);

// Returns a pose with a unit quaternion. One of zeros, which some programs leave behind, means no
// rotation. `field` names the pose.
[[nodiscard]] std::variant<Pose, FieldFault> checked_pose(const Pose& pose,
                                                          const std::string& field);

// Returns one entry of `objects`: a fixed object, whose pose is in the world.
[[nodiscard]] YamlNode fixed_entry(const std::string& name, const std::string& group,
                                   const Pose& world_from_object, YamlNode parts, LengthUnit unit);

// The carrier of an attached object, and the object's pose relative to it.
struct Attachment {
  std::string to;
  Pose carrier_from_object;
  std::vector<std::string> touch;
  double weight = 0.0;  // kg; 0: not known
};
[[nodiscard]] YamlNode attached_entry(const std::string& name, const std::string& group,
                                      const Attachment& attachment, YamlNode parts,
                                      LengthUnit unit);
// The mass that a weight of a message states, kg; nothing: it is not known.
[[nodiscard]] std::optional<double> mass_of(double weight);
void set_mass(std::optional<double> mass, YamlNode& entry);
// Adds names to those that an attached object may touch.
void add_touch(const std::vector<std::string>& names, YamlNode& entry);

}  // namespace clearance::moveit
