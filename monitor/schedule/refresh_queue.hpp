// Finds the pair that has waited longest for its refresh.
//
// A pair is refreshed when its bound is computed from the poses of a tick alone. This is done by an
// evaluation, or by models of its objects that prove it far. The queue is a list in the order in
// which that last happened; PairTable::refreshed_cycle has the ticks. Pairs with an object that is
// not known are set aside when they come to the head. When the object is known again they come back
// ahead of all others, which were refreshed later.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "monitor/pairs/pairs_by_object.hpp"
#include "monitor/pairs/tick_view.hpp"

namespace clearance {

class RefreshQueue {
 public:
  static constexpr std::uint32_t kNoIndex = ~0u;

  RefreshQueue(std::size_t objects, std::size_t pairs);

  // Puts a pair that is not in the queue ahead of all others; else changes nothing.
  void enter(std::uint32_t pair, const PairTable& table) noexcept;

  // Puts a pair that was refreshed in this tick at the back, whether it was in the queue or not.
  void move_to_back(std::uint32_t pair) noexcept;

  // Fetches the memory of a pair that will be moved soon, and later that of its neighbours.
  void fetch(std::uint32_t pair) const noexcept { __builtin_prefetch(&links_[pair], 1); }
  void fetch_neighbours(std::uint32_t pair) const noexcept {
    if (!in_list(pair)) return;
    __builtin_prefetch(&links_[links_[pair].before], 1);
    __builtin_prefetch(&links_[links_[pair].next], 1);
  }

  // kNoIndex: the queue is empty.
  [[nodiscard]] std::uint32_t stalest() const noexcept;

  // Takes a pair out of the queue because one of its objects, `object`, is not known.
  void set_aside(std::uint32_t pair, std::uint32_t object, const PairTable& table) noexcept;

  // An object is known again: its pairs that were set aside are due to come back.
  void regain(std::uint32_t object) noexcept;

  // Brings such pairs back, as many as one tick has time for.
  void bring_back(const PairsByObject& by_object, const TickView& view) noexcept;

  // Returns a tick before which no known pair was last refreshed; the largest number if there is no
  // pair. It is exactly that of the stalest pair unless pairs are coming back or an object of the
  // pair at the head is not known.
  [[nodiscard]] std::uint64_t oldest(const PairTable& table) const noexcept;

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
  struct Link {
    std::uint32_t before = kNoIndex;  // kAside: the pair is set aside
    std::uint32_t next = kNoIndex;    // kNoIndex: not in a list
  };
  static constexpr std::uint32_t kAside = kNoIndex - 1;
  [[nodiscard]] bool is_aside(std::uint32_t pair) const noexcept {
    return links_[pair].before == kAside && !in_list(pair);
  }
  [[nodiscard]] bool in_list(std::uint32_t pair) const noexcept {
    return links_[pair].next != kNoIndex;
  }
  void append(std::uint32_t pair, std::uint32_t list) noexcept;
  void unlink(std::uint32_t pair) noexcept;

  // The ends of the two lists: pairs that come back or were never refreshed, and all others.
  const std::uint32_t ahead_, main_;
  LargeColumn<Link> links_;                  // by pair, then the two ends
  std::uint64_t oldest_ahead_ = kNever;      // no pair of that list was last refreshed earlier
  std::vector<std::uint64_t> oldest_aside_;  // by object: nor any pair that it had set aside
  std::vector<std::uint32_t> returning_;     // objects whose pairs come back, the next one last
  std::vector<std::uint8_t> is_returning_;   // by object
  std::size_t brought_back_ = 0;             // how many pairs of the last one have been checked
};

}  // namespace clearance
