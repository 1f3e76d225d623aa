// Wakes one thread from another without ever making the other wait.
#pragma once

#include <semaphore.h>

#include <cerrno>
#include <ctime>

namespace clearance {

// A POSIX semaphore, whose post() is async-signal-safe and therefore never blocks. The standard
// promises no such thing of std::counting_semaphore.
class Semaphore {
 public:
  Semaphore() { sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  void post() noexcept { sem_post(&semaphore_); }
  void wait() noexcept {
    while (sem_wait(&semaphore_) != 0 && errno == EINTR) {
    }
  }

 private:
  sem_t semaphore_;
};

}  // namespace clearance
