#include "config/urdf/person.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

namespace clearance {
namespace {

// The mean stature of the men of ANSUR II (Gordon et al., 2014), m.
constexpr double kMeanStature = 1.756;

// Radii in m. They contain, rounded up, the mean of the men of ANSUR II and 2.33 standard
// deviations (99 of 100). Half a girth by pi counts 1.1 times, since limbs are not round. A hand
// and a foot point anywhere: they are balls around wrist and ankle with the hand's length, and the
// distance of the toes.
struct Radii {
  double head = 0.15, neck = 0.09, trunk = 0.22, shoulders = 0.16, pelvis = 0.20;
  double upper_arm = 0.08, forearm = 0.065, hand = 0.22, thigh = 0.135, shin = 0.085, foot = 0.24;
};

// One joint of the skeleton: its name, the links that it connects, and its axis; zero: it is fixed.
struct Joint {
  std::string name, parent, child;
  Vec3 origin, axis;
};

void add_arm(const std::string& side, double left, double stature, std::vector<Joint>& joints) {
  const Vec3 shoulder(0.0, left * 0.129 * stature, 0.0);
  const Vec3 elbow(0.0, 0.0, -0.186 * stature), wrist(0.0, 0.0, -0.146 * stature);
  const Vec3 none = Vec3::Zero(), x = left * Vec3::UnitX(), z = left * Vec3::UnitZ();
  const auto name = [&](const char* of) { return side + of; };
  joints.push_back({name("y_shoulder"), "torso", name("y_shoulder"), shoulder, -z});
  joints.push_back({name("p_shoulder"), name("y_shoulder"), name("p_shoulder"), none, x});
  joints.push_back({name("r_shoulder"), name("p_shoulder"), name("shoulder"), none, z});
  joints.push_back({name("elbow"), name("shoulder"), name("elbow"), elbow, -Vec3::UnitY()});
  joints.push_back({name("wrist"), name("elbow"), name("wrist"), wrist, none});
}

void add_leg(const std::string& side, double left, double stature, std::vector<Joint>& joints) {
  const Vec3 hip(0.0, left * 0.0955 * stature, 0.0);
  const Vec3 knee(0.0, 0.0, -0.245 * stature), ankle(0.0, 0.0, -0.246 * stature);
  const Vec3 none = Vec3::Zero(), x = left * Vec3::UnitX(), y = Vec3::UnitY();
  const auto name = [&](const char* of) { return side + of; };
  joints.push_back({name("y_hip"), "body", name("y_hip"), hip, -Vec3::UnitZ()});
  joints.push_back({name("p_hip"), name("y_hip"), name("p_hip"), none, x});
  joints.push_back({name("r_hip"), name("p_hip"), name("hip"), none, -y});
  joints.push_back({name("knee"), name("hip"), name("knee"), knee, -y});
  joints.push_back({name("ankle"), name("knee"), name("ankle"), ankle, none});
}

UrdfCollision ball(double radius, const Vec3& centre) {
  return {.shape = UrdfSphere{radius}, .link_from_shape = {.xyz = centre}};
}

UrdfCollision capsule(double radius, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  if (!(along.norm() > 0.0)) return ball(radius, from);
  return {.shape = UrdfCapsule{radius, along.norm()},
          .link_from_shape = {
              .xyz = 0.5 * (from + to),
              .quaternion = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), along).normalized()}};
}

// Gives limbs to a skeleton whose names have no ending.
class Limbs {
 public:
  Limbs(UrdfRobot& skeleton, double scale) : skeleton_(skeleton), scale_(scale) {}

  std::optional<std::string> add() {
    const Radii radii;
    add("body", radii.pelvis, at("l_y_hip", "body"), at("r_y_hip", "body"));
    add("waist", radii.trunk, Vec3::Zero(), at("torso", "waist"));
    add("torso", radii.shoulders, at("l_y_shoulder", "torso"), at("r_y_shoulder", "torso"));
    add("torso", radii.neck, Vec3::Zero(), at("r_head", "torso"));
    add("p_head", radii.head, Vec3::Zero(), Vec3(0.0, 0.0, at("head", "p_head").z()));
    meet("p_head", "y_head");
    meet("y_head", "r_head");
    for (const std::string side : {"l_", "r_"}) {
      for (const std::string joint : {"shoulder", "hip"}) {
        meet(side + "p_" + joint, side + "y_" + joint);
        meet(side + joint, side + "p_" + joint);
      }
      const Vec3 wrist = at(side + "wrist", side + "elbow"),
                 ankle = at(side + "ankle", side + "knee");
      add(side + "shoulder", radii.upper_arm, Vec3::Zero(), at(side + "elbow", side + "shoulder"));
      add(side + "elbow", radii.forearm, Vec3::Zero(), wrist);
      add(side + "elbow", radii.hand, wrist, wrist);
      add(side + "hip", radii.thigh, Vec3::Zero(), at(side + "knee", side + "hip"));
      add(side + "knee", radii.shin, Vec3::Zero(), ankle);
      add(side + "knee", radii.foot, ankle, ankle);
    }
    return missing_.empty() ? std::nullopt : std::optional(missing_);
  }

 private:
  // Returns the place of a link in its parent, with all joints at zero.
  Vec3 at(const std::string& link, const std::string& parent) {
    const auto joint = std::ranges::find(skeleton_.joints, link, &UrdfJoint::child);
    if (joint != skeleton_.joints.end() && joint->parent == parent)
      return joint->parent_from_child.xyz;
    if (missing_.empty())
      missing_ = fmt::format("no joint by which '{}' carries '{}'", parent, link);
    return Vec3::Zero();
  }
  // No limb is between links of one joint of the body, such as a shoulder.
  void meet(const std::string& link, const std::string& parent) {
    constexpr double kOnePlace = 1e-3;  // m
    const double apart = at(link, parent).norm();
    if (apart > kOnePlace && missing_.empty())
      missing_ = fmt::format("'{}' {} m away from '{}'", link, apart, parent);
  }
  void add(const std::string& name, double radius, const Vec3& from, const Vec3& to) {
    const auto link = std::ranges::find(skeleton_.links, name, &UrdfLink::name);
    if (link != skeleton_.links.end()) {
      link->collisions.push_back(capsule(scale_ * radius, from, to));
      link->has_collision = true;
    } else if (missing_.empty()) {
      missing_ = fmt::format("no link '{}'", name);
    }
  }

  UrdfRobot& skeleton_;
  double scale_;
  std::string missing_;
};

}  // namespace

UrdfRobot skeleton_of(double stature) {
  const Vec3 none = Vec3::Zero();
  std::vector<Joint> joints = {
      {"waist", "body", "waist", none, Vec3::UnitY()},
      {"torso", "waist", "torso", Vec3(0.0, 0.0, 0.288 * stature), none},
      {"r_head", "torso", "r_head", Vec3(0.0, 0.0, 0.052 * stature), Vec3::UnitX()},
      {"y_head", "r_head", "y_head", none, Vec3::UnitZ()},
      {"p_head", "y_head", "p_head", none, -Vec3::UnitY()},
      {"head", "p_head", "head", Vec3(0.0, 0.0, 0.065 * stature), none}};
  for (const auto& [side, left] : {std::pair("l_", 1.0), std::pair("r_", -1.0)}) {
    add_arm(side, left, stature, joints);
    add_leg(side, left, stature, joints);
  }
  UrdfRobot skeleton{.name = "person", .links = {}, .joints = {}};
  skeleton.links.emplace_back().name = "body";
  for (const Joint& joint : joints) {
    skeleton.links.emplace_back().name = joint.child;
    const bool turns = joint.axis != Vec3::Zero();
    skeleton.joints.push_back({.type = turns ? "continuous" : "fixed",
                               .parent = joint.parent,
                               .child = joint.child,
                               .parent_from_child = {.xyz = joint.origin},
                               .name = joint.name,
                               .axis = turns ? std::optional(joint.axis) : std::nullopt});
  }
  return skeleton;
}

std::optional<std::string> make_person(double stature, const std::string& person,
                                       const std::string& id, UrdfRobot& skeleton) {
  const auto is_child = [&](const UrdfLink& link) {
    return std::ranges::find(skeleton.joints, link.name, &UrdfJoint::child) !=
           skeleton.joints.end();
  };
  const auto root = std::ranges::find_if_not(skeleton.links, is_child);
  if (root == skeleton.links.end() || !root->name.starts_with("body"))
    return "no root link 'body' or 'body_ID'";
  const std::string ending = root->name.substr(std::string_view("body").size());
  std::string other;
  const auto strip = [&](std::string& name) {
    if (name.ends_with(ending)) {
      name.resize(name.size() - ending.size());
    } else {
      other = name;
    }
  };
  for (UrdfLink& link : skeleton.links) {
    strip(link.name);
    link.collisions.clear();
    link.has_collision = link.has_visual = false;
  }
  for (UrdfJoint& joint : skeleton.joints)
    for (std::string* name : {&joint.name, &joint.parent, &joint.child}) strip(*name);
  if (!other.empty())
    return fmt::format("the name '{}', which does not end with '{}' as that of its root", other,
                       ending);
  if (auto missing = Limbs(skeleton, std::max(1.0, stature / kMeanStature)).add()) return missing;
  for (UrdfLink& link : skeleton.links) link.name += "_" + person;
  for (UrdfJoint& joint : skeleton.joints) {
    joint.name += "_" + id;
    for (std::string* name : {&joint.parent, &joint.child}) *name += "_" + person;
    if (joint.type == "revolute") joint.type = "continuous";
    joint.limit.reset();
  }
  return std::nullopt;
}

double approach_speed_of(std::string_view link) noexcept {
  constexpr double kWalking = 1.6, kReaching = 2.0;
  constexpr std::array<std::string_view, 4> kArms = {"l_shoulder_", "r_shoulder_", "l_elbow_",
                                                     "r_elbow_"};
  const bool is_of_arm =
      std::ranges::any_of(kArms, [&](std::string_view arm) { return link.starts_with(arm); });
  return is_of_arm ? kReaching : kWalking;
}

}  // namespace clearance
