// The elements of a robot's description that a cell needs: the collision shapes and joints of URDF
// 1.0 to 1.2, and the pairs that SRDF disables.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/pose.hpp"
#include "core/vec.hpp"

namespace clearance {

// In the text of a file, from 1; the column counts bytes.
struct UrdfPlace {
  int line = 0, column = 0;
};

// <mesh filename="..." scale="x y z"/>: the file is not opened here.
struct UrdfMesh {
  std::string file;  // as written: package://..., file://..., or a path
  Vec3 scale = Vec3::Ones();
  UrdfPlace place = {};  // in the URDF
};
struct UrdfBox {
  Vec3 size;  // edge lengths, m
};
struct UrdfCylinder {
  double radius, length;  // m; along z, centred
};
struct UrdfSphere {
  double radius;  // m
};
// `length` is between the centres of its ends, as in URDF 1.1 and in the extension before it.
struct UrdfCapsule {
  double radius, length;  // m; along z, centred
};

// The place of a child's frame in its parent's, as written: rpy about the fixed axes x, y, z, or a
// quaternion.
struct UrdfOrigin {
  Vec3 xyz = Vec3::Zero();                            // m
  Vec3 rpy = Vec3::Zero();                            // rad
  std::optional<Eigen::Quaterniond> quaternion = {};  // of length 1
};

// <collision>: one geometry and its <origin>. A link may have several.
struct UrdfCollision {
  std::variant<UrdfMesh, UrdfBox, UrdfCylinder, UrdfSphere, UrdfCapsule> shape;
  UrdfOrigin link_from_shape;
  UrdfPlace place = {};
};

// <link>: only its collision elements; a link without any is a frame.
struct UrdfLink {
  std::string name;
  std::vector<UrdfCollision> collisions;
  bool has_collision = false, has_visual = false;  // in the file
};

// <limit>: rad or m, and rad/s or m/s. A missing attribute is 0, as in URDF 1.0.
struct UrdfLimit {
  double lower = 0.0, upper = 0.0;
  std::optional<double> velocity;
  double acceleration = 0.0, deceleration = 0.0;  // of URDF 1.2; 0: not stated
};

// <mimic>: position = multiplier * (position of `joint`) + offset.
struct UrdfMimic {
  std::string joint;
  double multiplier = 1.0, offset = 0.0;
};

// <joint>, as written; config/urdf/robot_model.hpp checks the elements that its type needs.
struct UrdfJoint {
  std::string type, parent, child;
  UrdfOrigin parent_from_child;  // at position zero
  std::string name = {};
  UrdfPlace place = {};
  std::optional<Vec3> axis = {};  // in the joint's frame; of any length
  std::optional<UrdfLimit> limit = {};
  std::optional<UrdfMimic> mimic = {};
};

// <robot>, in the order of the file. No link is the child of two joints.
struct UrdfRobot {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  std::vector<std::string> notes = {};  // for the log: what is not as the file says, or not used
};

// <disable_collisions link1="..." link2="..." reason="..."/>, and <enable_collisions .../>.
struct SrdfDisabled {
  std::string link_a, link_b, reason;
  UrdfPlace place = {};
};

// <disable_default_collisions link="..."/>: every pair of the link is disabled but those that are
// enabled one by one.
struct SrdfDefault {
  std::string link;
  UrdfPlace place = {};
};

// <robot> of an SRDF, in the order of the file. A pair that is disabled one by one stays disabled.
struct Srdf {
  std::string robot;     // its name
  UrdfPlace place = {};  // of the name
  std::vector<SrdfDisabled> disabled = {}, enabled = {};
  std::vector<SrdfDefault> disabled_by_default = {};
  // The virtual joint by which the base moves: "planar in frame 'odom'". Empty: there is none.
  std::string moving_base = {};
  std::vector<std::string> notes = {};
};

// `text` reads "FILE:LINE:COLUMN: what was found; what was expected".
struct UrdfFault {
  UrdfPlace place;
  std::string text;
};
using UrdfFaults = std::vector<UrdfFault>;  // at least one, by line

[[nodiscard]] UrdfFault fault_at(const std::string& file, UrdfPlace place, const std::string& text);
void sort_by_place(UrdfFaults& faults);

// Plain URDF: xacro has to be expanded before. Checks that joints join links that exist into trees.
// Links of `visual_as_collision` without a collision shape get their visual shapes as such. What
// could change geometry and is not read is refused; all other words that are not read are noted.
// A robot without any shape is refused, and the skeleton of a person is not.
enum class UrdfOf : std::uint8_t { kRobot, kSkeleton };
[[nodiscard]] std::variant<UrdfRobot, UrdfFaults> read_urdf(
    const std::filesystem::path& file, std::span<const std::string> visual_as_collision = {},
    UrdfOf of = UrdfOf::kRobot);

// Reads the pairs of an SRDF.
[[nodiscard]] std::variant<Srdf, UrdfFaults> read_srdf(const std::filesystem::path& file);

}  // namespace clearance
