// Explains errno in words, with the path and a remedy.
#include "monitor/files/file_error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

namespace clearance {
namespace {

// errno must be read before another call changes it.
std::string system_reason() { return std::system_category().message(errno); }

// The fault of an existing file of an unusual kind; otherwise errno's text.
std::string reason_for(const std::filesystem::path& file) {
  std::string reason = system_reason();
  std::error_code unknown;
  const std::filesystem::file_status status = std::filesystem::status(file, unknown);
  if (std::filesystem::is_directory(status)) return "it is a directory; expected a file";
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    return "it is no regular file; expected one";
  return reason;
}

}  // namespace

std::string cannot_read(const std::filesystem::path& file) {
  return fmt::format("cannot read {}: {}", file.string(), reason_for(file));
}

std::string cannot_create(const std::filesystem::path& file) {
  return fmt::format("cannot create {}: {}", file.string(), reason_for(file));
}

std::string cannot_write(const std::filesystem::path& file) {
  return fmt::format("cannot write to {}: {}", file.string(), system_reason());
}

}  // namespace clearance
