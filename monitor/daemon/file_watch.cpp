#include "monitor/daemon/file_watch.hpp"

#include <system_error>
#include <utility>

namespace clearance {

FileWatch::Look FileWatch::look_at(const std::filesystem::path& file) {
  std::error_code error;
  Look look;
  look.bytes = std::filesystem::file_size(file, error);
  if (error) return {};
  look.written = std::filesystem::last_write_time(file, error);
  return error ? Look{} : look;
}

void FileWatch::watch(const std::vector<std::filesystem::path>& files) {
  const Lock lock(mutex_);
  std::map<std::filesystem::path, Look> now;
  for (const std::filesystem::path& file : files) {
    const auto before = known_.find(file);
    now.emplace(file, before == known_.end() ? look_at(file) : before->second);
  }
  known_ = std::move(now);
  last_ = known_;
}

bool FileWatch::changed() {
  const Lock lock(mutex_);
  std::map<std::filesystem::path, Look> now;
  for (const auto& [file, look] : known_) now.emplace(file, look_at(file));
  const bool is_settled = now == last_;
  last_ = std::move(now);
  if (!is_settled || last_ == known_) return false;
  known_ = last_;
  return true;
}

}  // namespace clearance
