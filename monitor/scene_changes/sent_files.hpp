// Files that commands send along, kept in a folder by their content.
//
// The changed text of the cell names them there, so that it can be read again: by the daemon, from
// a recording, or after a restart.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "monitor/command.hpp"

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

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> written_;  // by the last keep()
};

// The text with each "sent:NAME" replaced by the path of that name. Names that were not sent stay,
// and the reader of the cell refuses them.
[[nodiscard]] std::string with_paths(const std::string& yaml,
                                     const std::map<std::string, std::string>& paths);

}  // namespace clearance
