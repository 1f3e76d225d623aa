#include "tests/shared/allocation_count.hpp"

#include <cstddef>
#include <cstdlib>
#include <new>

// With --wrap (CMakeLists.txt), the linker sends calls of malloc and its relatives to these
// functions.
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* memory, std::size_t size);
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
int __real_posix_memalign(void** memory, std::size_t alignment, std::size_t size);
}

namespace {

thread_local std::uint64_t count = 0, bytes = 0;

void add(std::size_t size) noexcept {
  ++count;
  bytes += size;
}

void* aligned_or_null(std::size_t size, std::size_t alignment) noexcept {
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  return std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
}

void* aligned(std::size_t size, std::size_t alignment) {
  void* memory = aligned_or_null(size, alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

namespace clearance {
std::uint64_t allocations() noexcept { return count; }
std::uint64_t allocated_bytes() noexcept { return bytes; }
}  // namespace clearance

extern "C" {
void* __wrap_malloc(std::size_t size) {
  add(size);
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t of, std::size_t size) {
  add(of * size);
  return __real_calloc(of, size);
}
void* __wrap_realloc(void* memory, std::size_t size) {
  add(size);
  return __real_realloc(memory, size);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  add(size);
  return __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  add(size);
  return __real_posix_memalign(memory, alignment, size);
}
}

void* operator new(std::size_t size) { return aligned(size, alignof(std::max_align_t)); }
void* operator new[](std::size_t size) { return aligned(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return aligned(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return aligned(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return aligned_or_null(size, alignof(std::max_align_t));
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return aligned_or_null(size, alignof(std::max_align_t));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
