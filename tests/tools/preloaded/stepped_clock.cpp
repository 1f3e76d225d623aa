// Preloaded into a program under test. CLOCK_REALTIME is ahead by the number in the file that
// CLEARANCE_CLOCK_AHEAD names (eight bytes, ns), as if this machine's clock had been stepped.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <ctime>

namespace {

using Shared = std::atomic<std::int64_t>;
constexpr std::int64_t kNsPerS = 1'000'000'000;

const Shared* mapped() {
  const char* const file = std::getenv("CLEARANCE_CLOCK_AHEAD");
  if (file == nullptr) return nullptr;
  const int descriptor = open(file, O_RDONLY);
  if (descriptor < 0) return nullptr;
  void* const place = mmap(nullptr, sizeof(Shared), PROT_READ, MAP_SHARED, descriptor, 0);
  close(descriptor);
  return place == MAP_FAILED ? nullptr : static_cast<const Shared*>(place);
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static const Shared* const ahead = mapped();
  const long result = syscall(SYS_clock_gettime, clock, time);
  if (result != 0 || clock != CLOCK_REALTIME || ahead == nullptr) return static_cast<int>(result);
  const std::int64_t ns = std::int64_t{time->tv_sec} * kNsPerS + time->tv_nsec + *ahead;
  time->tv_sec = ns / kNsPerS;
  time->tv_nsec = ns % kNsPerS;
  return 0;
}
