// The list of changes with a pose wherever one was left out, by a model of its own: a body that is
// attached or detached without a pose stays where it is.
//
// Oracle: the cell after each change, and the places of what moves by itself.
#pragma once

#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "config/edit/cell_editor.hpp"
#include "tests/monitor/requests/random_commands_cell.hpp"

namespace clearance::test {

inline bool leaves_out_a_pose(const CellChange& change) {
  const auto* attach = std::get_if<Attach>(&change);
  const auto* detach = std::get_if<Detach>(&change);
  return (attach != nullptr && !attach->carrier_from_object) ||
         (detach != nullptr && !detach->world_from_object);
}

class StatedPoses {
 public:
  // `usable`: the objects and links of the running cell whose poses are sent and on time.
  StatedPoses(CellEditor& editor, const Places& places, std::set<std::string> usable)
      : editor_(editor), places_(places), usable_(std::move(usable)) {}

  // The changes before one that leaves out a pose make no cell by themselves: nothing is known.
  [[nodiscard]] bool is_open() const { return is_open_; }
  // Nothing: where a body is then is not known.
  [[nodiscard]] std::optional<std::vector<CellChange>> of(const std::vector<CellChange>& list) {
    std::vector<CellChange> stated;
    for (const CellChange& change : list) {
      stated.push_back(change);
      if (!leaves_out_a_pose(change)) continue;
      const auto read = editor_.dry_run(std::span(stated).first(stated.size() - 1));
      if (std::holds_alternative<EditRefusal>(read)) {
        is_open_ = true;
        return std::nullopt;
      }
      const Scene& scene = std::get<Cell>(read).scene;
      if (auto* attach = std::get_if<Attach>(&stated.back())) {
        const auto object = pose_in(scene, attach->object), to = pose_in(scene, attach->to);
        if (!object || !to) return std::nullopt;
        const Eigen::Quaterniond back = to->orientation.conjugate();
        attach->carrier_from_object =
            Pose{back * (object->position - to->position), back * object->orientation};
      } else if (auto* detach = std::get_if<Detach>(&stated.back())) {
        const auto object = pose_in(scene, detach->object);
        if (!object) return std::nullopt;
        detach->world_from_object = *object;
      }
    }
    return stated;
  }

 private:
  [[nodiscard]] std::optional<Pose> pose_in(const Scene& scene, const std::string& name) const {
    const auto found = std::ranges::find(scene.objects, name, &Object::name);
    if (found == scene.objects.end()) return std::nullopt;
    const auto index = static_cast<std::uint32_t>(found - scene.objects.begin());
    if (!is_known(scene, index)) return std::nullopt;
    Pose pose = in_world(scene, places_)[index];
    pose.orientation.normalize();
    return pose;
  }
  // Follows the carriers to what is fixed, sent, or a link.
  [[nodiscard]] bool is_known(const Scene& scene, std::uint32_t object) const {
    if (scene.objects[object].absent) return false;
    if (scene.objects[object].fixed) return true;
    for (const Robot& robot : scene.robots) {
      if (!robot.is_attached || robot.links[0].object != object) continue;
      const RobotBase& base = robot.base;
      return is_known(scene, base.kind == RobotBase::Kind::kObject
                                 ? base.object
                                 : scene.robots[base.robot].links[base.link].object);
    }
    return usable_.contains(scene.objects[object].name);
  }

  bool is_open_ = false;
  CellEditor& editor_;
  const Places& places_;
  std::set<std::string> usable_;
};

}  // namespace clearance::test
