// One program at a time with a file: an advisory lock (flock) that ends with its holder.
#pragma once

#include <filesystem>
#include <functional>

namespace clearance {

class FileLock {
 public:
  // Waits while another program holds it, after calling `wait`. Where the file system has no locks
  // there is none.
  FileLock(const std::filesystem::path& file, const std::function<void()>& wait);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  // Another program had it.
  [[nodiscard]] bool waited() const noexcept { return waited_; }

 private:
  int file_;
  bool waited_ = false;
};

}  // namespace clearance
