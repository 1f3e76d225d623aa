#include "monitor/ask/payloads.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "config/scene/chain_rounding.hpp"
#include "config/scene/people.hpp"
#include "config/scene/rigid_root.hpp"

namespace clearance {
namespace {

using PairKey = std::pair<std::uint32_t, std::uint32_t>;

PairKey key_of(std::uint32_t a, std::uint32_t b) noexcept {
  return {std::min(a, b), std::max(a, b)};
}

class Attacher {
 public:
  explicit Attacher(const Scene& scene) : scene_(scene) {}

  std::optional<std::string> attach(const Payload& payload);
  // Leaves out the pairs that a payload may touch, or moves with rigidly.
  Scene finish();

 private:
  struct Place {
    std::uint32_t robot, link;
  };
  [[nodiscard]] std::optional<std::uint32_t> object_named(const std::string& name) const;
  [[nodiscard]] std::optional<Place> place_of(std::uint32_t object) const;
  [[nodiscard]] std::optional<std::string> object_of(const Payload& payload, std::uint32_t& object);
  void carry(std::uint32_t object, const Place& place, const Pose& link_from_object);
  void watch(std::uint32_t object, std::uint32_t link_object, std::uint32_t robot);

  Scene scene_;
  std::set<PairKey> left_out_;
};

std::optional<std::uint32_t> Attacher::object_named(const std::string& name) const {
  for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
    if (scene_.objects[i].name == name) return i;
  }
  return std::nullopt;
}

std::optional<Attacher::Place> Attacher::place_of(std::uint32_t object) const {
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    const std::vector<RobotLink>& links = scene_.robots[r].links;
    for (std::uint32_t i = 0; i < links.size(); ++i) {
      if (links[i].object == object) return Place{r, i};
    }
  }
  return std::nullopt;
}

std::optional<std::string> Attacher::object_of(const Payload& payload, std::uint32_t& object) {
  const std::optional<std::uint32_t> known = object_named(payload.name);
  if (!payload.shape) {
    if (!known)
      return "payload \"" + payload.name + "\" is no object of the cell, and has no shape";
    object = *known;
    if (scene_.objects[object].fixed || place_of(object))
      return "payload \"" + payload.name + "\" is fixed or part of a robot already";
    for (const Robot& robot : scene_.robots) {
      if (robot.base.kind == RobotBase::Kind::kObject && robot.base.object == object)
        return "payload \"" + payload.name + "\" carries a robot or an object";
    }
    return std::nullopt;
  }
  if (known) return "payload \"" + payload.name + "\" has the name of an object of the cell";
  if (!payload.shape->bounded()) return "payload \"" + payload.name + "\" is not bounded";
  object = static_cast<std::uint32_t>(scene_.objects.size());
  Object added;
  added.name = payload.name;
  added.shape_error = scene_.added_shape_error;
  added.parts.push_back({payload.name, *payload.shape, Pose()});
  scene_.objects.push_back(std::move(added));
  return std::nullopt;
}

void Attacher::carry(std::uint32_t object, const Place& place, const Pose& link_from_object) {
  Robot robot;
  robot.name = scene_.objects[object].name;
  robot.is_attached = true;
  robot.base.kind = RobotBase::Kind::kLink;
  robot.base.robot = place.robot;
  robot.base.link = place.link;
  robot.base.base_from_root = link_from_object;
  robot.links.push_back({.name = robot.name, .object = object});
  robot.base_error = scene_.attached_error;
  scene_.objects[object].absent = false;
  scene_.robots.push_back(std::move(robot));
  account_for(chain_rounding(scene_.robots, scene_.variables).back(), scene_.objects[object]);
}

// The pairs of the link with others, and the links of the same robot.
void Attacher::watch(std::uint32_t object, std::uint32_t link_object, std::uint32_t robot) {
  std::set<PairKey> watched;
  for (const ObjectPair& pair : scene_.pairs) watched.insert({pair.first, pair.second});
  const auto add = [&](std::uint32_t other) {
    const PairKey key = key_of(object, other);
    if (other != object && watched.insert(key).second)
      scene_.pairs.push_back({.first = key.first, .second = key.second});
  };
  const std::size_t before = scene_.pairs.size();
  for (std::size_t i = 0; i < before; ++i) {
    const ObjectPair pair = scene_.pairs[i];
    if (pair.first == link_object) add(pair.second);
    if (pair.second == link_object) add(pair.first);
  }
  for (const RobotLink& link : scene_.robots[robot].links) {
    if (link.object != RobotLink::kNoObject) add(link.object);
  }
  for (Zone& zone : scene_.zones) {
    if (!zone.separation) continue;
    const std::size_t members = zone.pairs.size();
    for (std::size_t i = 0; i < members; ++i) {
      const ObjectPair of = scene_.pairs[zone.pairs[i]];
      const bool human_is_first = zone.separation->human_is_first[i] != 0;
      if ((human_is_first ? of.second : of.first) != link_object) continue;
      const std::uint32_t human = human_is_first ? of.first : of.second;
      const PairKey key = key_of(human, object);
      for (std::uint32_t p = 0; p < scene_.pairs.size(); ++p) {
        if (PairKey(scene_.pairs[p].first, scene_.pairs[p].second) != key) continue;
        zone.pairs.push_back(p);
        zone.separation->human_is_first.push_back(key.first == human);
      }
    }
  }
}

std::optional<std::string> Attacher::attach(const Payload& payload) {
  const std::optional<std::uint32_t> link_object = object_named(payload.link);
  const std::optional<Place> place = link_object ? place_of(*link_object) : std::nullopt;
  if (!place) {
    return "payload \"" + payload.name + "\" is carried by \"" + payload.link +
           "\"; expected an object of the cell that is a link of a robot";
  }
  if (!is_unit(payload.link_from_object.orientation) ||
      !payload.link_from_object.position.allFinite() ||
      payload.link_from_object.position.norm() > kLargestLength) {
    return "the pose of payload \"" + payload.name +
           "\" is not finite, too far away, or its quaternion has not length 1";
  }
  std::uint32_t object = 0;
  if (auto text = object_of(payload, object)) return text;
  carry(object, *place, payload.link_from_object);
  watch(object, *link_object, place->robot);
  left_out_.insert(key_of(object, *link_object));
  for (const std::string& touched : payload.touch) {
    bool is_known = false;
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
      const Object& other = scene_.objects[i];
      const bool in_group =
          std::find(other.groups.begin(), other.groups.end(), touched) != other.groups.end();
      if (other.name != touched && !in_group) continue;
      is_known = true;
      if (auto text = contact_with_people(scene_.objects, scene_.robots, scene_.pairs, scene_.zones,
                                          object, i))
        return "payload \"" + payload.name + "\" may touch \"" + touched + "\": " + *text;
      left_out_.insert(key_of(object, i));
    }
    if (!is_known)
      return "payload \"" + payload.name + "\" may touch \"" + touched +
             "\", which is no object or group of the cell";
  }
  // The link's pairs with what moves rigidly with it are left out of scenes; so are the payload's.
  const RigidRoot root = root_of_link(scene_.robots, place->robot, place->link);
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    for (std::uint32_t i = 0; i < scene_.robots[r].links.size(); ++i) {
      const std::uint32_t other = scene_.robots[r].links[i].object;
      if (other != RobotLink::kNoObject && root_of_link(scene_.robots, r, i) == root)
        left_out_.insert(key_of(object, other));
    }
  }
  return std::nullopt;
}

Scene Attacher::finish() {
  std::vector<std::uint32_t> now(scene_.pairs.size());
  std::vector<ObjectPair> kept;
  constexpr std::uint32_t kGone = ~0u;
  for (std::size_t p = 0; p < scene_.pairs.size(); ++p) {
    const ObjectPair& pair = scene_.pairs[p];
    const bool gone = left_out_.contains({pair.first, pair.second});
    now[p] = gone ? kGone : static_cast<std::uint32_t>(kept.size());
    if (!gone) kept.push_back(pair);
  }
  scene_.pairs = std::move(kept);
  for (Zone& zone : scene_.zones) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < zone.pairs.size(); ++i) {
      const std::uint32_t pair = now[zone.pairs[i]];
      if (pair == kGone) continue;
      if (zone.separation)
        zone.separation->human_is_first[left] = zone.separation->human_is_first[i];
      zone.pairs[left++] = pair;
    }
    zone.pairs.resize(left);
    if (zone.separation) zone.separation->human_is_first.resize(left);
  }
  for (AllowedContact& contact : scene_.contacts) {
    for (std::uint32_t& pair : contact.pairs) pair = now[pair];
    std::erase(contact.pairs, kGone);
  }
  return std::move(scene_);
}

}  // namespace

std::variant<Scene, std::string> scene_with(const Scene& scene, std::span<const Payload> payloads) {
  Attacher attacher(scene);
  for (const Payload& payload : payloads) {
    if (auto text = attacher.attach(payload)) return *text;
  }
  return attacher.finish();
}

}  // namespace clearance
