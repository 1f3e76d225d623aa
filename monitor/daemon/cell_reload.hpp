// Reads the cell's file again, after SIGHUP or when a file of the cell has changed.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/daemon/file_watch.hpp"
#include "monitor/daemon/service_manager.hpp"
#include "monitor/interface/command.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/requests/scene_task.hpp"

namespace clearance {

// Only the daemon that others follow reads the file. The others get the cell from it. One thread
// calls this; results come in the scene thread.
class CellReload {
 public:
  struct Actions {
    // Names the daemon that this one follows; empty: none; nothing: it is not known yet.
    std::function<std::optional<std::string>()> followed;
    // Hands a command to the scene thread. Returns false if too many wait.
    std::function<bool(GivenCommand)> put;
    // Returns false if the cell has not changed by this command.
    std::function<bool(const CommandResult&)> note_change;
    std::function<std::vector<std::filesystem::path>()> files;  // of the cell in force
    // Lists the mistakes of the file for a person. May be empty.
    std::function<void()> list_mistakes;
  };
  // `watches`: poll() reads the file again once it, or one that the cell names, has changed. The
  // service gets word of each reading, and outlives this.
  CellReload(const Cell& cell, bool watches, ServiceManager& service, Actions actions);

  // `cause` is for the log, and outlives this.
  void read_again(std::string_view cause = "SIGHUP came");
  // To be called about twice a second.
  void poll();

 private:
  void answer(const CommandResult& result);
  void refuse(const std::string& why, const std::string& told);
  [[nodiscard]] bool have_files_changed();
  void watch(std::vector<std::filesystem::path> files);

  const std::string file_;
  const bool watches_;
  ServiceManager& service_;
  const Actions actions_;
  FileWatch watch_;
  bool is_due_ = false;  // it could not be read yet
  std::string_view cause_;
  Mutex mutex_;
  // The files of the cell that was read again.
  GUARDED_BY(mutex_) std::optional<std::vector<std::filesystem::path>> read_files_;
};

}  // namespace clearance
