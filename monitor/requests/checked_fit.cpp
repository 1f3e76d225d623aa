// How what a command attaches lies beside what it is not watched against.
#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "monitor/requests/overlap.hpp"
#include "monitor/requests/scene_commander.hpp"

namespace clearance {

// A robot that would leap to its carrier was not meant, or is not where the cell has it.
SceneCommander::Refusal SceneCommander::check_leap(const CellChange& change, std::size_t place,
                                                   const Scene& changed) {
  const auto* attach = std::get_if<AttachRobot>(&change);
  const Scene& running = changer_.cell().scene;
  const Robot* robot = attach == nullptr ? nullptr : find_robot(running, attach->robot);
  if (robot == nullptr || attach->far) return std::nullopt;
  const std::string& root = robot->links.front().name;
  const auto poses =
      present_poses(with_carriers({root, attach->to}, changed), running, loop_, loop_ended_);
  if (!poses) return CommandRefusal{CommandStatus::kEnding, 0, "", "the daemon ends"};
  const auto before = poses->find(root);
  const PresentPose now = pose_in_changed(root, changed, running, *poses);
  using State = PresentPose::State;
  if (before == poses->end() || before->second.state != State::kUsable ||
      now.state != State::kUsable)
    return std::nullopt;
  const double leap =
      (now.world_from_body.position - before->second.world_from_body.position).norm();
  if (leap <= kFarFromCarrier) return std::nullopt;
  return CommandRefusal{
      CommandStatus::kRefused, place, fmt::format("robots[{}].attached.pose", robot->name),
      fmt::format("found '{}' {:.4g} m from where '{}' would carry it; expected at most {:g} m, or "
                  "far: true",
                  robot->name, leap, attach->to, kFarFromCarrier)};
}

SceneCommander::Refusal SceneCommander::check_overlaps(const Work& work, const Cell& cell) {
  for (std::size_t i = 0; i < work.changes.size(); ++i) {
    const auto stated = attachment_in(work.changes[i], cell.scene);
    if (!stated) continue;
    if (Refusal refusal = check_leap(work.changes[i], i, cell.scene)) return refusal;
    const auto attach = as_attached(*stated, std::span(work.changes).subspan(i + 1), cell.scene);
    if (!attach) continue;
    const std::vector<std::string> others = left_out_with(*attach, cell.scene);
    const Scene& running = changer_.cell().scene;
    // The change states the pose relative to the carrier, so that a lone carrier may be anywhere.
    const bool is_alone = others == std::vector<std::string>{attach->to};
    const auto poses =
        is_alone ? PresentPoses{}
                 : present_poses(with_carriers(others, cell.scene), running, loop_, loop_ended_);
    if (!poses) return CommandRefusal{CommandStatus::kEnding, 0, "", "the daemon ends"};
    PresentPoses changed;
    for (const std::string& name : others)
      changed[name] = pose_in_changed(name, cell.scene, running, *poses);
    const double most = attach->overlap.value_or(kDefaultOverlap);
    const Fit fit = fit_of(*attach, cell.scene, others, changed, mesh_errors_);
    const std::string path = fmt::format("objects[{}].attached.pose", attach->object);
    if (!attach->far && fit.distance > kFarFromCarrier && !fit.nearest.empty()) {
      return CommandRefusal{
          CommandStatus::kRefused, i, path,
          fmt::format(
              "found that it is {:.4g} m from '{}'; expected at most {:g} m from its carrier "
              "or from what it may touch, or far: true",
              fit.distance, fit.nearest, kFarFromCarrier)};
    }
    if (fit.depth <= most) continue;
    return CommandRefusal{
        CommandStatus::kOverlap, i, path,
        fmt::format("found that it overlaps '{}' by {:.4g} m; expected at most "
                    "{:.4g} m, or an 'overlap' of {:.4g} m",
                    fit.deepest, fit.depth, most, 1e-3 * std::ceil(1e3 * fit.depth))};
  }
  return std::nullopt;
}

}  // namespace clearance
