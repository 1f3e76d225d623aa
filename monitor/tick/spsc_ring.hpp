// A bounded queue between two threads without a lock. Its slots are made once and filled in place,
// so that a report is copied into memory that it already has. Queues of libraries move values in
// and out and would allocate for each report.
//
// One thread fills (`back`, `push`), one other thread empties (`front`, `pop`). Neither waits: a
// full queue says so to the filler, which counts its losses.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <vector>

namespace clearance {

template <class T>
class SpscRing {
 public:
  // Makes at least `slots` slots, each a copy of `prototype`; prepare() reserves their memory.
  explicit SpscRing(std::size_t slots, const T& prototype = T{})
      : slots_(std::bit_ceil(slots), prototype), mask_(slots_.size() - 1) {}

  // Before the threads start: gives every slot the memory that it will need.
  template <class Prepare>
  void prepare(Prepare&& prepare) {
    for (T& slot : slots_) prepare(slot);
  }

  [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }

  // Empties the queue, while neither thread uses it. The slots keep their memory.
  void clear() noexcept {
    head_.store(0, std::memory_order_relaxed);
    tail_.store(0, std::memory_order_relaxed);
    head_seen_ = tail_seen_ = 0;
  }

  // For the filler: the slot to fill, or null when the queue is full. push() hands it over.
  [[nodiscard]] T* back() noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_seen_ == slots_.size()) {
      head_seen_ = head_.load(std::memory_order_acquire);
      if (tail - head_seen_ == slots_.size()) return nullptr;
    }
    return &slots_[tail & mask_];
  }
  void push() noexcept {
    tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  // For the emptier: the oldest slot, or null when the queue is empty. pop() gives it back.
  [[nodiscard]] T* front() noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_seen_) {
      tail_seen_ = tail_.load(std::memory_order_acquire);
      if (head == tail_seen_) return nullptr;
    }
    return &slots_[head & mask_];
  }
  void pop() noexcept {
    head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

 private:
  std::vector<T> slots_;
  std::size_t mask_;
  // Each thread's own index and its last look at the other's, on cache lines of their own.
  alignas(64) std::atomic<std::size_t> tail_{0};
  std::size_t head_seen_ = 0;
  alignas(64) std::atomic<std::size_t> head_{0};
  std::size_t tail_seen_ = 0;
};

}  // namespace clearance
