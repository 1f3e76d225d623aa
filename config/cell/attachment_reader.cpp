// A carrier is placed before what it carries, wherever the two stand in the file.
#include "config/cell/attachment_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "config/scene/attached.hpp"
#include "config/scene/people.hpp"
#include "config/scene/rigid_root.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/map_reader.hpp"

namespace clearance {
namespace {

class AttachmentReader {
 public:
  AttachmentReader(const Quantities& quantities, RobotList& robots, ObjectList& list)
      : quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        robots_(robots),
        list_(list) {
    for (std::uint32_t robot = 0; robot < robots.robots.size(); ++robot) {
      const std::vector<RobotLink>& links = robots.robots[robot].links;
      for (std::uint32_t link = 0; link < links.size(); ++link)
        links_.emplace(links[link].name, std::pair(robot, link));
    }
    for (std::uint32_t i = 0; i < list.objects.size(); ++i) {
      if (!list.objects[i].is_seen()) objects_.emplace(list.objects[i].name, i);
    }
    for (std::size_t i = 0; i < list.stated.size(); ++i)
      stated_.emplace(list.stated[i].object.name, i);
    progress_.resize(list.stated.size());
  }

  void attach_all();

 private:
  // The link, robot or object that carries an object.
  struct Carrier {
    RobotBase base;
    std::optional<std::uint32_t> object;
    std::optional<std::uint32_t> robot;  // of a link
  };
  enum class Progress : std::uint8_t { kWaits, kBegun, kDone };
  // Attaches this one, unless that was done, after the attached object that carries it.
  void attach_once(std::size_t stated);
  void attach(StatedAttachment& stated);
  bool attach_carrier(const YamlNode& node, const std::string& name);
  std::optional<Carrier> carrier(const YamlNode& node);
  void refuse_speed(const StatedAttachment& stated, const RigidRoot& root);
  void leave_out_touching();
  void leave_out_rigid();
  [[nodiscard]] RigidRoot root_of(std::uint32_t object) const;
  [[nodiscard]] std::optional<std::uint32_t> robot_of(std::uint32_t object) const;

  std::vector<Progress> progress_;             // by stated attachment
  std::map<std::string, std::size_t> stated_;  // by name
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  RobotList& robots_;
  ObjectList& list_;
  std::map<std::string, std::pair<std::uint32_t, std::uint32_t>> links_;  // robot and link
  std::map<std::string, std::uint32_t> objects_;
  std::vector<std::pair<std::uint32_t, const YamlNode*>> touching_;  // the names that it may touch
  std::vector<std::uint32_t> attached_;
  bool all_carried_ = true;  // false: a carrier is not known, and groups are missing
};

// If the carrier is attached itself, places it first. Returns false after a diagnostic.
bool AttachmentReader::attach_carrier(const YamlNode& node, const std::string& name) {
  const auto carrier = stated_.find(name);
  if (carrier == stated_.end()) return true;
  if (progress_[carrier->second] == Progress::kBegun) {
    diagnostics_.add(node, fmt::format("found that '{}' is carried by what it carries; expected no "
                                       "circle of attached objects",
                                       name));
    return false;
  }
  attach_once(carrier->second);
  return true;
}

void AttachmentReader::attach_once(std::size_t stated) {
  if (progress_[stated] != Progress::kWaits) return;
  progress_[stated] = Progress::kBegun;
  attach(list_.stated[stated]);
  progress_[stated] = Progress::kDone;
}

// Links without shapes carry as well: a flange, or a tool centre point.
std::optional<AttachmentReader::Carrier> AttachmentReader::carrier(const YamlNode& node) {
  const auto name = read_name(node, "a link or an object", diagnostics_);
  if (!name || !attach_carrier(node, *name)) return std::nullopt;
  Carrier found;
  if (const auto link = links_.find(*name); link != links_.end()) {
    const auto [robot, index] = link->second;
    const RobotLink& of = robots_.robots[robot].links[index];
    found.robot = robot;
    if (of.object != RobotLink::kNoObject) found.object = of.object;
    if (const auto place = robots_.at_rest.find(*name); place != robots_.at_rest.end()) {
      found.base.base_from_root = place->second;
      found.base.resting_on = {.kind = RestingOn::Kind::kLink, .robot = robot, .link = index};
    } else {
      found.base.kind = RobotBase::Kind::kLink;
      found.base.robot = robot;
      found.base.link = index;
    }
    return found;
  }
  if (const auto object = objects_.find(*name); object != objects_.end()) {
    const Object& of = list_.objects[object->second];
    found.object = object->second;
    if (of.fixed) {
      found.base.base_from_root = of.world_from_object;
      found.base.resting_on = {.kind = RestingOn::Kind::kObject, .object = object->second};
    } else {
      found.base.kind = RobotBase::Kind::kObject;
      found.base.object = object->second;
    }
    return found;
  }
  if (!list_.names_known) return std::nullopt;
  std::vector<std::string> names;
  for (const auto& [known, unused] : links_) names.push_back(known);
  for (const auto& [known, unused] : objects_) names.push_back(known);
  diagnostics_.add(
      node, fmt::format("found the unknown carrier '{}'; expected a link or an object of the "
                        "cell{}",
                        *name, did_you_mean(*name, names)));
  return std::nullopt;
}

// While the pose of an object is late, it is within max_speed times its age. Positions of joints
// have different ages, so a speed of the link would bound nothing.
void AttachmentReader::refuse_speed(const StatedAttachment& stated, const RigidRoot& root) {
  if (stated.max_speed == nullptr || root.is_object) return;
  diagnostics_.add(*stated.max_speed,
                   "found 'max_speed' of an object that joints move; expected it of objects "
                   "attached to one whose pose arrives: the limits of the joints bound this one");
}

void AttachmentReader::attach(StatedAttachment& stated) {
  MapReader map(*stated.attached, "what an object is attached to", diagnostics_);
  const YamlNode* to = map.required("to");
  const YamlNode* pose_node = map.optional("pose");
  const YamlNode* touch = map.optional("touch");
  map.refuse_unknown_keys();
  const Pose pose = pose_node == nullptr ? Pose{} : quantities_.pose(*pose_node).value_or(Pose{});
  const auto found = to == nullptr ? std::nullopt : carrier(*to);
  const auto index = static_cast<std::uint32_t>(list_.objects.size());
  Object& object = stated.object;
  all_carried_ = all_carried_ && found.has_value();
  if (touch != nullptr) touching_.emplace_back(index, touch);
  attached_.push_back(index);
  RobotBase base;
  if (found) {
    if (found->object) {
      take_over(list_.objects[*found->object], object);
    } else {
      take_over(robots_.robots[*found->robot], list_.objects, object);
    }
    base = found->base;
    base.base_from_root = compose(base.base_from_root, pose);
    if (found->object) list_.attachments.push_back({index, *found->object});
  }
  if (base.kind == RobotBase::Kind::kWorld) {
    object.fixed = true;
    object.world_from_object = base.base_from_root;
    object.resting_on = base.resting_on;
    object.max_speed = 0.0;
    if (found && stated.max_speed != nullptr) {
      diagnostics_.add(*stated.max_speed,
                       "found 'max_speed' of an object that is attached to a fixed one; expected "
                       "it of moving objects only");
    }
    list_.objects.push_back(std::move(object));
  } else {
    be_carried(base, index, robots_.robots, robots_.variables, object);
    const auto last = static_cast<std::uint32_t>(robots_.robots.size() - 1);
    refuse_speed(stated, root_of_link(robots_.robots, last, 0));
    list_.objects.push_back(std::move(object));
    links_.emplace(list_.objects.back().name, std::pair(last, 0));
  }
  list_.places.push_back(stated.place);
  objects_.emplace(list_.objects.back().name, index);
}

// The description of a robot says which of its own links matter to each other.
std::optional<std::uint32_t> AttachmentReader::robot_of(std::uint32_t object) const {
  const auto link = links_.find(list_.objects[object].name);
  return link == links_.end() ? std::nullopt : std::optional(link->second.first);
}

RigidRoot AttachmentReader::root_of(std::uint32_t object) const {
  const auto link = links_.find(list_.objects[object].name);
  if (link == links_.end()) return {true, object, 0};
  return root_of_link(robots_.robots, link->second.first, link->second.second);
}

void AttachmentReader::leave_out_rigid() {
  std::vector<std::pair<RigidRoot, std::uint32_t>> by_root;
  for (std::uint32_t i = 0; i < list_.objects.size(); ++i)
    if (!list_.objects[i].fixed) by_root.emplace_back(root_of(i), i);
  std::ranges::sort(by_root);
  const auto is_attached = [&](std::uint32_t object) {
    return std::ranges::binary_search(attached_, object);
  };
  for (auto first = by_root.begin(); first != by_root.end(); ++first) {
    for (auto other = first + 1; other != by_root.end() && other->first == first->first; ++other) {
      const std::uint32_t a = first->second, b = other->second;
      if (is_attached(a) || is_attached(b)) {
        list_.left_out.push_back(pair_key(a, b));
      } else if (robot_of(a) != robot_of(b)) {
        list_.left_out.push_back(pair_key(a, b));
        list_.rigid.push_back(pair_key(a, b));
      }
    }
  }
  std::ranges::sort(list_.rigid);
}

// Names are those of objects, or of groups, whose members may then all be touched. A link without
// shapes touches nothing.
void AttachmentReader::leave_out_touching() {
  std::map<std::string, std::vector<std::uint32_t>> named;
  if (touching_.empty()) return;
  for (std::uint32_t i = 0; i < list_.objects.size(); ++i) {
    named[list_.objects[i].name].push_back(i);
    for (const std::string& group : list_.objects[i].groups) named[group].push_back(i);
  }
  for (const auto& [object, names] : touching_) {
    if (names->items.size() > kMaxObjects) {
      diagnostics_.add(*names,
                       fmt::format("found {} names that '{}' may touch; expected at most {}",
                                   names->items.size(), list_.objects[object].name, kMaxObjects));
      continue;
    }
    for (const YamlNode& item :
         read_list(*names, "objects and groups that it may touch", diagnostics_)) {
      const auto name = read_name(item, "an object or a group", diagnostics_);
      if (!name) continue;
      const auto found = named.find(*name);
      if (found != named.end()) {
        for (const std::uint32_t other : found->second) {
          if (other == object) continue;
          const auto why =
              contact_with_people(list_.objects, robots_.robots, {}, {}, object, other);
          if (why) diagnostics_.add(item, *why);
          list_.left_out.push_back(pair_key(object, other));
          list_.touching.push_back(pair_key(object, other));
        }
      } else if (list_.names_known && !links_.contains(*name)) {
        std::vector<std::string> known;
        for (const auto& [each, unused] : named) known.push_back(each);
        diagnostics_.add(
            item, fmt::format("found the unknown name '{}'; expected an object, a link or a group "
                              " that this one may touch{}",
                              *name, did_you_mean(*name, known)));
      }
    }
  }
}

void AttachmentReader::attach_all() {
  for (std::size_t i = 0; i < list_.stated.size(); ++i) attach_once(i);
  leave_out_rigid();
  leave_out_touching();
  list_.names_known = list_.names_known && all_carried_;
  std::ranges::sort(list_.left_out);
  const auto same = std::ranges::unique(list_.left_out);
  list_.left_out.erase(same.begin(), same.end());
}

}  // namespace

void attach_objects(const Quantities& quantities, RobotList& robots, ObjectList& list) {
  if (list.stated.empty() && robots.robots.empty()) return;
  AttachmentReader(quantities, robots, list).attach_all();
  if (list.objects.size() <= kMaxObjects) return;
  quantities.diagnostics().add(
      *list.places.back(), fmt::format("found {} objects with those that are attached; expected at "
                                       "most {}, which is what a report can carry",
                                       list.objects.size(), kMaxObjects));
}

}  // namespace clearance
