#include "monitor/schedule/refresh_queue.hpp"

#include <algorithm>

namespace clearance {
namespace {

constexpr std::size_t kMostBroughtBack = 2'000;  // pairs a tick: about 20 us

}  // namespace

RefreshQueue::RefreshQueue(std::size_t objects, std::size_t pairs)
    : ahead_(static_cast<std::uint32_t>(pairs)),
      main_(static_cast<std::uint32_t>(pairs + 1)),
      links_(pairs + 2),
      oldest_aside_(objects, kNever),
      is_returning_(objects, 0) {
  for (const std::uint32_t end : {ahead_, main_}) links_[end] = {.before = end, .next = end};
  returning_.reserve(objects);
}

void RefreshQueue::append(std::uint32_t pair, std::uint32_t list) noexcept {
  const std::uint32_t last = links_[list].before;
  links_[pair] = {.before = last, .next = list};
  links_[last].next = pair;
  links_[list].before = pair;
}

void RefreshQueue::unlink(std::uint32_t pair) noexcept {
  const Link at = links_[pair];
  links_[at.before].next = at.next;
  links_[at.next].before = at.before;
  links_[pair] = {};
}

void RefreshQueue::enter(std::uint32_t pair, const PairTable& table) noexcept {
  if (in_list(pair) || is_aside(pair)) return;
  if (links_[ahead_].next == ahead_) oldest_ahead_ = kNever;
  append(pair, ahead_);
  oldest_ahead_ = std::min(oldest_ahead_, table.entries[pair].refreshed_cycle);
}

void RefreshQueue::move_to_back(std::uint32_t pair) noexcept {
  if (in_list(pair)) unlink(pair);
  append(pair, main_);
}

std::uint32_t RefreshQueue::stalest() const noexcept {
  if (links_[ahead_].next != ahead_) return links_[ahead_].next;
  return links_[main_].next != main_ ? links_[main_].next : kNoIndex;
}

void RefreshQueue::set_aside(std::uint32_t pair, std::uint32_t object,
                             const PairTable& table) noexcept {
  unlink(pair);
  links_[pair].before = kAside;
  oldest_aside_[object] = std::min(oldest_aside_[object], table.entries[pair].refreshed_cycle);
}

void RefreshQueue::regain(std::uint32_t object) noexcept {
  if (oldest_aside_[object] == kNever) return;
  if (is_returning_[object]) {  // it was lost meanwhile, so pairs may have been set aside again
    if (returning_.back() == object) brought_back_ = 0;
    return;
  }
  is_returning_[object] = 1;
  // The object whose pairs are coming back stays at the end of the list.
  returning_.insert(returning_.begin(), object);
}

void RefreshQueue::bring_back(const PairsByObject& by_object, const TickView& view) noexcept {
  const std::span<const TrackedObject> objects = view.objects;
  for (std::size_t left = kMostBroughtBack; !returning_.empty() && left > 0;) {
    const std::uint32_t object = returning_.back();
    const auto pairs = by_object.pairs_of(object);
    for (; brought_back_ < pairs.size() && left > 0; ++brought_back_, --left) {
      const std::uint32_t pair = pairs[brought_back_];
      if (!is_aside(pair)) continue;
      const PairEntry& entry = view.pairs.entries[pair];
      const std::uint32_t other = entry.object_a == object ? entry.object_b : entry.object_a;
      if (!objects[object].known() || !objects[other].known()) {
        const std::uint32_t missing = objects[object].known() ? other : object;
        oldest_aside_[missing] =
            std::min(oldest_aside_[missing], view.pairs.entries[pair].refreshed_cycle);
        continue;
      }
      links_[pair] = {};
      enter(pair, view.pairs);
    }
    if (brought_back_ < pairs.size()) return;
    brought_back_ = 0;
    is_returning_[object] = 0;
    if (objects[object].known()) oldest_aside_[object] = kNever;
    returning_.pop_back();
  }
}

std::uint64_t RefreshQueue::oldest(const PairTable& table) const noexcept {
  std::uint64_t oldest = links_[ahead_].next != ahead_ ? oldest_ahead_ : kNever;
  if (links_[main_].next != main_)
    oldest = std::min(oldest, table.entries[links_[main_].next].refreshed_cycle);
  for (const std::uint32_t object : returning_) oldest = std::min(oldest, oldest_aside_[object]);
  return oldest;
}

}  // namespace clearance
