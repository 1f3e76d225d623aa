// Puts errno into words, with the path and what a person can do.
#include "monitor/files/file_error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

namespace clearance {
namespace {

// Has to be called before anything else changes errno.
std::string system_reason() { return std::system_category().message(errno); }

}  // namespace

std::string cannot_read(const std::filesystem::path& file) {
  std::string reason = system_reason();
  std::error_code unknown;
  const std::filesystem::file_status status = std::filesystem::status(file, unknown);
  if (std::filesystem::is_directory(status)) {
    reason = "it is a directory; expected a file";
  } else if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    reason = "it is no regular file; expected one";
  }
  return fmt::format("cannot read {}: {}", file.string(), reason);
}

std::string cannot_create(const std::filesystem::path& file) {
  return fmt::format("cannot create {}: {}", file.string(), system_reason());
}

std::string cannot_write(const std::filesystem::path& file) {
  return fmt::format("cannot write to {}: {}", file.string(), system_reason());
}

}  // namespace clearance
