#include "monitor/files/numbered_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string>
#include <system_error>

namespace clearance {

bool is_taken(const std::filesystem::path& file) {
  std::error_code unknown;
  return std::filesystem::exists(std::filesystem::symlink_status(file, unknown));
}

// A number with more than six digits is a date, and part of the name.
std::filesystem::path next_number(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t dash = stem.rfind('-');
  std::string name = stem;
  int number = 1;
  if (dash != std::string::npos && dash > 0 && stem.size() - dash <= 7) {
    const char* const end = stem.data() + stem.size();
    int found = 0;
    const auto parsed = std::from_chars(stem.data() + dash + 1, end, found);
    if (parsed.ec == std::errc{} && parsed.ptr == end && found > 1) {
      name = stem.substr(0, dash);
      number = found;
    }
  }
  std::filesystem::path next = file;
  next.replace_filename(fmt::format("{}-{}{}", name, number + 1, file.extension().string()));
  return next;
}

std::filesystem::path first_free(const std::filesystem::path& file) {
  std::filesystem::path free = file;
  while (is_taken(free)) free = next_number(free);
  return free;
}

}  // namespace clearance
