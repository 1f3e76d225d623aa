// Compares files by identity (device and inode) where they exist, so that links and relative paths
// are recognised.
#include "monitor/app/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "monitor/app/print.hpp"
#include "monitor/files/numbered_file.hpp"

namespace clearance {
namespace {

// Every output needs its folder.
bool has_folder(const char* program, const std::filesystem::path& file) {
  std::error_code unknown;
  if (!file.has_parent_path() || std::filesystem::exists(file.parent_path(), unknown)) return true;
  print(stderr, "{}: cannot create {}: there is no folder {}\n", program, file.string(),
        file.parent_path().string());
  return false;
}

}  // namespace

// An output that does not exist yet equals no input.
bool output_is_not_an_input(const char* program, const std::filesystem::path& output,
                            std::initializer_list<std::filesystem::path> inputs) {
  std::error_code missing;  // a file that does not exist differs from every other file
  for (const std::filesystem::path& input : inputs) {
    if (!std::filesystem::equivalent(output, input, missing)) continue;
    print(stderr, "{}: {} is a file that is read; expected another one to write\n", program,
          output.string());
    return false;
  }
  return true;
}

// A file may still appear between this check and its creation; the check is for mistakes, not for
// races.
bool can_create(const char* program, const std::filesystem::path& file, bool force) {
  std::error_code unknown;
  if (!has_folder(program, file)) return false;
  if (force || file.empty() || !std::filesystem::exists(file, unknown)) return true;
  print(stderr, "{}: {} exists; --force overwrites it\n", program, file.string());
  return false;
}

// A program that starts again after a crash, with the same arguments, finds the file of the earlier
// run.
std::optional<std::filesystem::path> free_name(const char* program,
                                               const std::filesystem::path& file, bool force) {
  if (!has_folder(program, file)) return std::nullopt;
  if (file.empty() || !is_taken(file)) return file;
  std::error_code unknown;
  if (std::filesystem::exists(file, unknown) && !std::filesystem::is_regular_file(file, unknown)) {
    print(stderr, "{}: {} is no regular file; expected one\n", program, file.string());
    return std::nullopt;
  }
  return force ? file : first_free(file);
}

bool write_file(const char* program, const std::filesystem::path& file, std::string_view text) {
  std::FILE* const out = std::fopen(file.c_str(), "w");
  const bool is_whole =
      out != nullptr && std::fwrite(text.data(), 1, text.size(), out) == text.size();
  if ((out == nullptr || std::fclose(out) == 0) && is_whole) return true;
  print(stderr, "{}: {} cannot be written: {}\n", program, file.string(), std::strerror(errno));
  return false;
}

// Devices and pipes (/dev/stdout) are left alone.
void remove_unfinished(const char* program, const std::filesystem::path& file) {
  std::error_code failed;
  const bool regular =
      std::filesystem::is_regular_file(std::filesystem::symlink_status(file, failed));
  const bool removed = regular && std::filesystem::remove(file, failed);
  print(stderr, "{}: {} was not finished{}\n", program, file.string(),
        removed ? " and is removed" : "; its content is incomplete");
}

}  // namespace clearance
