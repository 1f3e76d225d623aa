// An advisory lock on a file (flock), for one program at a time. It ends with its holder.
#pragma once

#include <filesystem>
#include <functional>

namespace clearance {

class FileLock {
 public:
  // Waits while another program holds the lock, after calling `wait`. File systems without locks
  // give none.
  FileLock(const std::filesystem::path& file, const std::function<void()>& wait);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  // Tells whether another program held it.
  [[nodiscard]] bool waited() const noexcept { return waited_; }

 private:
  int file_;
  bool waited_ = false;
};

}  // namespace clearance
