// AttachedCollisionObject: objects that links of robots carry.
#include <fmt/format.h>

#include <algorithm>

#include "monitor/intake/message_translator.hpp"

namespace clearance::moveit {

// MoveIt lets an object overlap its touch links at any depth: a grasp closes fingers in the model
// of a part, so that a limit would refuse the attachment and leave the part behind as an obstacle.
constexpr double kAnyDepth = 1e6;  // m

// Names of links without shapes are left out: they touch nothing. The carrier may always touch.
std::vector<std::string> MessageTranslator::touch_of(const AttachedCollisionObject& message) {
  std::vector<std::string> touch;
  for (const std::string& name : message.touch_links) {
    if (name == message.link_name || name == message.object.id) continue;
    if (scene_.objects.contains(name)) {
      if (std::ranges::find(touch, name) == touch.end()) touch.push_back(name);
    } else if (!scene_.links.contains(name)) {
      result_.not_understood.push_back(fmt::format("the touch link '{}'", name));
    }
  }
  return touch;
}

// A fixed object of the cell may be attached as well.
void MessageTranslator::attach_as_it_is(const AttachedCollisionObject& message,
                                        const std::string& path) {
  const std::string& id = message.object.id;
  const auto found = scene_.objects.find(id);
  if (found == scene_.objects.end() || !found->second.is_in_objects ||
      found->second.where != Where::kFixed) {
    fail(path + "object.id",
         fmt::format("found '{}' without shapes, which is no fixed object of the cell; expected "
                     "shapes, or an object to attach",
                     id));
  }
  const Pose carrier_from_object = compose(inverse(link_of(message, path)), found->second.pose);
  std::vector<std::string> touch = touch_of(message);
  forget_exceptions(id);
  KnownObject& object = found->second;
  object.where = Where::kAttached;
  object.is_gone = false;
  object.carrier = message.link_name;
  object.pose = carrier_from_object;
  result_.changes.emplace_back(Attach{id, message.link_name, carrier_from_object, std::move(touch),
                                      kAnyDepth, true, mass_of(message.weight)});
}

void MessageTranslator::attach_with_shapes(const AttachedCollisionObject& message,
                                           const std::string& path) {
  const std::string object_path = path + "object.";
  refuse_others(message.object.id, object_path);
  const Pose link = link_of(message, path);
  const Pose frame = frame_of(message.object, object_path);
  Body body = body_of_message(message.object, object_path);
  if (!body.is_bounded)
    fail(object_path + "planes", "found a plane; expected bounded shapes of what is attached");
  KnownObject object;
  object.where = Where::kAttached;
  object.carrier = message.link_name;
  object.pose = compose(inverse(link), compose(frame, body.frame_from_object));
  object.entry = attached_entry(message.object.id, scene_.group,
                                {message.link_name, object.pose, touch_of(message), message.weight},
                                std::move(body.parts), scene_.unit);
  keep_subframes(message.object, object_path);
  put(message.object.id, std::move(object));
}

// The new parts are in the frame of the object, as MoveIt has it.
void MessageTranslator::append_attached(const AttachedCollisionObject& message,
                                        const std::string& path) {
  const std::string& id = message.object.id;
  const KnownObject* present = find(id);
  if (present == nullptr || !present->is_moveits || present->where != Where::kAttached)
    return attach_with_shapes(message, path);
  if (message.link_name != present->carrier) {
    fail(path + "link_name", fmt::format("found '{}'; expected '{}', to which '{}' is attached",
                                         message.link_name, present->carrier, id));
  }
  const Pose& pose = message.object.pose;
  if (pose.position != Vec3::Zero() || pose.orientation.vec() != Vec3::Zero())
    fail(path + "object.pose", "found a pose of an attached object in an APPEND; expected none");
  Body body = body_of_message(message.object, path + "object.");
  if (!body.is_bounded)
    fail(path + "object.planes", "found a plane; expected bounded shapes of what is attached");
  KnownObject changed = *present;
  add_parts(changed, message.object, std::move(body), path + "object.");
  add_touch(touch_of(message), changed.entry);
  set_mass(mass_of(message.weight), changed.entry);
  put(id, std::move(changed));
}

void MessageTranslator::detach(const std::string& id, KnownObject& object,
                               const std::string& path) {
  const auto world = world_from(id);
  if (!world) {
    fail(path + "object.id",
         fmt::format("found '{}', whose carrier '{}' is at no known place now; expected its joints "
                     "to be known",
                     id, object.carrier));
  }
  forget_exceptions(id);
  object.where = Where::kFixed;
  object.pose = *world;
  result_.changes.emplace_back(Detach{id, world});
}

void MessageTranslator::detach(const AttachedCollisionObject& message, const std::string& path) {
  const std::string& link = message.link_name;
  if (!message.object.id.empty()) {
    KnownObject* object = find(message.object.id);
    if (object == nullptr || object->where != Where::kAttached) {
      fail(path + "object.id", fmt::format("found '{}', which is not attached; expected an "
                                           "attached object",
                                           message.object.id));
    }
    if (!link.empty() && link != object->carrier) {
      fail(path + "link_name", fmt::format("found '{}'; expected '{}', to which '{}' is attached",
                                           link, object->carrier, message.object.id));
    }
    return detach(message.object.id, *object, path);
  }
  if (!link.empty() && !scene_.links.contains(link))
    fail(path + "link_name",
         fmt::format("found '{}'; expected a link of a robot of the cell", link));
  for (auto& [id, object] : scene_.objects) {
    if (object.is_moveits && !object.is_gone && object.where == Where::kAttached &&
        (link.empty() || link == object.carrier)) {
      guarded(id, [&] { detach(id, object, path); });
    }
  }
}

// A tool with joints is a robot of the cell: it is attached and detached where it is. Its own links
// count, and not the shapes of the message; the SRDF of both says what may touch.
void MessageTranslator::change_robot(const AttachedCollisionObject& message,
                                     const std::string& path) {
  const std::string& id = message.object.id;
  KnownRobot& robot = scene_.robots.at(id);
  const bool attaches = message.object.operation == static_cast<std::uint8_t>(Operation::kAdd);
  if (!attaches && message.object.operation != static_cast<std::uint8_t>(Operation::kRemove)) {
    fail(path + "object.operation",
         fmt::format("found {} of the robot '{}'; expected 0 (ADD) or 1 (REMOVE)",
                     message.object.operation, id));
  }
  if (attaches && robot.carrier == message.link_name) return;
  const auto root = world_from(robot.root);
  if (!root)
    fail(path + "object.id",
         fmt::format("found the robot '{}', which is at no known place now; expected that it is "
                     "there, and its joints to be known",
                     id));
  if (!attaches) {
    result_.changes.emplace_back(DetachRobot{.robot = id, .world_from_root = root});
    robot.carrier = "";
    return;
  }
  result_.changes.emplace_back(
      AttachRobot{.robot = id,
                  .to = message.link_name,
                  .carrier_from_root = compose(inverse(link_of(message, path)), *root),
                  .overlap = kAnyDepth,
                  .far = true});
  robot.carrier = message.link_name;
}

void MessageTranslator::translate(const AttachedCollisionObject& message, const std::string& path) {
  guarded(message.object.id, [&] {
    if (scene_.robots.contains(message.object.id)) return change_robot(message, path);
    switch (message.object.operation) {
      case static_cast<std::uint8_t>(Operation::kAdd):
        return message.object.shapes() == 0 ? attach_as_it_is(message, path)
                                            : attach_with_shapes(message, path);
      case static_cast<std::uint8_t>(Operation::kAppend):
        return append_attached(message, path);
      case static_cast<std::uint8_t>(Operation::kRemove):
        return detach(message, path);
      default:
        fail(path + "object.operation",
             fmt::format(
                 "found {}; expected 0 (ADD), 1 (REMOVE) or 2 (APPEND) of an attached object",
                 message.object.operation));
    }
  });
}

}  // namespace clearance::moveit
