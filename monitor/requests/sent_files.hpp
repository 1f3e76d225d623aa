// Files that commands send along, kept in a folder by their content.
//
// The changed text of the cell names them there, so that it can be read again: by the daemon, from
// a recording, or after a restart.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "monitor/interface/command.hpp"

namespace clearance {

class SentFiles {
 public:
  // The folder is `clearance.sent` beside the cell. It is made when the first file comes.
  explicit SentFiles(const std::filesystem::path& cell_file);

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  // Keeps these files. Returns their paths relative to the cell's folder, by the names under which
  // they were sent, or why one cannot be kept.
  [[nodiscard]] std::variant<std::map<std::string, std::string>, std::string> keep(
      const std::vector<SentFile>& files);
  // Removes what the last keep() wrote, since no cell names it.
  void take_back();
  // Keeps files while a cell may come that names them: another daemon does the command, and this
  // one takes the cell over from it. The oldest ones that no cell has named go once there are those
  // of more than kAwaited commands, or more than kAwaitedBytes. Returns why one cannot be kept.
  [[nodiscard]] std::string keep_awaited(const std::vector<SentFile>& files);
  static constexpr std::size_t kAwaited = 64, kAwaitedBytes = 128 << 20;
  // A cell that names these files is in force, so those of the last keep() stay. Files that this
  // object wrote and none of the last kScenes cells names are removed. Until then a recording can
  // still read them.
  void settle(const std::vector<std::filesystem::path>& named);
  static constexpr std::size_t kScenes = 8;

 private:
  using Paths = std::set<std::filesystem::path>;
  struct Awaited {
    Paths paths;
    std::size_t bytes = 0;
  };
  [[nodiscard]] bool is_awaited(const std::filesystem::path& file) const;
  void drop_oldest_awaited();

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> written_;  // by the last keep()
  std::deque<Awaited> awaited_;                 // of the last commands of another daemon
  Paths settled_;                               // written, and named by a cell since
  std::deque<Paths> named_;                     // by the last cells, of settled_
};

// The text with each "sent:NAME" replaced by the path of that name. Names that were not sent stay,
// and the reader of the cell refuses them.
[[nodiscard]] std::string with_paths(const std::string& yaml,
                                     const std::map<std::string, std::string>& paths);

}  // namespace clearance
