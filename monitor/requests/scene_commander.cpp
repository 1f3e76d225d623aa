#include "monitor/requests/scene_commander.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <system_error>
#include <type_traits>
#include <utility>

#include "config/text/spelling.hpp"
#include "monitor/requests/kept_scene.hpp"
#include "monitor/requests/overlap.hpp"

namespace clearance {
namespace {

// The text and the files that it names. A file that has gone counts as empty.
std::size_t bytes_of(const Cell& cell) {
  std::size_t bytes = cell.yaml.size();
  for (const std::filesystem::path& file : cell.files) {
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    if (!error) bytes += size;
  }
  return bytes;
}

// Tells whether a change may put one of these bodies elsewhere, or make it absent.
struct MayMove {
  const std::vector<std::string>& bodies;
  bool operator()(const AddObject&) const { return true; }
  bool operator()(const ReplaceObject&) const { return true; }
  bool operator()(const ReplaceCell&) const { return true; }
  bool operator()(const AddFromTemplate& change) const { return has(change.object); }
  bool operator()(const RemoveObject& change) const { return has(change.object); }
  bool operator()(const SetAbsent& change) const { return has(change.object); }
  bool operator()(const Attach& change) const { return has(change.object); }
  bool operator()(const Detach& change) const { return has(change.object); }
  bool operator()(const Place& change) const { return has(change.object); }
  template <class Change>
  bool operator()(const Change&) const {
    return false;
  }
  [[nodiscard]] bool has(const std::string& name) const {
    return std::ranges::find(bodies, name) != bodies.end();
  }
};

CommandRefusal no_pose(std::size_t change, const std::string& object, std::string reason) {
  return {CommandStatus::kNoPose, change, fmt::format("objects[{}].pose", object),
          std::move(reason)};
}

}  // namespace

SceneCommander::SceneCommander(SceneChanger& changer, TickLoop& loop,
                               const std::atomic<bool>& loop_ended, CommanderOptions options)
    : changer_(changer),
      loop_(loop),
      loop_ended_(loop_ended),
      options_(std::move(options)),
      most_bytes_(bytes_of(changer.cell()) + changer.cell().capacity.bytes),
      sent_(changer.cell().file) {
  options_.reading.mesh_errors = &mesh_errors_;
  options_.reading.meshes_ahead = &ahead_;
  options_.reading.may_read = [this](const std::filesystem::path& file) {
    return refusal_of(file);
  };
}

// A text that cannot be read is refused with the first command.
void SceneCommander::read_ahead() {
  if (cell().commands.from.empty() && !cell().ros.moveit.any()) return;
  try {
    (void)open({});
  } catch (const std::exception&) {
    editor_.reset();
  }
}

CommandResult SceneCommander::execute(const Command& command, bool is_own,
                                      const std::function<bool()>& may_change,
                                      const CompleteChanges& complete) {
  CommandResult result{.client = command.client, .request = command.request};
  Work work{command, is_own, command.changes, options_.began_with, complete};
  Refusal refusal;
  may_read_all_ = is_own;
  not_read_.clear();
  ahead_.wanted.clear();
  try {
    refusal = do_all(work, may_change, result);
  } catch (const std::exception& error) {
    refusal = CommandRefusal{CommandStatus::kFailed, 0, "", error.what()};
    editor_.reset();
  }
  if (refusal) {
    sent_.take_back();
    ahead_.wanted.clear();
    result.status = refusal->status;
    result.change = static_cast<std::uint32_t>(refusal->change);
    result.path = std::move(refusal->path);
    result.reason = std::move(refusal->reason);
  }
  if (refusal || !command.dry_run) {
    result.scene_revision = revision();
    result.in_force_from = in_force_from_;
  }
  return result;
}

SceneCommander::Refusal SceneCommander::do_all(Work& work, const std::function<bool()>& may_change,
                                               CommandResult& result) {
  const std::uint64_t known = work.command.scene_revision;
  if (known != 0 && known != revision()) {
    return CommandRefusal{CommandStatus::kOtherRevision, 0, "",
                          fmt::format("found the revision {:016x}; expected {:016x}, which is in "
                                      "force",
                                      known, revision())};
  }
  if (Refusal refusal = take_files(work)) return refusal;
  if (Refusal refusal = take_texts(work)) return refusal;
  if (Refusal refusal = open(work.changes)) return refusal;
  if (Refusal refusal = take_poses(work)) return refusal;
  auto proposed = editor_->propose(work.changes, work.complete);
  if (!ahead_.wanted.empty() && std::holds_alternative<Cell>(proposed)) {
    // The other thread reads files that came with the command where they are kept.
    sent_.take_back();
    if (std::string reason = sent_.keep_awaited(work.command.files); !reason.empty())
      return CommandRefusal{CommandStatus::kFileRefused, 0, "files", std::move(reason)};
    editor_->take_back();
    return std::nullopt;
  }
  ahead_.wanted.clear();
  if (auto* refused = std::get_if<EditRefusal>(&proposed)) {
    if (!not_read_.empty()) {
      return CommandRefusal{CommandStatus::kFileRefused, refused->change, std::move(refused->path),
                            std::move(not_read_)};
    }
    return CommandRefusal{CommandStatus::kRefused, refused->change, std::move(refused->path),
                          std::move(refused->reason)};
  }
  Cell cell = std::get<Cell>(std::move(proposed));
  if (options_.finish) options_.finish(cell);
  Refusal refusal = check(work, cell);
  if (!refusal && work.command.dry_run) {
    result.scene_revision = cell.scene.revision;
    sent_.take_back();
    editor_->take_back();
    return std::nullopt;
  }
  if (!refusal && !may_change())
    refusal = CommandRefusal{CommandStatus::kEnding, 0, "", "the daemon ends"};
  if (!refusal) refusal = put_in_force(work, std::move(cell));
  if (refusal) {
    editor_->take_back();
  } else {
    editor_->keep();
  }
  return refusal;
}

// If the text in force cannot be read any more, because a file of it has gone, a whole cell can
// still replace it.
SceneCommander::Refusal SceneCommander::open(std::span<const CellChange> changes) {
  if (editor_) return std::nullopt;
  const Cell& cell = changer_.cell();
  // What is in force is read here.
  const bool asks = std::exchange(ahead_.asks, false);
  auto opened = CellEditor::open(cell.yaml, cell.file, options_.reading);
  const auto* whole = changes.empty() ? nullptr : std::get_if<ReplaceCell>(&changes.front());
  if (std::holds_alternative<std::vector<CellError>>(opened) && whole != nullptr)
    opened = CellEditor::open(whole->yaml, cell.file, options_.reading);
  ahead_.asks = asks;
  if (const auto* errors = std::get_if<std::vector<CellError>>(&opened)) {
    return CommandRefusal{whole == nullptr ? CommandStatus::kFileRefused : CommandStatus::kRefused,
                          0, "", errors->front().text};
  }
  editor_.emplace(std::get<CellEditor>(std::move(opened)));
  return std::nullopt;
}

// The pose of a body after the changes before this one, as if they had been made one by one.
std::variant<Pose, CommandRefusal> SceneCommander::pose_of(const std::string& name,
                                                           const Work& work, std::size_t change,
                                                           const PresentPoses& poses) {
  const Scene& running = changer_.cell().scene;
  const auto before = std::span(work.changes).first(change);
  const std::vector<std::string> bodies = with_carriers({name}, running);
  PresentPose pose;
  const auto present = poses.find(name);
  bool is_known = present != poses.end();
  if (is_known) pose = present->second;
  if (std::ranges::any_of(
          before, [&](const CellChange& each) { return std::visit(MayMove{bodies}, each); })) {
    const auto read = editor_->dry_run(before);
    if (const auto* refused = std::get_if<EditRefusal>(&read)) {
      return CommandRefusal{CommandStatus::kRefused, refused->change, refused->path,
                            refused->reason};
    }
    const Scene& changed = std::get<Cell>(read).scene;
    is_known = is_known || find_object(changed, name) != nullptr;
    pose = pose_in_changed(name, changed, running, poses);
  }
  if (!is_known) {
    std::vector<std::string> names;
    for (const Object& object : running.objects) names.push_back(object.name);
    for (const Robot& robot : running.robots) {
      for (const RobotLink& link : robot.links) names.push_back(link.name);
    }
    return CommandRefusal{CommandStatus::kRefused, change, fmt::format("objects[{}]", name),
                          fmt::format("found no object or link '{}' in the scene; expected one{}",
                                      name, did_you_mean(name, names))};
  }
  if (pose.state == PresentPose::State::kUsable) return pose.world_from_body;
  return no_pose(change, name,
                 fmt::format("found that '{}' is not known to be anywhere, since {}; expected a "
                             "pose that is known now, or one in the change",
                             name, why_unusable(pose)));
}

// All poses are of one tick, so that a carrier that moves takes the object with it exactly.
std::optional<PresentPose> SceneCommander::present_pose(const std::string& name) {
  const auto poses = present_poses({name}, cell().scene, loop_, loop_ended_);
  if (!poses || !poses->contains(name)) return std::nullopt;
  return poses->at(name);
}

SceneCommander::Refusal SceneCommander::take_poses(Work& work) {
  std::vector<std::string> names;
  bool are_stated = true;
  for (const CellChange& change : work.changes) {
    if (const auto* attach = std::get_if<Attach>(&change)) {
      names.insert(names.end(), {attach->object, attach->to});
      are_stated = are_stated && attach->carrier_from_object;
    }
    if (const auto* detach = std::get_if<Detach>(&change)) {
      names.push_back(detach->object);
      are_stated = are_stated && detach->world_from_object;
    }
  }
  if (are_stated) return std::nullopt;
  const Scene& running = changer_.cell().scene;
  const auto poses = present_poses(with_carriers(names, running), running, loop_, loop_ended_);
  if (!poses) return CommandRefusal{CommandStatus::kEnding, 0, "", "the daemon ends"};
  for (std::size_t i = 0; i < work.changes.size(); ++i) {
    if (auto* attach = std::get_if<Attach>(&work.changes[i]);
        attach != nullptr && !attach->carrier_from_object) {
      auto object = pose_of(attach->object, work, i, *poses);
      if (auto* refusal = std::get_if<CommandRefusal>(&object)) return std::move(*refusal);
      auto carrier = pose_of(attach->to, work, i, *poses);
      if (auto* refusal = std::get_if<CommandRefusal>(&carrier)) return std::move(*refusal);
      attach->carrier_from_object = a_from_b(std::get<Pose>(carrier), std::get<Pose>(object));
    }
    if (auto* detach = std::get_if<Detach>(&work.changes[i]);
        detach != nullptr && !detach->world_from_object) {
      auto object = pose_of(detach->object, work, i, *poses);
      if (auto* refusal = std::get_if<CommandRefusal>(&object)) return std::move(*refusal);
      detach->world_from_object = std::get<Pose>(object);
    }
  }
  return std::nullopt;
}

SceneCommander::Refusal SceneCommander::check(const Work& work, const Cell& cell) {
  if (const std::size_t bytes = bytes_of(cell); bytes > most_bytes_) {
    return CommandRefusal{CommandStatus::kBeyondCapacity, 0, "",
                          fmt::format("found {} bytes of the cell and its files; expected at most "
                                      "{} (capacity: bytes)",
                                      bytes, most_bytes_)};
  }
  if (cell.scene.revision == revision()) return std::nullopt;
  if (auto checked = changer_.check(cell); !checked.refusal.empty())
    return CommandRefusal{checked.status, 0, "", std::move(checked.refusal)};
  return check_overlaps(work, cell);
}

SceneCommander::Refusal SceneCommander::check_overlaps(const Work& work, const Cell& cell) {
  for (std::size_t i = 0; i < work.changes.size(); ++i) {
    const auto* stated = std::get_if<Attach>(&work.changes[i]);
    if (stated == nullptr) continue;
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
    return CommandRefusal{CommandStatus::kOverlap, i, path,
                          fmt::format("found that it overlaps '{}' by {:.4g} m; expected at most "
                                      "{:.4g} m (overlap)",
                                      fit.deepest, fit.depth, most)};
  }
  return std::nullopt;
}

// The scene is kept before it is in force: what a client was told is then never lost. If the loop
// refuses it, the former one is kept again.
SceneCommander::Refusal SceneCommander::put_in_force(const Work& work, Cell cell) {
  const auto keep = [&](std::uint64_t began_with, const std::string& yaml) {
    return options_.keep_scene.empty() ? std::string()
                                       : keep_scene(options_.keep_scene, {began_with, yaml});
  };
  const std::string former = changer_.cell().yaml;
  // A folder that cannot be synchronised may hold the new text already.
  if (std::string reason = keep(work.began_with, cell.yaml); !reason.empty()) {
    (void)keep(options_.began_with, former);
    return CommandRefusal{CommandStatus::kFailed, 0, "", std::move(reason)};
  }
  const std::vector<std::filesystem::path> files = cell.files;
  if (cell.scene.revision == revision()) {
    options_.began_with = work.began_with;
    sent_.settle(files);
    return std::nullopt;
  }
  SceneChanger::Outcome outcome;
  try {
    outcome = changer_.change(std::make_shared<const Cell>(std::move(cell)), loop_ended_);
  } catch (const std::exception& error) {
    outcome = {.status = CommandStatus::kFailed, .refusal = error.what()};
  }
  if (!outcome.refusal.empty()) {
    std::string reason = outcome.refusal;
    if (std::string also = keep(options_.began_with, former); !also.empty())
      reason += "; and " + also;
    return CommandRefusal{outcome.status, 0, "", std::move(reason)};
  }
  options_.began_with = work.began_with;
  in_force_from_ = outcome.in_force_from;
  sent_.settle(files);
  return std::nullopt;
}

}  // namespace clearance
