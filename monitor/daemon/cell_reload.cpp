#include "monitor/daemon/cell_reload.hpp"

#include <fmt/format.h>

#include <utility>

#include "monitor/app/log_line.hpp"

namespace clearance {

CellReload::CellReload(const Cell& cell, bool watches, ServiceManager& service, Actions actions)
    : file_(cell.file.string()),
      watches_(watches),
      service_(service),
      actions_(std::move(actions)) {
  watch(cell.files);
}

// The cell's own file counts even where another text is in force.
void CellReload::watch(std::vector<std::filesystem::path> files) {
  files.emplace_back(file_);
  watch_.watch(files);
}

void CellReload::poll() {
  if (have_files_changed())
    read_again("a file of the cell has changed");
  else if (is_due_)
    read_again(cause_);
}

// A cell that was read again may name other files.
bool CellReload::have_files_changed() {
  std::optional<std::vector<std::filesystem::path>> read;
  {
    const Lock lock(mutex_);
    read = std::exchange(read_files_, std::nullopt);
  }
  if (read) watch(*std::move(read));
  return watches_ && watch_.changed();
}

void CellReload::read_again(std::string_view cause) {
  cause_ = cause;
  const std::optional<std::string> followed = actions_.followed();
  is_due_ = !followed;
  if (is_due_) return;
  log_line(lines::kReading, cause_, file_);
  service_.reloading();
  if (!followed->empty()) {
    const std::string counts = fmt::format("the cell of {} counts", *followed);
    return refuse(counts + ": have that one read it", counts);
  }
  is_due_ = !actions_.put({.command = {.client = "", .changes = {ReadCellAgain{}}},
                           .is_own = true,
                           .answer = [this](const CommandResult& result) { answer(result); }});
  if (is_due_)
    refuse("too many commands wait: it is tried again",
           "the cell waits to be read again: see the log");
}

void CellReload::refuse(const std::string& why, const std::string& told) {
  log_line(lines::kSceneRefused, why);
  service_.reloaded(told);
}

void CellReload::answer(const CommandResult& result) {
  if (!result.done()) {
    const bool has_mistakes = result.status == CommandStatus::kRefused && actions_.list_mistakes;
    if (has_mistakes) actions_.list_mistakes();
    return refuse(has_mistakes ? "its mistakes are listed above" : result.reason,
                  "the changed cell was refused: see the log");
  }
  {
    const Lock lock(mutex_);
    read_files_ = actions_.files();
  }
  const bool is_new = actions_.note_change(result);
  if (!is_new) log_line(lines::kSceneUnchanged);
  service_.reloaded(is_new ? "the changed cell is in force" : "the cell has not changed");
}

}  // namespace clearance
