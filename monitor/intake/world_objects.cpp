// CollisionObject: objects of the world.
#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "config/yaml/quantity_nodes.hpp"
#include "config/yaml/yaml_writer.hpp"
#include "monitor/intake/message_translator.hpp"

namespace clearance::moveit {

void MessageTranslator::add(const CollisionObject& message, const std::string& path) {
  refuse_others(message.id, path);
  KnownObject* present = find(message.id);
  if (present != nullptr && present->where == Where::kAttached) {
    fail(path + "id", fmt::format("found '{}', which is attached to '{}'; expected it to be "
                                  "detached before",
                                  message.id, present->carrier));
  }
  if (present != nullptr && message.operation == static_cast<std::uint8_t>(Operation::kAppend))
    return append(message, *present, path);
  const Pose frame = frame_of(message, path);
  Body body = body_of_message(message, path);
  KnownObject object;
  object.where = Where::kFixed;
  object.pose = compose(frame, body.frame_from_object);
  object.entry =
      fixed_entry(message.id, scene_.group, object.pose, std::move(body.parts), scene_.unit);
  keep_subframes(message, path);
  put(message.id, std::move(object));
}

// In MoveIt the object stays where it is, and the new parts are in its frame, wherever the message
// has it.
void MessageTranslator::append(const CollisionObject& message, const KnownObject& object,
                               const std::string& path) {
  Body body = body_of_message(message, path);
  const Pose& stated = body.frame_from_object;
  if (!is_same(message.pose, Pose{}) &&
      !is_same(object.pose, compose(frame_of(message, path), stated))) {
    fail(path + "pose",
         fmt::format("found another pose than that of '{}' in an APPEND, which MoveIt "
                     "does not use; expected none, and poses of the shapes in the "
                     "frame of the object",
                     message.id));
  }
  KnownObject changed = object;
  add_parts(changed, message, std::move(body), path);
  put(message.id, std::move(changed));
}

void MessageTranslator::remove(const CollisionObject& message, const std::string& path) {
  if (message.id.empty()) {
    std::vector<std::string> ids;
    for (const auto& [id, object] : scene_.objects) {
      if (object.is_moveits && !object.is_gone && object.where == Where::kFixed) ids.push_back(id);
    }
    for (const std::string& id : ids) drop(id);
    return;
  }
  refuse_others(message.id, path);
  const KnownObject* object = find(message.id);
  if (object == nullptr || object->where != Where::kFixed) {
    fail(path + "id", fmt::format("found '{}', which is not in the world; expected an object to "
                                  "remove",
                                  message.id));
  }
  drop(message.id);
}

// Fixed objects of the cell move as well: a cell may state a part and leave its place to MoveIt.
void MessageTranslator::move(const CollisionObject& message, const std::string& path) {
  KnownObject* object = find(message.id);
  if (object == nullptr || !object->is_in_objects || object->where != Where::kFixed) {
    fail(path + "id", fmt::format("found '{}', which is no fixed object of the cell; expected one "
                                  "to move",
                                  message.id));
  }
  if (message.shapes() > 0)
    result_.not_understood.push_back(fmt::format("shapes in a MOVE of '{}'", message.id));
  const Pose pose = value_of(checked_pose(message.pose, "pose"), path);
  KnownObject moved = *object;
  moved.pose = compose(frame_of(message, path), pose);
  if (moved.is_moveits) set(moved.entry, "pose", pose_node(moved.pose, scene_.unit));
  if (move_parts(message, moved, path)) return put(message.id, std::move(moved));
  result_.changes.emplace_back(clearance::Place{message.id, moved.pose});
  *object = std::move(moved);
}

// MoveIt takes the poses of a message that has no shapes, too.
bool MessageTranslator::move_parts(const CollisionObject& message, KnownObject& object,
                                   const std::string& path) const {
  std::vector<std::pair<std::string, Pose>> poses;
  const auto add = [&](const std::vector<Pose>& some, const char* field) {
    for (std::size_t i = 0; i < some.size(); ++i)
      poses.emplace_back(fmt::format("{}[{}]", field, i), some[i]);
  };
  add(message.primitive_poses, "primitive_poses");
  add(message.mesh_poses, "mesh_poses");
  add(message.plane_poses, "plane_poses");
  if (poses.empty()) return false;
  YamlNode* const parts = object.is_moveits ? clearance::find(object.entry, "parts") : nullptr;
  const std::size_t expected = parts == nullptr ? 0 : parts->items.size();
  if (poses.size() != expected) {
    fail(path + "primitive_poses",
         fmt::format("found {} poses of shapes in a MOVE of '{}'; expected {} or none",
                     poses.size(), message.id, expected));
  }
  for (std::size_t i = 0; i < expected; ++i) {
    const Pose pose = value_of(checked_pose(poses[i].second, poses[i].first), path);
    set(parts->items[i], "pose", pose_node(pose, scene_.unit));
  }
  return true;
}

void MessageTranslator::translate(const CollisionObject& message, const std::string& path) {
  guarded(message.id, [&] {
    switch (message.operation) {
      case static_cast<std::uint8_t>(Operation::kAdd):
      case static_cast<std::uint8_t>(Operation::kAppend):
        return add(message, path);
      case static_cast<std::uint8_t>(Operation::kRemove):
        return remove(message, path);
      case static_cast<std::uint8_t>(Operation::kMove):
        return move(message, path);
      default:
        fail(path + "operation",
             fmt::format("found {}; expected 0 (ADD), 1 (REMOVE), 2 (APPEND) or 3 (MOVE)",
                         message.operation));
    }
  });
}

}  // namespace clearance::moveit
