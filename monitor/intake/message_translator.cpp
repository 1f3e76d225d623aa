// All messages share this: frames, names, and the edits of the known scene.
#include "monitor/intake/message_translator.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/yaml/quantity_nodes.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance::moveit {
namespace {

constexpr std::string_view kOctomap = "<octomap>";
constexpr std::size_t kMaxName = 64;  // bytes, as config/yaml/scalar.hpp

bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= kMaxName && text.front() != ' ' && text.back() != ' ' &&
         std::ranges::none_of(text, [](char c) {
           return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == ',' || c == '"';
         });
}

}  // namespace

KnownObject* MessageTranslator::find(const std::string& id) {
  const auto found = scene_.objects.find(id);
  return found == scene_.objects.end() || found->second.is_gone ? nullptr : &found->second;
}

// The path of a frame, as MoveIt looks for it: links, then objects, then fixed frames.
std::optional<Pose> MessageTranslator::world_from(const std::string& frame) const {
  if (frame.starts_with('/')) return world_from(frame.substr(1));
  if (frame == scene_.world) return Pose{};
  if (const auto link = scene_.links.find(frame); link != scene_.links.end())
    return link->second ? link->second : poses_(frame);
  if (const auto found = scene_.objects.find(frame); found != scene_.objects.end()) {
    const KnownObject& object = found->second;
    if (object.is_gone) return std::nullopt;
    if (object.where == Where::kFixed) return object.pose;
    if (object.where != Where::kAttached) return poses_(frame);
    const auto carrier = world_from(object.carrier);
    return carrier ? std::optional(compose(*carrier, object.pose)) : std::nullopt;
  }
  if (const auto found = kept_.subframes_.find(frame); found != kept_.subframes_.end()) {
    const auto object = world_from(found->second.object);
    if (!object) return std::nullopt;
    return compose(*object, found->second.object_from_subframe);
  }
  const auto fixed = kept_.world_from_frame_.find(frame);
  return fixed == kept_.world_from_frame_.end() ? std::nullopt : std::optional(fixed->second);
}

Pose MessageTranslator::frame_of(const CollisionObject& message, const std::string& path) const {
  if (const auto frame = world_from(message.frame_id)) return *frame;
  fail(
      path + "header.frame_id",
      fmt::format("found '{}', whose place is not known; expected '{}', a link or an object of the "
                  "cell, or one of fixed_frame_transforms",
                  message.frame_id, scene_.world));
}

Pose MessageTranslator::link_of(const AttachedCollisionObject& message,
                                const std::string& path) const {
  if (!scene_.links.contains(message.link_name)) {
    fail(path + "link_name",
         fmt::format("found '{}'; expected a link of a robot of the cell", message.link_name));
  }
  if (const auto link = world_from(message.link_name)) return *link;
  fail(path + "link_name",
       fmt::format("found '{}', whose place is not known now; expected its joints to be known",
                   message.link_name));
}

Body MessageTranslator::body_of_message(const CollisionObject& message, const std::string& path) {
  if (message.shapes() == 0) {
    fail(
        path + "primitives",
        fmt::format("found no primitives, meshes or planes of '{}'; expected a shape", message.id));
  }
  Body body = value_of(body_of(message, scene_.unit, kept_.meshes_), path);
  for (MeshFile& file : body.files) {
    const auto same = [&](const MeshFile& each) { return each.name == file.name; };
    if (std::ranges::none_of(result_.files, same)) result_.files.push_back(std::move(file));
  }
  return body;
}

// MoveIt keeps the objects that it has added, and no others.
void MessageTranslator::refuse_others(const std::string& id, const std::string& path) {
  const KnownObject* object = find(id);
  if (object != nullptr && object->where == Where::kLink)
    fail(path + "id", fmt::format("found '{}', a link of a robot; expected another name", id));
  if (scene_.robots.contains(id)) {
    fail(path + "id", fmt::format("found '{}', a robot of the cell, whose own links count; "
                                  "expected another name, or an attached object",
                                  id));
  }
  if (object != nullptr && !object->is_moveits) {
    fail(path + "id", fmt::format("found '{}', which the cell itself has; expected an object that "
                                  "MoveIt has added",
                                  id));
  }
  if (!is_name(id) || id == kOctomap) {
    fail(path + "id", fmt::format("found '{}'; expected a name of 1 to {} bytes without commas, "
                                  "quotes, control characters or blanks at its ends",
                                  id, kMaxName));
  }
}

// Adds an object with this entry, or puts it in the place of the present one.
void MessageTranslator::put(const std::string& id, KnownObject object) {
  const auto known = scene_.objects.find(id);
  const bool is_there = known != scene_.objects.end();
  if (is_there && (known->second.where != object.where || object.where == Where::kAttached))
    forget_exceptions(id);
  std::string yaml = line_of(object.entry);
  if (is_there) {
    result_.changes.emplace_back(ReplaceObject{std::move(yaml)});
  } else {
    result_.changes.emplace_back(AddObject{std::move(yaml)});
  }
  object.is_in_objects = object.is_moveits = true;
  object.is_gone = false;
  scene_.objects[id] = std::move(object);
}

// An exception that changes nothing any more would be refused.
void MessageTranslator::forget_exceptions(const std::string& id) {
  std::erase_if(scene_.exceptions, [&](const NamePair& pair) {
    if (pair.first != id && pair.second != id) return false;
    result_.changes.emplace_back(SetPair{pair.first, pair.second, SetPair::Rule::kNoException});
    return true;
  });
}

void MessageTranslator::drop(const std::string& id) {
  forget_exceptions(id);
  result_.changes.emplace_back(RemoveObject{id});
  scene_.objects.erase(id);
  kept_.matrix_.forget(id);
  std::erase_if(kept_.subframes_, [&](const auto& each) { return each.second.object == id; });
}

void MessageTranslator::keep_subframes(const CollisionObject& message, const std::string& path) {
  if (message.subframe_names.size() != message.subframe_poses.size()) {
    fail(path + "subframe_poses",
         fmt::format("found {} poses for {} names; expected one each",
                     message.subframe_poses.size(), message.subframe_names.size()));
  }
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < message.subframe_names.size(); ++i) {
    poses.push_back(value_of(
        checked_pose(message.subframe_poses[i], fmt::format("subframe_poses[{}]", i)), path));
  }
  std::erase_if(kept_.subframes_,
                [&](const auto& each) { return each.second.object == message.id; });
  for (std::size_t i = 0; i < poses.size(); ++i)
    kept_.subframes_[message.id + "/" + message.subframe_names[i]] = {message.id, poses[i]};
}

// MoveIt makes the pose of an only shape that of the object, which stays where it is: the pose is
// lost.
void MessageTranslator::add_parts(KnownObject& object, const CollisionObject& message, Body body,
                                  const std::string& path) const {
  YamlNode* parts = clearance::find(object.entry, "parts");
  if (parts == nullptr)
    fail(path + "id",
         "found an object without a list of parts; expected one that MoveIt has added");
  if (message.shapes() == 1 && !is_same(body.frame_from_object, message.pose)) {
    fail(path + "pose",
         fmt::format("found the pose of the only shape in an APPEND to '{}', which MoveIt does not "
                     "use; expected all shapes in one ADD",
                     message.id));
  }
  for (YamlNode& part : body.parts.items) parts->items.push_back(std::move(part));
}

}  // namespace clearance::moveit
