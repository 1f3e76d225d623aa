#include "monitor/schedule/refresh_queue.hpp"

#include <algorithm>

namespace clearance {
namespace {

constexpr std::size_t kMostBroughtBack = 2'000;  // pairs looked at a tick: about 20 us

}  // namespace

RefreshQueue::RefreshQueue(std::size_t objects, std::size_t pairs)
    : ahead_(static_cast<std::uint32_t>(pairs)),
      main_(static_cast<std::uint32_t>(pairs + 1)),
      links_(pairs + 2),
      refreshed_(pairs, 0),
      aside_(pairs, 0),
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

void RefreshQueue::enter(std::uint32_t pair) noexcept {
  if (in_list(pair) || aside_[pair]) return;
  if (links_[ahead_].next == ahead_) oldest_ahead_ = kNever;
  append(pair, ahead_);
  oldest_ahead_ = std::min(oldest_ahead_, refreshed_[pair]);
}

void RefreshQueue::refreshed(std::uint32_t pair, std::uint64_t cycle) noexcept {
  if (in_list(pair)) unlink(pair);
  aside_[pair] = 0;
  refreshed_[pair] = cycle;
  append(pair, main_);
}

std::uint32_t RefreshQueue::stalest() const noexcept {
  if (links_[ahead_].next != ahead_) return links_[ahead_].next;
  return links_[main_].next != main_ ? links_[main_].next : kNoIndex;
}

void RefreshQueue::set_aside(std::uint32_t pair, std::uint32_t object) noexcept {
  unlink(pair);
  aside_[pair] = 1;
  oldest_aside_[object] = std::min(oldest_aside_[object], refreshed_[pair]);
}

void RefreshQueue::regain(std::uint32_t object) noexcept {
  if (oldest_aside_[object] == kNever) return;
  if (is_returning_[object]) {  // and was lost meanwhile: some may have been set aside again
    if (returning_.back() == object) brought_back_ = 0;
    return;
  }
  is_returning_[object] = 1;
  // The one that is being worked on stays last.
  returning_.insert(returning_.begin(), object);
}

void RefreshQueue::bring_back(const PairsByObject& by_object,
                              const std::vector<TrackedObject>& objects,
                              const PairTable& table) noexcept {
  for (std::size_t left = kMostBroughtBack; !returning_.empty() && left > 0;) {
    const std::uint32_t object = returning_.back();
    const auto pairs = by_object.pairs_of(object);
    for (; brought_back_ < pairs.size() && left > 0; ++brought_back_, --left) {
      const std::uint32_t pair = pairs[brought_back_];
      if (!aside_[pair]) continue;
      const std::uint32_t a = table.entries[pair].object_a;
      const std::uint32_t other = a == object ? table.entries[pair].object_b : a;
      if (!objects[object].known() || !objects[other].known()) {
        const std::uint32_t missing = objects[object].known() ? other : object;
        oldest_aside_[missing] = std::min(oldest_aside_[missing], refreshed_[pair]);
        continue;
      }
      aside_[pair] = 0;
      enter(pair);
    }
    if (brought_back_ < pairs.size()) return;
    brought_back_ = 0;
    is_returning_[object] = 0;
    if (objects[object].known()) oldest_aside_[object] = kNever;
    returning_.pop_back();
  }
}

std::uint64_t RefreshQueue::oldest() const noexcept {
  std::uint64_t oldest = links_[ahead_].next != ahead_ ? oldest_ahead_ : kNever;
  if (links_[main_].next != main_) oldest = std::min(oldest, refreshed_[links_[main_].next]);
  for (const std::uint32_t object : returning_) oldest = std::min(oldest, oldest_aside_[object]);
  return oldest;
}

}  // namespace clearance
