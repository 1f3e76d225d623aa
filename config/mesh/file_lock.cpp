#include "config/mesh/file_lock.hpp"

#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "config/text/file_bytes.hpp"

namespace clearance {

FileLock::FileLock(const std::filesystem::path& file, const std::function<void()>& wait)
    : file_(open_to_read(file)) {
  if (file_ < 0 || ::flock(file_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  waited_ = true;
  wait();
  while (::flock(file_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

// Closing releases the lock.
FileLock::~FileLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace clearance
