#include "monitor/bags/robot_description.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <system_error>

#include "config/revision.hpp"
#include "monitor/bags/bag.hpp"
#include "monitor/bags/ros_messages.hpp"
#include "monitor/files/file_error.hpp"

namespace clearance {
namespace {

// Nobody else may put files there. Nothing: somebody else has a folder of that name.
std::optional<std::filesystem::path> own_folder(std::string& error) {
  std::error_code none;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path(none) / fmt::format("clearance-{}", ::geteuid());
  ::mkdir(folder.c_str(), 0700);
  struct stat status {};
  const bool is_own = ::lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
                      status.st_uid == ::geteuid() && (status.st_mode & 077) == 0;
  if (is_own) return folder;
  error = fmt::format(
      "{} is no folder that only this user can write to; expected one there, for the robot's "
      "description, or TMPDIR to name another place",
      folder.string());
  return std::nullopt;
}

// Under another name first: somebody may be reading the file of an earlier run.
bool write_file(const std::filesystem::path& file, const std::string& text, std::string& error) {
  const std::filesystem::path part = fmt::format("{}.{}", file.string(), ::getpid());
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(part.c_str(), "wb"),
                                                            &std::fclose);
  const bool written = out && std::fwrite(text.data(), 1, text.size(), out.get()) == text.size() &&
                       std::fflush(out.get()) == 0;
  if (written && std::rename(part.c_str(), file.c_str()) == 0) return true;
  error = cannot_write(file);
  std::error_code none;
  std::filesystem::remove(part, none);
  return false;
}

}  // namespace

std::optional<std::string> robot_description(const std::filesystem::path& bag) {
  constexpr std::string_view kTopic = "robot_description";
  const std::unique_ptr<Bag> opened = open_bag(bag);
  BagMessage message;
  while (opened->next(message)) {
    const bool is_it = message.topic->name.ends_with(kTopic) && message.topic->type == kRosString &&
                       message.topic->encoding == "cdr";
    if (!is_it) continue;
    if (auto text = ros_string(message.payload)) return text;
  }
  return std::nullopt;
}

std::optional<std::filesystem::path> robot_description_file(const std::filesystem::path& bag,
                                                            std::string& error) {
  const std::optional<std::string> text = robot_description(bag);
  if (!text) {
    error = fmt::format("{} has no robot_description", bag.string());
    return std::nullopt;
  }
  const auto folder = own_folder(error);
  if (!folder) return std::nullopt;
  Revision revision;
  revision.add(*text);
  const std::filesystem::path file = *folder / fmt::format("{:016x}.urdf", revision.value());
  return write_file(file, *text, error) ? std::optional(file) : std::nullopt;
}

}  // namespace clearance
