// The extensions are those of 388 public URDFs and 41 SRDFs: of Gazebo, Drake, Bullet, the PR2 and
// others.
#include "config/urdf/xml_format.hpp"

#include <array>

namespace clearance {
namespace {

constexpr std::array<OtherWords, 6> kUrdf = {{
    {"robot", "material transmission gazebo ros2_control sensor",
     "inertial frame loop_joint cable force_element collision_filter_group"},
    {"link", "inertial visual type", "self_collision_checking collision_checking self_filter"},
    {"joint", "dynamics safety_controller calibration axis limit mimic", "anchor"},
    {"limit", "effort", "k_velocity"},
    {"collision", "material verbose group", ""},
    {"visual", "material", ""},
}};

constexpr std::array<OtherWords, 1> kSrdf = {{
    {"robot",
     "group group_state end_effector virtual_joint passive_joint link_sphere_approximation "
     "joint_property gripper rotor_params specificities version",
     ""},
}};

constexpr XmlFormat kUrdfFormat = {
    kUrdf, "origin geometry box sphere cylinder capsule mesh axis parent child mimic",
    "xyz rpy quat_xyzw wxyz size radius length scale filename geometry origin pose mesh box sphere "
    "cylinder capsule"};
constexpr XmlFormat kSrdfFormat = {kSrdf, "", ""};

}  // namespace

const XmlFormat& urdf_format() { return kUrdfFormat; }
const XmlFormat& srdf_format() { return kSrdfFormat; }

}  // namespace clearance
