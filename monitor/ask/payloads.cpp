#include "monitor/ask/payloads.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "config/scene/attached.hpp"
#include "config/scene/chain_rounding.hpp"
#include "config/scene/people.hpp"
#include "config/scene/rigid_root.hpp"
#include "config/scene/stated_errors.hpp"

namespace clearance {
namespace {

using PairKey = std::pair<std::uint32_t, std::uint32_t>;
using Fault = std::optional<std::string>;

PairKey key_of(std::uint32_t a, std::uint32_t b) noexcept {
  return {std::min(a, b), std::max(a, b)};
}

std::string named(const Payload& payload) { return "payload \"" + payload.name + "\""; }

class Attacher {
 public:
  explicit Attacher(const Scene& scene)
      : scene_(scene), carriers_(carriers_of(scene.attachments, scene.objects.size())) {
    for (const ObjectPair& pair : scene.pairs) watched_.insert({pair.first, pair.second});
    for (const ObjectPair& pair : scene.may_touch)
      excepted_.insert(key_of(pair.first, pair.second));
  }

  Fault attach(const Payload& payload);
  // After all are attached.
  Fault let_touch(const Payload& payload);
  Fault use_loads();
  // Leaves out the pairs that a payload may touch, or moves with rigidly.
  Scene finish();

 private:
  struct Place {
    std::uint32_t robot, link;
  };
  // Objects that are attached to an object count where that one is named, or do not.
  enum class Attached : std::uint8_t { kCount, kDoNot };
  [[nodiscard]] std::optional<std::uint32_t> object_named(const std::string& name) const;
  [[nodiscard]] std::optional<Place> place_of(std::uint32_t object) const;
  [[nodiscard]] Fault object_of(const Payload& payload, std::uint32_t& object);
  // A person of the cell and what moves stay watched, whatever the cell says.
  [[nodiscard]] bool is_excepted(PairKey key) const {
    return excepted_.contains(key) &&
           !contact_with_people(scene_.objects, scene_.robots, {}, {}, key.first, key.second);
  }
  void carry(std::uint32_t object, const Place& place, const Pose& link_from_object);
  void watch(std::uint32_t object, std::uint32_t link_object, std::uint32_t robot);
  [[nodiscard]] bool has(const std::string& name, std::uint32_t object, Attached attached) const;
  [[nodiscard]] bool is_between(const std::string& a, const std::string& b, Attached attached,
                                PairKey pair) const;
  [[nodiscard]] std::vector<const std::string*> others_of(std::span<const NamedPair> rules,
                                                          std::uint32_t object,
                                                          Attached attached) const;
  [[nodiscard]] Fault join_zones(std::uint32_t object);
  [[nodiscard]] Fault join_contacts(std::uint32_t object);
  void leave_out_rigid(std::uint32_t object, const Place& place);

  Scene scene_;
  std::vector<std::uint32_t> carriers_;  // by object
  std::set<PairKey> watched_, excepted_, left_out_;
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

Fault Attacher::object_of(const Payload& payload, std::uint32_t& object) {
  const std::optional<std::uint32_t> known = object_named(payload.name);
  if (!payload.shape) {
    if (!known) return named(payload) + " is no object of the cell, and has no shape";
    object = *known;
    if (scene_.objects[object].is_seen())
      return named(payload) + " is a sensor: what it sees comes with a frame";
    if (scene_.objects[object].fixed || place_of(object))
      return named(payload) + " is fixed or part of a robot already";
    for (const Robot& robot : scene_.robots) {
      if (robot.base.kind == RobotBase::Kind::kObject && robot.base.object == object)
        return named(payload) + " carries a robot or an object";
    }
    return std::nullopt;
  }
  const auto is_group = [&](const Object& each) { return is_named(each, payload.name); };
  if (!known && std::ranges::any_of(scene_.objects, is_group))
    return named(payload) + " has the name of a group of the cell";
  if (known) return named(payload) + " has the name of an object of the cell";
  if (!payload.shape->bounded()) return named(payload) + " is not bounded";
  object = static_cast<std::uint32_t>(scene_.objects.size());
  Object added;
  added.name = payload.name;
  added.shape_error = scene_.added_shape_error;
  added.attached_error = scene_.attached_error;
  added.margin = scene_.added_margin;
  added.parts.push_back({payload.name, *payload.shape, Pose()});
  scene_.objects.push_back(std::move(added));
  carriers_.push_back(kNoCarrier);
  return std::nullopt;
}

void Attacher::carry(std::uint32_t object, const Place& place, const Pose& link_from_object) {
  Object& carried = scene_.objects[object];
  const std::uint32_t link_object = scene_.robots[place.robot].links[place.link].object;
  carried.absent = false;  // the question says where it is
  take_over(scene_.objects[link_object], carried);
  RobotBase base;
  base.kind = RobotBase::Kind::kLink;
  base.robot = place.robot;
  base.link = place.link;
  base.base_from_root = link_from_object;
  be_carried(base, object, scene_.robots, scene_.variables, carried);
  scene_.robots.back().base_error = carried.attached_error;
  scene_.attachments.push_back({object, link_object});
  carriers_[object] = link_object;
}

bool Attacher::has(const std::string& name, std::uint32_t object, Attached attached) const {
  if (is_named(scene_.objects[object], name)) return true;
  if (attached == Attached::kDoNot) return false;
  for (std::uint32_t at = carriers_[object]; at != kNoCarrier; at = carriers_[at])
    if (scene_.objects[at].name == name) return true;
  return false;
}

bool Attacher::is_between(const std::string& a, const std::string& b, Attached attached,
                          PairKey pair) const {
  const auto& [first, second] = pair;
  return (has(a, first, attached) && has(b, second, attached)) ||
         (has(b, first, attached) && has(a, second, attached));
}

// The other sides of the rules that have the object on one side.
std::vector<const std::string*> Attacher::others_of(std::span<const NamedPair> rules,
                                                    std::uint32_t object, Attached attached) const {
  std::vector<const std::string*> others;
  for (const NamedPair& rule : rules) {
    if (has(rule.a, object, attached)) others.push_back(&rule.b);
    if (has(rule.b, object, attached)) others.push_back(&rule.a);
  }
  return others;
}

// The pairs of the link with others, the links of the same robot, and what rules of the cell make
// pairs. What an exception of the cell allows the object itself stays unwatched.
void Attacher::watch(std::uint32_t object, std::uint32_t link_object, std::uint32_t robot) {
  const auto is_on_a_side = [&](std::uint32_t other, const std::vector<const std::string*>& sides,
                                Attached attached) {
    return std::ranges::any_of(
        sides, [&](const std::string* side) { return has(*side, other, attached); });
  };
  const auto allowed = others_of(scene_.exceptions, object, Attached::kDoNot);
  for (std::uint32_t other = 0; !allowed.empty() && other < scene_.objects.size(); ++other)
    if (is_on_a_side(other, allowed, Attached::kDoNot)) excepted_.insert(key_of(object, other));
  const auto add = [&](std::uint32_t other) {
    const PairKey key = key_of(object, other);
    if (other != object && !is_excepted(key) && watched_.insert(key).second)
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
  const auto sides = others_of(scene_.rules, object, Attached::kCount);
  const bool rests = scene_.objects[link_object].fixed;
  for (std::uint32_t other = 0; other < scene_.objects.size(); ++other) {
    if ((rests && scene_.objects[other].fixed) ||
        never_meet(scene_.objects[object], scene_.objects[other]))
      continue;
    if (is_on_a_side(other, sides, Attached::kCount)) add(other);
  }
}

Fault Attacher::join_zones(std::uint32_t object) {
  for (Zone& zone : scene_.zones) {
    const auto is_of_zone = [&](PairKey key) {
      return is_between(zone.group_a, zone.group_b, Attached::kCount, key);
    };
    const std::string& people =
        zone.separation && zone.separation->human_is_a ? zone.group_a : zone.group_b;
    const std::string& robots = &people == &zone.group_a ? zone.group_b : zone.group_a;
    if (zone.separation && has(people, object, Attached::kCount) &&
        has(robots, object, Attached::kCount))
      return "zone \"" + zone.name + "\": " + on_both_sides(scene_.objects[object]);
    const std::set<std::uint32_t> known(zone.pairs.begin(), zone.pairs.end());
    for (std::uint32_t p = 0; p < scene_.pairs.size(); ++p) {
      const PairKey key(scene_.pairs[p].first, scene_.pairs[p].second);
      if ((key.first != object && key.second != object) || known.contains(p) || !is_of_zone(key))
        continue;
      zone.pairs.push_back(p);
      if (zone.separation)
        zone.separation->human_is_first.push_back(has(people, key.first, Attached::kCount));
    }
    for (const auto& [first, second] : excepted_) {
      if (!zone.separation || (first != object && second != object) || !is_of_zone({first, second}))
        continue;
      const std::uint32_t robot = has(people, first, Attached::kCount) ? second : first;
      if (!scene_.objects[robot].fixed)
        return no_contact_with_people(scene_.objects[first], scene_.objects[second], zone);
    }
  }
  return std::nullopt;
}

Fault Attacher::join_contacts(std::uint32_t object) {
  std::set<std::uint32_t> taken;
  for (AllowedContact& contact : scene_.contacts) {
    const std::set<std::uint32_t> known(contact.pairs.begin(), contact.pairs.end());
    for (std::uint32_t p = 0; p < scene_.pairs.size(); ++p) {
      const PairKey key(scene_.pairs[p].first, scene_.pairs[p].second);
      if ((key.first != object && key.second != object) || known.contains(p) ||
          !is_between(contact.group_a, contact.group_b, Attached::kDoNot, key))
        continue;
      if (auto text = contact_with_people(scene_.objects, scene_.robots, scene_.pairs, scene_.zones,
                                          key.first, key.second))
        return "contact \"" + contact.name + "\": " + *text;
      contact.pairs.push_back(p);
    }
    for (const std::uint32_t p : contact.pairs) {
      if (!taken.insert(p).second)
        return "contact \"" + contact.name + "\" has a pair that is in another contact as well";
    }
  }
  return std::nullopt;
}

// The link's pairs with what moves rigidly with it are left out of scenes; so are the payload's.
void Attacher::leave_out_rigid(std::uint32_t object, const Place& place) {
  const RigidRoot root = root_of_link(scene_.robots, place.robot, place.link);
  if (root.is_object) left_out_.insert(key_of(object, root.index));
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    for (std::uint32_t i = 0; i < scene_.robots[r].links.size(); ++i) {
      const std::uint32_t other = scene_.robots[r].links[i].object;
      if (other != RobotLink::kNoObject && root_of_link(scene_.robots, r, i) == root)
        left_out_.insert(key_of(object, other));
    }
  }
}

Fault Attacher::attach(const Payload& payload) {
  const std::optional<std::uint32_t> link_object = object_named(payload.link);
  const std::optional<Place> place = link_object ? place_of(*link_object) : std::nullopt;
  if (!place) {
    return named(payload) + " is carried by \"" + payload.link +
           "\"; expected an object of the cell that is a link of a robot";
  }
  if (!is_unit(payload.link_from_object.orientation) ||
      !payload.link_from_object.position.allFinite() ||
      payload.link_from_object.position.norm() > kLargestLength) {
    return "the pose of " + named(payload) +
           " is not finite, too far away, or its quaternion has not length 1";
  }
  std::uint32_t object = 0;
  if (auto text = object_of(payload, object)) return text;
  carry(object, *place, payload.link_from_object);
  watch(object, *link_object, place->robot);
  auto text = join_zones(object);
  if (!text) text = join_contacts(object);
  if (text) return named(payload) + ": " + *text;
  left_out_.insert(key_of(object, *link_object));
  leave_out_rigid(object, *place);
  return std::nullopt;
}

Fault Attacher::let_touch(const Payload& payload) {
  const std::uint32_t object = *object_named(payload.name);
  for (const std::string& touched : payload.touch) {
    bool is_known = false;
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
      if (!is_named(scene_.objects[i], touched)) continue;
      is_known = true;
      if (i == object) continue;
      if (auto text = contact_with_people(scene_.objects, scene_.robots, scene_.pairs, scene_.zones,
                                          object, i))
        return named(payload) + " may touch \"" + touched + "\": " + *text;
      left_out_.insert(key_of(object, i));
    }
    if (!is_known)
      return named(payload) + " may touch \"" + touched +
             "\", which is no object or group of the cell";
  }
  return std::nullopt;
}

Fault Attacher::use_loads() {
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    if (scene_.robots[r].stopping.load.steps.empty()) continue;
    if (auto text = choose_steps(r, scene_.objects, scene_.robots))
      return "with the payloads of the question: " + *text;
  }
  return std::nullopt;
}

Scene Attacher::finish() {
  std::vector<std::uint32_t> now(scene_.pairs.size());
  std::vector<ObjectPair> kept;
  constexpr std::uint32_t kGone = ~0u;
  for (std::size_t p = 0; p < scene_.pairs.size(); ++p) {
    const ObjectPair& pair = scene_.pairs[p];
    const PairKey key(pair.first, pair.second);
    const bool gone = left_out_.contains(key) || is_excepted(key);
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
  for (const Payload& payload : payloads) {
    if (auto text = attacher.let_touch(payload)) return *text;
  }
  if (auto text = attacher.use_loads()) return *text;
  Scene carrying = attacher.finish();
  if (auto text = StatedErrors(carrying).too_large_angle(carrying))
    return "with the payloads of the question: " + *text;
  return carrying;
}

}  // namespace clearance
