// CollisionObject: objects of the world.
#include <fmt/format.h>

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

// The object stays where it is, and the new parts are where the message has them.
void MessageTranslator::append(const CollisionObject& message, KnownObject& object,
                               const std::string& path) {
  const Pose frame = frame_of(message, path);
  Body body = body_of_message(message, path);
  KnownObject changed = object;
  add_parts(changed, std::move(body), compose(inverse(object.pose), frame), path);
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
  object->pose = compose(frame_of(message, path), pose);
  result_.changes.emplace_back(clearance::Place{message.id, object->pose});
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
