// Whose turn is it to be refreshed? Always that of the pair which has waited longest.
//
// A pair is refreshed when its bound is found afresh from the poses of a tick: by an evaluation, or
// by spheres around its objects where they prove it far. The queue is a list in the order in which
// that last happened. Pairs of which an object is out of sight are set aside when they come to its
// head; when the object is known again they come back ahead of all others, which were refreshed
// later.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "monitor/objects/tracked_object.hpp"
#include "monitor/pairs/pair_table.hpp"
#include "monitor/pairs/pairs_by_object.hpp"

namespace clearance {

class RefreshQueue {
 public:
  static constexpr std::uint32_t kNoIndex = ~0u;

  RefreshQueue(std::size_t objects, std::size_t pairs);

  // A pair that was seen for the first time and is not refreshed yet, ahead of all others.
  void enter(std::uint32_t pair) noexcept;

  // Entered or not.
  void refreshed(std::uint32_t pair, std::uint64_t cycle) noexcept;

  // kNoIndex: the queue is empty.
  [[nodiscard]] std::uint32_t stalest() const noexcept;

  // `pair` is in the queue and one of its objects, `object`, is out of sight.
  void set_aside(std::uint32_t pair, std::uint32_t object) noexcept;

  // An object is known that was not: its pairs that were set aside are due to come back.
  void regain(std::uint32_t object) noexcept;

  // Goes on with that, for as many pairs as one tick has time for.
  void bring_back(const PairsByObject& by_object, const std::vector<TrackedObject>& objects,
                  const PairTable& table) noexcept;

  // The tick in which a pair was last refreshed; 0: never.
  [[nodiscard]] std::uint64_t refreshed_cycle(std::uint32_t pair) const noexcept {
    return refreshed_[pair];
  }
  // The same of the stalest pair that is known, if no unknown one is at the head. Exact, but for
  // the ticks that pairs take to come back: then no pair is older. The largest number: no pair.
  [[nodiscard]] std::uint64_t oldest() const noexcept;

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
  struct Link {
    std::uint32_t before = kNoIndex, next = kNoIndex;  // kNoIndex: not in a list
  };
  [[nodiscard]] bool in_list(std::uint32_t pair) const noexcept {
    return links_[pair].next != kNoIndex;
  }
  void append(std::uint32_t pair, std::uint32_t list) noexcept;
  void unlink(std::uint32_t pair) noexcept;

  // The ends of the two lists: pairs that come back or were never refreshed, and all others.
  const std::uint32_t ahead_, main_;
  std::vector<Link> links_;                  // by pair, then the two ends
  std::vector<std::uint64_t> refreshed_;     // by pair
  std::vector<std::uint8_t> aside_;          // by pair
  std::uint64_t oldest_ahead_ = kNever;      // no pair in that list is older
  std::vector<std::uint64_t> oldest_aside_;  // by object: none set aside on its account is older
  std::vector<std::uint32_t> returning_;     // objects whose pairs come back, the next one last
  std::vector<std::uint8_t> is_returning_;   // by object
  std::size_t brought_back_ = 0;             // pairs of the last one that have been looked at
};

}  // namespace clearance
