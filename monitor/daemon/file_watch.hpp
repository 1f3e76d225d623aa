// Notices that files have changed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "monitor/interface/mutex.hpp"

namespace clearance {

// Any thread. Files are compared by their size and the time of their last write.
class FileWatch {
 public:
  // Watches these files from now on, and no others. A file that was watched before counts as
  // changed since then.
  void watch(const std::vector<std::filesystem::path>& files);

  // Looks at the files. Returns true once after a change: when two looks in a row find the same,
  // so that a program that still writes is not interrupted.
  [[nodiscard]] bool changed();

 private:
  struct Look {
    std::uintmax_t bytes = 0;  // 0 and the first time for a file that cannot be looked at
    std::filesystem::file_time_type written = std::filesystem::file_time_type::min();
    bool operator==(const Look&) const = default;
  };
  [[nodiscard]] static Look look_at(const std::filesystem::path& file);

  Mutex mutex_;
  GUARDED_BY(mutex_) std::map<std::filesystem::path, Look> known_, last_;
};

}  // namespace clearance
