// Preloaded into a program under test. While the file that CLEARANCE_MEMORY_FAILS_IF names exists,
// the thread of this name gets no memory of more than a few hundred bytes.
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <new>

namespace {

constexpr std::size_t kSmall = 512;
constexpr const char* kThread = "sensors";

bool fails() {
  const char* const sign = std::getenv("CLEARANCE_MEMORY_FAILS_IF");
  char name[16] = {};
  return sign != nullptr && prctl(PR_GET_NAME, name) == 0 && std::strcmp(name, kThread) == 0 &&
         access(sign, F_OK) == 0;
}

}  // namespace

void* operator new(std::size_t size) {
  void* const memory = size > kSmall && fails() ? nullptr : std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
