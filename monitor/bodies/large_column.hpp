// Columns of tables by object or by pair, on large pages where these help.
//
// A tick of a large cell reads a few lines of each column, anywhere in it. On pages of 4 kB most of
// these reads also miss the translation buffer. Linux gives pages of 2 MB to memory that asks for
// them, unless it is set to `never`. Measured at 499,500 and at 4.5 million pairs: ticks take 0.93
// of the time, and at 2 million pairs whose objects all move, 0.91. The construction depends on the
// machine: where a hypervisor has taken free memory back, it takes two to three times as long.
// Hence columns of 4.5 million pairs stay on small pages.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

namespace clearance {

// An allocator whose large blocks begin at a page of 2 MB and ask for such pages.
template <class T>
struct LargePages {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{2} << 20;
  // Bytes. A smaller column would waste much of its last page.
  static constexpr std::size_t kLeast = 2 * kPage, kMost = 64 * kPage;

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) noexcept {}  // NOLINT: containers convert it

  [[nodiscard]] T* allocate(std::size_t count) {
    if (!is_large(count)) return std::allocator<T>().allocate(count);
    const std::size_t bytes = count * sizeof(T);
    void* const block = std::aligned_alloc(kPage, (bytes + kPage - 1) / kPage * kPage);
    if (block == nullptr) throw std::bad_alloc();
    (void)madvise(block, bytes, MADV_HUGEPAGE);  // it is a request: a refusal costs time only
    return static_cast<T*>(block);
  }
  void deallocate(T* block, std::size_t count) noexcept {
    if (is_large(count)) {
      std::free(block);
    } else {
      std::allocator<T>().deallocate(block, count);
    }
  }
  [[nodiscard]] static constexpr bool is_large(std::size_t count) noexcept {
    return count >= kLeast / sizeof(T) && count <= kMost / sizeof(T);
  }
  bool operator==(const LargePages&) const = default;
};

// Values by object, pair, part pair or timer.
template <class T>
using LargeColumn = std::vector<T, LargePages<T>>;

}  // namespace clearance
