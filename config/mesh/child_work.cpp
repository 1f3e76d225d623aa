// The child writes the number of its bytes and the bytes into a pipe. A signal or a limit that ends
// it earlier is the fault that the parent reports.
#include "config/mesh/child_work.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CLEARANCE_MAPS_TERABYTES
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define CLEARANCE_MAPS_TERABYTES
#endif
#endif

namespace clearance {
namespace {

using Clock = std::chrono::steady_clock;

// Exit statuses of the child.
constexpr int kDone = 0, kOutOfMemory = 3, kThrew = 4;

// Returns the bytes of address space that this process has; 0: not known.
[[maybe_unused]] std::size_t address_space() {
  std::size_t pages = 0;
  if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%zu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// The hard limit is a second later: the signal of the soft one can be told from others.
void limit(__rlimit_resource resource, rlim_t most) {
  const rlimit limits{most, resource == RLIMIT_CPU ? most + 1 : most};
  setrlimit(resource, &limits);
}

void confine_child(const ChildLimits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGPIPE}) {
    std::signal(crash, SIG_DFL);
  }
  // Messages of glibc and of libraries that abort are not messages of this program.
  if (const int nowhere = open("/dev/null", O_RDWR); nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.cpu_s);
#ifndef CLEARANCE_MAPS_TERABYTES
  if (const std::size_t now = address_space(); now > 0) limit(RLIMIT_AS, now + limits.memory);
#endif
}

bool write_all(int to, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t written = write(to, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
  return true;
}

// Runs the child from its first to its last instruction. No destructor of the parent's objects may
// run here.
[[noreturn]] void run_child(const std::function<std::string()>& work, const ChildLimits& limits,
                            int to) {
  int status = kThrew;
  try {
    confine_child(limits);
    const std::string bytes = work();
    const std::uint64_t count = bytes.size();
    const bool written = write_all(to, reinterpret_cast<const char*>(&count), sizeof count) &&
                         write_all(to, bytes.data(), bytes.size());
    status = written ? kDone : kThrew;
  } catch (const std::bad_alloc&) {
    status = kOutOfMemory;
  } catch (...) {
    status = kThrew;
  }
  _exit(status);
}

// A message: its length, then as many bytes.
class Message {
 public:
  explicit Message(std::size_t most) : most_(most) {}

  void add(const char* bytes, std::size_t count) { text_.append(bytes, count); }
  [[nodiscard]] bool complete() const {
    return text_.size() >= sizeof(std::uint64_t) &&
           text_.size() - sizeof(std::uint64_t) >= std::min<std::uint64_t>(announced(), most_);
  }
  // Returns the bytes of a complete message; empty where the child announced more than is allowed.
  [[nodiscard]] std::string bytes() const {
    if (announced() > most_) return {};
    return text_.substr(sizeof(std::uint64_t), announced());
  }

 private:
  [[nodiscard]] std::uint64_t announced() const {
    std::uint64_t count = 0;
    std::memcpy(&count, text_.data(), sizeof count);
    return count;
  }

  std::size_t most_;
  std::string text_;
};

// Reads until the message is complete, the child has ended, or its time is over. Returns false when
// it is over.
bool receive(int from, Clock::time_point deadline, Message& message) {
  std::array<char, 65536> piece;
  while (!message.complete()) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    pollfd readable{from, POLLIN, 0};
    if (poll(&readable, 1, static_cast<int>(left)) <= 0) continue;
    const ssize_t count = read(from, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return true;
    message.add(piece.data(), static_cast<std::size_t>(count));
  }
  return true;
}

// Returns how a child that sent nothing ended, as the end of a sentence.
std::string how_it_ended(int status, const ChildLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) {
      return fmt::format("took more than {} s of processor time", limits.cpu_s);
    }
    return fmt::format("crashed ({})", strsignal(signal));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory) {
    return fmt::format("needed more than {} MiB of memory", limits.memory >> 20);
  }
  return "gave up without a reason";
}

}  // namespace

ChildWork in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    return {"", fmt::format("could not be given a pipe ({})", std::strerror(errno))};
  }
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    run_child(work, limits, ends[1]);
  }
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    return {"", fmt::format("could not be given a process ({})", std::strerror(errno))};
  }
  Message message(limits.memory);
  const bool in_time =
      receive(ends[0], Clock::now() + std::chrono::seconds(limits.wall_s), message);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (message.complete()) return {message.bytes(), ""};
  if (!in_time) return {"", fmt::format("took longer than {} s", limits.wall_s)};
  return {"", how_it_ended(status, limits)};
}

}  // namespace clearance
