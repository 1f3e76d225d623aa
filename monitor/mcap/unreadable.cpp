#include "monitor/mcap/unreadable.hpp"

#include <cerrno>
#include <system_error>

namespace clearance {

std::string unreadable(const std::filesystem::path& file) {
  std::string reason = std::system_category().message(errno);
  std::error_code unknown;
  const std::filesystem::file_status status = std::filesystem::status(file, unknown);
  if (std::filesystem::is_directory(status)) {
    reason = "it is a directory; expected a file";
  } else if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    reason = "it is no regular file; expected one";
  }
  return "cannot read " + file.string() + ": " + reason;
}

}  // namespace clearance
