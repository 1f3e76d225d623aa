// The columns of tables by pair, on large pages.
//
// In cells of millions of pairs a tick reads a few lines of each column, anywhere in it. On pages of
// 4 kB almost every such read also misses the translation buffer, and the construction faults each
// page in. Linux gives pages of 2 MB to memory that asks for them, unless it is set to `never`.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

namespace clearance {

// An allocator whose large blocks begin at a page of 2 MB and ask for such pages.
template <class T>
struct LargePages {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{2} << 20;
  // Bytes. A smaller column would waste much of its last page.
  static constexpr std::size_t kLeast = 2 * kPage;

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) noexcept {}  // NOLINT: containers convert it

  [[nodiscard]] T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kLeast) return std::allocator<T>().allocate(count);
    void* const block = std::aligned_alloc(kPage, (bytes + kPage - 1) / kPage * kPage);
    if (block == nullptr) throw std::bad_alloc();
    (void)madvise(block, bytes, MADV_HUGEPAGE);  // it is a request: a refusal costs time only
    return static_cast<T*>(block);
  }
  void deallocate(T* block, std::size_t count) noexcept {
    if (count * sizeof(T) < kLeast) {
      std::allocator<T>().deallocate(block, count);
    } else {
      std::free(block);
    }
  }
  bool operator==(const LargePages&) const = default;
};

// Values by pair, by part pair or by timer.
template <class T>
using PairColumn = std::vector<T, LargePages<T>>;

}  // namespace clearance
