#include "monitor/requests/scene_commander.hpp"

#include <fmt/format.h>

#include <exception>
#include <system_error>
#include <utility>

#include "monitor/requests/kept_scene.hpp"

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
