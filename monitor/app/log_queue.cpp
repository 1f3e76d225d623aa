// A producer reserves a slot by advancing `back_`, fills it, then hands it over by its turn.
#include "monitor/app/log_queue.hpp"

#include <utility>

namespace clearance {

LogQueue::LogQueue(std::size_t lines) : slots_(lines) {
  for (std::size_t i = 0; i < lines; ++i) slots_[i].turn = i;
}

void LogQueue::push(LogLine line) noexcept {
  const std::uint64_t waiting = back_.load() - front_.load();
  if (overflowed_.load(std::memory_order_relaxed) && 2 * waiting > slots_.size()) {
    leave_out(1);
    return;
  }
  overflowed_ = false;
  line.left_out_before = take_left_out();
  const std::uint64_t lost = line.left_out_before + 1;
  if (place(line)) return;
  overflowed_ = true;
  leave_out(lost);
}

// Repeats only when another producer has taken the slot: one of them always succeeds.
bool LogQueue::place(LogLine& line) noexcept {
  std::uint64_t number = back_.load(std::memory_order_relaxed);
  for (;;) {
    Slot& slot = slots_[number % slots_.size()];
    const std::uint64_t turn = slot.turn.load(std::memory_order_acquire);
    if (turn < number) return false;
    if (turn > number) {
      number = back_.load(std::memory_order_relaxed);
    } else if (back_.compare_exchange_weak(number, number + 1)) {
      slot.line = std::move(line);
      slot.turn.store(number + 1, std::memory_order_release);
      return true;
    }
  }
}

bool LogQueue::pop(LogLine& line) noexcept {
  const std::uint64_t number = front_.load(std::memory_order_relaxed);
  Slot& slot = slots_[number % slots_.size()];
  if (slot.turn.load(std::memory_order_acquire) != number + 1) return false;
  line = std::move(slot.line);
  slot.turn.store(number + slots_.size(), std::memory_order_release);
  front_.store(number + 1);
  return true;
}

}  // namespace clearance
