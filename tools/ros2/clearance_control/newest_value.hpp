// The newest value that one thread has written, for one other thread. Neither waits, locks or
// allocates.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace clearance_control {

template <class T>
class NewestValue {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit NewestValue(const T& first) : slots_{first, first, first} {}

  // For the thread that writes.
  void put(const T& value) noexcept {
    slots_[written_] = value;
    written_ = offered_.exchange(written_ | kNew, std::memory_order_acq_rel) & kSlot;
  }
  // For the thread that reads; valid until its next call.
  const T& get() noexcept {
    if ((offered_.load(std::memory_order_relaxed) & kNew) != 0)
      read_ = offered_.exchange(read_, std::memory_order_acq_rel) & kSlot;
    return slots_[read_];
  }

 private:
  static constexpr std::uint8_t kSlot = 3, kNew = 4;
  std::array<T, 3> slots_;
  std::uint8_t written_ = 0, read_ = 1;  // the slot of each thread
  std::atomic<std::uint8_t> offered_{2};
};

}  // namespace clearance_control
