// The elements of a robot's description that a cell needs: the collision shapes and joints of URDF,
// and the pairs that SRDF disables.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/vec.hpp"

namespace clearance {

// <mesh filename="..." scale="x y z"/>: the file is not opened here.
struct UrdfMesh {
  std::string file;  // as written: package://..., file://..., or a path
  Vec3 scale = Vec3::Ones();
  int line = 0;  // of the URDF
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
// An extension of URDF; `length` is between the centres of its ends.
struct UrdfCapsule {
  double radius, length;  // m; along z, centred
};

// The place of a child's frame in its parent's, as written: rpy about the fixed axes x, y, z.
struct UrdfOrigin {
  Vec3 xyz = Vec3::Zero();  // m
  Vec3 rpy = Vec3::Zero();  // rad
};

// <collision>: one geometry and its <origin>. A link may have several.
struct UrdfCollision {
  std::variant<UrdfMesh, UrdfBox, UrdfCylinder, UrdfSphere, UrdfCapsule> shape;
  UrdfOrigin link_from_shape;
  int line = 0;
};

// <link>: only its collision elements; a link without any is a frame.
struct UrdfLink {
  std::string name;
  std::vector<UrdfCollision> collisions;
};

// <limit>: rad or m, and rad/s or m/s. A missing attribute is 0, as in URDF.
struct UrdfLimit {
  double lower = 0.0, upper = 0.0;
  std::optional<double> velocity;
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
  int line = 0;
  std::optional<Vec3> axis = {};  // in the joint's frame; of any length
  std::optional<UrdfLimit> limit = {};
  std::optional<UrdfMimic> mimic = {};
};

// <robot>, in the order of the file. No link is the child of two joints.
struct UrdfRobot {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
};

// <disable_collisions link1="..." link2="..." reason="..."/>, and <enable_collisions .../>.
struct SrdfDisabled {
  std::string link_a, link_b, reason;
  int line = 0;
};

// <disable_default_collisions link="..."/>: every pair of the link is disabled but those that are
// enabled one by one.
struct SrdfDefault {
  std::string link;
  int line = 0;
};

// <robot> of an SRDF, in the order of the file. A pair that is disabled one by one stays disabled.
struct Srdf {
  std::string robot;  // its name
  int line = 0;       // of the name
  std::vector<SrdfDisabled> disabled = {}, enabled = {};
  std::vector<SrdfDefault> disabled_by_default = {};
};

// `text` reads "FILE:LINE: what was found; what was expected".
struct UrdfFault {
  int line;
  std::string text;
};
using UrdfFaults = std::vector<UrdfFault>;  // at least one, by line

// Plain URDF: xacro has to be expanded before. Checks that joints join links that exist into trees.
[[nodiscard]] std::variant<UrdfRobot, UrdfFaults> read_urdf(const std::filesystem::path& file);

// Reads the pairs of an SRDF.
[[nodiscard]] std::variant<Srdf, UrdfFaults> read_srdf(const std::filesystem::path& file);

}  // namespace clearance
