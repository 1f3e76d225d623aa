#include "config/scene/scene_map.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace clearance {
namespace {

template <class Thing>
class Names {
 public:
  explicit Names(const std::vector<Thing>& things) {
    for (std::uint32_t i = 0; i < things.size(); ++i) index_.emplace(things[i].name, i);
  }
  [[nodiscard]] std::uint32_t find(std::string_view name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? SceneMap::kNone : found->second;
  }

 private:
  std::unordered_map<std::string_view, std::uint32_t> index_;
};

// By index in `now`: the index in `before` of the thing of the same name.
template <class Thing>
std::vector<std::uint32_t> by_name(const std::vector<Thing>& before,
                                   const std::vector<Thing>& now) {
  const Names<Thing> names(before);
  std::vector<std::uint32_t> found;
  found.reserve(now.size());
  for (const Thing& thing : now) found.push_back(names.find(thing.name));
  return found;
}

// By object: the robot that it is a link of, or SceneMap::kNone.
std::vector<std::uint32_t> robot_of_objects(const Scene& scene) {
  std::vector<std::uint32_t> robots(scene.objects.size(), SceneMap::kNone);
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    for (const RobotLink& link : scene.robots[robot].links) {
      if (link.object != RobotLink::kNoObject) robots[link.object] = robot;
    }
  }
  return robots;
}

// The names of both objects, in alphabetic order.
std::pair<std::string_view, std::string_view> names_of(const ContactPair& pair,
                                                       const Scene& scene) {
  const ObjectPair& objects = scene.pairs[pair.pair];
  return std::minmax(std::string_view(scene.objects[objects.first].name),
                     std::string_view(scene.objects[objects.second].name));
}

std::vector<std::uint32_t> by_contact(const Scene& before, const Scene& now) {
  using Key = std::pair<std::string_view, std::pair<std::string_view, std::string_view>>;
  std::map<Key, std::uint32_t> index;
  const std::vector<ContactPair> old = contact_pairs(before);
  for (std::uint32_t i = 0; i < old.size(); ++i)
    index.emplace(Key{before.contacts[old[i].contact].name, names_of(old[i], before)}, i);
  std::vector<std::uint32_t> found;
  for (const ContactPair& pair : contact_pairs(now)) {
    const AllowedContact& contact = now.contacts[pair.contact];
    const auto same = index.find({contact.name, names_of(pair, now)});
    const bool goes_on = same != index.end() && [&](const AllowedContact& was) {
      return was.depth == contact.depth && was.end == contact.end;
    }(before.contacts[old[same->second].contact]);
    found.push_back(goes_on ? same->second : SceneMap::kNone);
  }
  return found;
}

bool same_input(const JointVariable& a, const JointVariable& b) {
  return a.source == b.source && a.wraps == b.wraps;
}
bool same_input(const Object& a, const Object& b) {
  // The object of a sensor begins anew with the next frame.
  return !a.fixed && !b.fixed && !a.is_seen() && !b.is_seen() && a.source == b.source &&
         a.frame == b.frame && a.absent == b.absent;
}

// Whether what names the robots' frames and joints on ROS 2 is the same.
bool same_senders(const Robot& a, const Robot& b) {
  const std::string &id_a = a.person ? a.person->id : a.name,
                    &id_b = b.person ? b.person->id : b.name;
  return id_a == id_b && a.base.frame == b.base.frame && a.joint_states == b.joint_states;
}

// Whether the robots' variables are the same, one by one.
bool same_variables(std::uint32_t robot_before, const Scene& before, std::uint32_t robot_now,
                    const Scene& now, const std::vector<std::uint32_t>& variables) {
  std::size_t count = 0;
  for (const JointVariable& variable : before.variables) count += variable.robot == robot_before;
  for (std::size_t i = 0; i < now.variables.size(); ++i) {
    if (now.variables[i].robot != robot_now) continue;
    if (variables[i] == SceneMap::kNone) return false;
    const JointVariable& old = before.variables[variables[i]];
    if (old.robot != robot_before || !same_input(old, now.variables[i])) return false;
    --count;
  }
  return count == 0;
}

// Positions of the robot that were sent for the scene before are of nothing in the changed one.
void forget_samples(const Scene& before, std::uint32_t robot, SceneMap& map) {
  for (std::size_t i = 0; i < before.variables.size(); ++i)
    if (before.variables[i].robot == robot) map.variables_now[i] = SceneMap::kNone;
}

bool same_held(const RobotJoint& a, const Scene& before, const RobotJoint& b, const Scene& now) {
  if (variables_of(b.type) != 1) return true;
  const JointVariable &old = before.variables[a.variable], &variable = now.variables[b.variable];
  return variable.is_held() ? variable.held == old.held : !old.is_held();
}

bool same_joint(const RobotJoint& a, const RobotJoint& b) {
  return a.name == b.name && a.type == b.type && a.parent == b.parent && a.axis == b.axis &&
         a.multiplier == b.multiplier && a.offset == b.offset && a.plane_x == b.plane_x &&
         a.plane_y == b.plane_y && same_pose(a.parent_from_joint, b.parent_from_joint);
}

// Whether equal positions of their joints place both robots' links alike. `same_before`: the same
// for the robots before this one, by index in `now`.
bool same_chain(const Robot& old, const Scene& before, const Robot& robot, const Scene& now,
                const SceneMap& map, const std::vector<bool>& same_before) {
  const RobotBase &a = old.base, &b = robot.base;
  if (a.kind != b.kind || a.frame != b.frame || !same_pose(a.base_from_root, b.base_from_root) ||
      !same_pose(a.frame_from_root, b.frame_from_root) ||
      old.joints.size() != robot.joints.size()) {
    return false;
  }
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const RobotJoint &of_old = old.joints[i], &joint = robot.joints[i];
    if (!same_joint(of_old, joint) || !same_held(of_old, before, joint, now)) return false;
  }
  switch (b.kind) {
    case RobotBase::Kind::kWorld:
      return true;
    case RobotBase::Kind::kObject:
      return before.objects[a.object].name == now.objects[b.object].name &&
             same_input(before.objects[a.object], now.objects[b.object]);
    case RobotBase::Kind::kLink:
      return same_before[b.robot] && map.robots[b.robot] == a.robot && a.link == b.link;
  }
  return false;
}

}  // namespace

SceneMap scene_map(const Scene& before, const Scene& now) {
  SceneMap map{.objects = by_name(before.objects, now.objects),
               .robots = by_name(before.robots, now.robots),
               .variables = by_name(before.variables, now.variables),
               .zones = by_name(before.zones, now.zones),
               .contact_pairs = by_contact(before, now),
               .objects_now = by_name(now.objects, before.objects),
               .variables_now = by_name(now.variables, before.variables)};
  for (std::uint32_t robot = 0; robot < now.robots.size(); ++robot) {
    std::uint32_t& old = map.robots[robot];
    if (old == SceneMap::kNone) continue;
    const bool are_same = same_senders(before.robots[old], now.robots[robot]);
    if (!are_same) forget_samples(before, old, map);
    if (!are_same || !same_variables(old, before, robot, now, map.variables)) old = SceneMap::kNone;
  }
  for (std::size_t i = 0; i < before.objects.size(); ++i) {
    std::uint32_t& object = map.objects_now[i];
    if (object != SceneMap::kNone && before.objects[i].frame != now.objects[object].frame)
      object = SceneMap::kNone;
  }
  for (std::size_t i = 0; i < now.variables.size(); ++i) {
    if (map.robots[now.variables[i].robot] == SceneMap::kNone) map.variables[i] = SceneMap::kNone;
  }
  std::vector<bool> same_chains;
  for (std::size_t robot = 0; robot < now.robots.size(); ++robot) {
    const std::uint32_t old = map.robots[robot];
    same_chains.push_back(
        old != SceneMap::kNone &&
        same_chain(before.robots[old], before, now.robots[robot], now, map, same_chains));
  }
  const std::vector<std::uint32_t> robots_before = robot_of_objects(before),
                                   robots_now = robot_of_objects(now);
  for (std::size_t i = 0; i < now.objects.size(); ++i) {
    std::uint32_t& old = map.objects[i];
    if (old == SceneMap::kNone) continue;
    const std::uint32_t robot = robots_now[i];
    const bool same_robot = robot == SceneMap::kNone
                                ? robots_before[old] == SceneMap::kNone
                                : same_chains[robot] && map.robots[robot] == robots_before[old];
    if (!same_robot || !same_input(before.objects[old], now.objects[i])) old = SceneMap::kNone;
  }
  return map;
}

}  // namespace clearance
