// Does commands, one after another: edits the text of the cell, checks the result, and has the loop
// tick it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/edit/cell_editor.hpp"
#include "config/mesh/mesh_parts.hpp"
#include "monitor/interface/command.hpp"
#include "monitor/requests/command_refusal.hpp"
#include "monitor/requests/present_poses.hpp"
#include "monitor/requests/scene_changer.hpp"
#include "monitor/requests/sent_files.hpp"

namespace clearance {

struct CommanderOptions {
  // The options with which the cell was read, and is read after each change. The objects that they
  // refer to must outlive the commander.
  CellOptions reading = {};
  // Adds to a cell what the command line of the program asks for. May be empty.
  std::function<void(Cell&)> finish = {};
  // Makes the text of a cell that has no file, as its robot's files say now. Empty: the text is
  // that of Cell::file.
  std::function<std::string()> own_text = {};
  // Keeps every accepted scene in this file (kept_scene.hpp). Empty: none is kept.
  std::filesystem::path keep_scene = {};
  std::uint64_t began_with = 0;  // revision of the cell file at the start, for keep_scene
};

// Only the preparing thread may use it.
class SceneCommander {
 public:
  // The arguments must outlive this. `loop_ended`: see SceneChanger::change().
  SceneCommander(SceneChanger& changer, TickLoop& loop, const std::atomic<bool>& loop_ended,
                 CommanderOptions options);

  // Does the command, or refuses it and changes nothing. `is_own`: the daemon's own, which may name
  // any file. `may_change` is called once, before the scene changes, after everything that can take
  // long; if it returns false, the command is refused because the program ends. `complete` may be
  // empty.
  [[nodiscard]] CommandResult execute(const Command& command, bool is_own,
                                      const std::function<bool()>& may_change,
                                      const CompleteChanges& complete = {});

  // Meshes that the last command wants and that are not read here: it was not done, and has no
  // result. They are to be read in another thread, and the command executed again with them.
  // Empty: it was done.
  [[nodiscard]] const std::vector<MeshUse>& wanted() const noexcept { return ahead_.wanted; }
  // The next execute() has these meshes, and reads what else it needs itself. Null: it wants those
  // that it does not have.
  void set_read_meshes(std::shared_ptr<const ReadMeshes> meshes) {
    ahead_.asks = meshes == nullptr;
    ahead_.read = std::move(meshes);
  }
  // Reads meshes in any thread, as the cell in force would.
  [[nodiscard]] std::function<std::shared_ptr<const ReadMeshes>()> reader_of_wanted() const;

  // Keeps the files of a command for a cell that another daemon makes, and this one takes over.
  [[nodiscard]] CommandResult keep_files(const std::vector<SentFile>& files) {
    std::string reason = sent_.keep_awaited(files);
    const auto status = reason.empty() ? CommandStatus::kDone : CommandStatus::kFileRefused;
    return {.status = status, .reason = std::move(reason)};
  }

  // Reads the text in force if clients may send commands: the first of them is then as fast as
  // others.
  void read_ahead();

  // The cell in force.
  [[nodiscard]] const Cell& cell() const noexcept { return changer_.cell(); }
  // Returns where an object or a link is now, in the world; nothing if the scene has none of this
  // name, or the loop ends.
  [[nodiscard]] std::optional<PresentPose> present_pose(const std::string& name);

  [[nodiscard]] std::uint64_t revision() const noexcept { return changer_.cell().scene.revision; }

 private:
  using Refusal = std::optional<CommandRefusal>;
  // A command with all that its changes leave to the daemon.
  struct Work {
    const Command& command;
    bool is_own;
    std::vector<CellChange> changes;
    std::uint64_t began_with;  // of the scene that is kept
    const CompleteChanges& complete;
  };
  Refusal do_all(Work& work, const std::function<bool()>& may_change, CommandResult& result);
  Refusal open(std::span<const CellChange> changes);
  Refusal take_files(Work& work);
  Refusal take_texts(Work& work);
  Refusal take_poses(Work& work);
  Refusal take_positions(Work& work);
  std::variant<Pose, CommandRefusal> pose_of(const std::string& name, const Work& work,
                                             std::size_t change, const PresentPoses& poses);
  Refusal check(const Work& work, const Cell& cell);
  // Returns why a client's command may not have this file read; nothing: it may.
  std::optional<std::string> refusal_of(const std::filesystem::path& file);
  Refusal check_leap(const CellChange& change, std::size_t place, const Scene& changed);
  Refusal check_overlaps(const Work& work, const Cell& cell);
  Refusal put_in_force(const Work& work, Cell cell);
  [[nodiscard]] bool is_allowed(const std::filesystem::path& file) const;

  SceneChanger& changer_;
  TickLoop& loop_;
  const std::atomic<bool>& loop_ended_;
  CommanderOptions options_;
  std::size_t most_bytes_;
  SentFiles sent_;
  std::map<std::string, double> mesh_errors_;
  std::optional<CellEditor> editor_;  // opened by read_ahead() or the first command
  std::uint64_t in_force_from_ = 0;
  MeshesAhead ahead_;
  bool may_read_all_ = true;  // the command in hand is the daemon's own
  std::string not_read_;      // why a file that this command names was not read; empty: all were
};

}  // namespace clearance
