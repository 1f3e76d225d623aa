// Preloaded into a program under test. While the file that CLEARANCE_DISK_HANGS_IF names exists, no
// write to an MCAP file returns, as with an unreachable disk.
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <string_view>

namespace {

bool is_recording(int descriptor) {
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  char name[4096];
  const ssize_t length = readlink(link.c_str(), name, sizeof name);
  return length > 0 && std::string_view(name, static_cast<std::size_t>(length)).ends_with(".mcap");
}

bool hangs() {
  const char* const sign = std::getenv("CLEARANCE_DISK_HANGS_IF");
  return sign != nullptr && access(sign, F_OK) == 0;
}

}  // namespace

extern "C" ssize_t write(int descriptor, const void* bytes, size_t count) {
  while (is_recording(descriptor) && hangs()) usleep(1000);
  return syscall(SYS_write, descriptor, bytes, count);
}
