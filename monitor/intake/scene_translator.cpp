// PlanningScene, and the entry points.
#include "monitor/intake/scene_translator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "monitor/intake/message_translator.hpp"

namespace clearance::moveit {

void MessageTranslator::set_frames(const PlanningScene& message) {
  if (!message.is_diff) kept_.world_from_frame_.clear();
  for (std::size_t i = 0; i < message.fixed_frame_transforms.size(); ++i) {
    const FixedFrame& frame = message.fixed_frame_transforms[i];
    if (frame.frame_id == frame.child_frame_id) continue;
    guarded({}, [&] {
      const std::string path = fmt::format("fixed_frame_transforms[{}].", i);
      const auto world = world_from(frame.child_frame_id);
      if (!world) {
        fail(path + "child_frame_id", fmt::format("found '{}', whose place is not known; expected "
                                                  "'{}'",
                                                  frame.child_frame_id, scene_.world));
      }
      const Pose pose = value_of(checked_pose(frame.child_from_frame, "transform"), path);
      kept_.world_from_frame_[frame.frame_id] = compose(*world, pose);
    });
  }
}

// A margin that the cell states is the cell's own. A padding that is no larger than what the cell
// gives to the link adds nothing.
void MessageTranslator::set_margins(const PlanningScene& message) {
  for (std::size_t i = 0; i < message.link_padding.size(); ++i) {
    const auto& [name, padding] = message.link_padding[i];
    guarded(name, [&] {
      if (!(std::isfinite(padding) && padding >= 0.0)) {
        fail(fmt::format("link_padding[{}].padding", i),
             fmt::format("found {}; expected metres, 0 or more", padding));
      }
      const auto link = scene_.objects.find(name);
      if (link == scene_.objects.end() || link->second.where != Where::kLink) {
        if (padding > 0.0 && !scene_.links.contains(name))
          result_.not_understood.push_back(fmt::format("link_padding of '{}'", name));
        return;
      }
      double& margin = link->second.margin;
      const bool is_stated = scene_.margins.contains(name);
      if (is_stated && !kept_.padded_.contains(name)) {
        if (padding > margin) {
          result_.not_understood.push_back(
              fmt::format("link_padding of '{}', whose margin the cell states", name));
        }
        return;
      }
      const double before = kept_.padded_.emplace(name, margin).first->second;
      const double after = std::max(before, padding);
      if (after == margin) return;
      margin = after;
      result_.changes.emplace_back(
          SetMargin{name, after > before ? std::optional(after) : std::nullopt});
    });
  }
}

void MessageTranslator::drop_gone() {
  std::vector<std::string> ids;
  for (const auto& [id, object] : scene_.objects) {
    if (object.is_gone) ids.push_back(id);
  }
  for (const std::string& id : ids) drop(id);
}

// Keeps MoveIt's order: frames, the robot's state, pairs, the world.
void MessageTranslator::translate(const PlanningScene& message) {
  set_frames(message);
  for (auto& [id, object] : scene_.objects) {
    const bool is_replaced =
        object.where == Where::kAttached ? !message.robot_state_is_diff : !message.is_diff;
    object.is_gone = object.is_moveits && is_replaced;
  }
  for (std::size_t i = 0; i < message.attached.size(); ++i) {
    const AttachedCollisionObject& attached = message.attached[i];
    const std::string path = fmt::format("robot_state.attached_collision_objects[{}].", i);
    if (message.robot_state_is_diff ||
        attached.object.operation == static_cast<std::uint8_t>(Operation::kAdd)) {
      translate(attached, path);
    } else {
      result_.refused.push_back({path + "object.operation",
                                 fmt::format("found {} in a robot_state that is no diff; expected "
                                             "0 (ADD)",
                                             attached.object.operation)});
    }
  }
  if (!message.is_diff || !message.allowed_collision_matrix.entry_names.empty()) {
    if (auto fault = kept_.matrix_.set(message.allowed_collision_matrix)) {
      fault->field.insert(0, "allowed_collision_matrix.");
      result_.refused.push_back(*std::move(fault));
    }
  }
  set_margins(message);
  for (const LinkNumber& scale : message.link_scale) {
    if (scale.value != 1.0)
      result_.not_understood.push_back(fmt::format("link_scale of '{}'", scale.link_name));
  }
  for (std::size_t i = 0; i < message.collision_objects.size(); ++i)
    translate(message.collision_objects[i], fmt::format("world.collision_objects[{}].", i));
  if (message.has_octomap && !scene_.has_octomap_sensor)
    result_.not_understood.emplace_back("world.octomap");
  drop_gone();
}

Translation SceneTranslator::translate(const CollisionObject& message, const KnownScene& scene,
                                       const PresentPoses& poses) {
  MessageTranslator translator(*this, scene, poses);
  translator.translate(message, "");
  return translator.result();
}

Translation SceneTranslator::translate(const AttachedCollisionObject& message,
                                       const KnownScene& scene, const PresentPoses& poses) {
  MessageTranslator translator(*this, scene, poses);
  translator.translate(message, "");
  return translator.result();
}

Translation SceneTranslator::translate(const PlanningScene& message, const KnownScene& scene,
                                       const PresentPoses& poses) {
  MessageTranslator translator(*this, scene, poses);
  translator.translate(message);
  return translator.result();
}

std::vector<CellChange> SceneTranslator::exceptions(const std::set<NamePair>& watched,
                                                    const std::set<NamePair>& present) const {
  std::vector<CellChange> changes;
  if (!matrix_.is_set()) return changes;
  for (const auto& [a, b] : present) {
    if (!matrix_.allows(a, b)) changes.emplace_back(SetPair{a, b, SetPair::Rule::kNoException});
  }
  for (const auto& [a, b] : watched) {
    if (matrix_.allows(a, b))
      changes.emplace_back(SetPair{a, b, SetPair::Rule::kLeaveOut, std::string(kMatrixReason)});
  }
  return changes;
}

}  // namespace clearance::moveit
