// The files that a command sends or names: which may be read, and which another thread reads.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "config/text/file_bytes.hpp"
#include "monitor/requests/scene_commander.hpp"

namespace clearance {
namespace {

bool begins_with(const std::filesystem::path& file, const std::filesystem::path& folder) {
  return std::ranges::mismatch(folder, file).in1 == folder.end() && file != folder;
}

// The names decide first, so that no other file is touched; then where links lead.
bool is_below(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code error;
  const auto real_folder = std::filesystem::weakly_canonical(folder, error);
  if (error) return false;
  const auto named = std::filesystem::absolute(file).lexically_normal();
  if (!begins_with(named, std::filesystem::absolute(folder).lexically_normal()) &&
      !begins_with(named, real_folder))
    return false;
  const auto real_file = std::filesystem::weakly_canonical(file, error);
  return !error && begins_with(real_file, real_folder);
}

}  // namespace

SceneCommander::Refusal SceneCommander::take_files(Work& work) {
  if (work.command.files.empty()) return std::nullopt;
  auto kept = sent_.keep(work.command.files);
  if (auto* reason = std::get_if<std::string>(&kept))
    return CommandRefusal{CommandStatus::kFileRefused, 0, "files", std::move(*reason)};
  const auto& paths = std::get<std::map<std::string, std::string>>(kept);
  for (CellChange& change : work.changes) {
    std::visit(
        [&](auto& each) {
          if constexpr (requires { each.yaml; }) each.yaml = with_paths(each.yaml, paths);
        },
        change);
  }
  return std::nullopt;
}

SceneCommander::Refusal SceneCommander::take_texts(Work& work) {
  const std::filesystem::path& own = changer_.cell().file;
  for (std::size_t i = 0; i < work.changes.size(); ++i) {
    const auto* again = std::get_if<ReadCellAgain>(&work.changes[i]);
    if (again == nullptr) continue;
    const bool is_own = again->file.empty();
    const std::filesystem::path file = is_own ? own : own.parent_path() / again->file;
    const auto refused = [&](std::string reason) {
      return CommandRefusal{CommandStatus::kFileRefused, i, "file", std::move(reason)};
    };
    if (!is_own && !work.is_own && !is_allowed(file)) {
      return refused(
          fmt::format("found '{}'; expected a file below one of the folders that the "
                      "cell states (commands: folders)",
                      file.string()));
    }
    std::string text;
    if (is_own && options_.own_text) {
      text = options_.own_text();
    } else {
      auto read = read_bytes(file.string());
      if (auto* fault = std::get_if<FileFault>(&read)) return refused(std::move(fault->reason));
      text = std::get<std::string>(std::move(read));
    }
    work.changes[i] = ReplaceCell{std::move(text)};
    if (!is_own || options_.keep_scene.empty()) continue;
    if (Refusal refusal = open(work.changes)) return refusal;
    const auto read = editor_->dry_run(std::span(work.changes).subspan(i, 1));
    if (const auto* cell = std::get_if<Cell>(&read)) work.began_with = cell->scene.revision;
  }
  return std::nullopt;
}

std::function<std::shared_ptr<const ReadMeshes>()> SceneCommander::reader_of_wanted() const {
  return [file = changer_.cell().file, root = options_.reading.root, tell = options_.reading.tell,
          advice = options_.reading.is_of_urdf ? Advice::kUrdf : Advice::kCell,
          meshes = ahead_.wanted] { return read_meshes(file, root, tell, advice, meshes); };
}

bool SceneCommander::is_allowed(const std::filesystem::path& file) const {
  return is_below(file, sent_.folder()) ||
         std::ranges::any_of(changer_.cell().commands.folders,
                             [&](const auto& folder) { return is_below(file, folder); });
}

// Files that the cell in force names are the daemon's. The answer does not tell what is there.
std::optional<std::string> SceneCommander::refusal_of(const std::filesystem::path& file) {
  const auto path = std::filesystem::absolute(file).lexically_normal();
  const auto& known = changer_.cell().files;
  if (may_read_all_ || std::ranges::find(known, path) != known.end() || is_allowed(path))
    return std::nullopt;
  not_read_ = fmt::format(
      "found '{}'; expected a file below one of the folders that the cell "
      "states (commands: folders), or one that is sent",
      path.string());
  return not_read_;
}

}  // namespace clearance
