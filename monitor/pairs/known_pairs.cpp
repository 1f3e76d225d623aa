#include "monitor/pairs/known_pairs.hpp"

#include <bit>

namespace clearance {

KnownPairs::KnownPairs(const Scene& scene)
    : words_((scene.objects.size() + 63) / 64), neighbours_(scene.objects.size() * words_) {
  for (Kind* kind : {&present_, &known_, &fresh_}) kind->members.resize(words_);
  regained_.reserve(scene.objects.size());
  const auto join = [this](std::size_t object, std::size_t other) {
    neighbours_[object * words_ + other / 64] |= std::uint64_t{1} << other % 64;
  };
  for (const ObjectPair& pair : scene.pairs) {
    join(pair.first, pair.second);
    join(pair.second, pair.first);
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) set(i, true, present_);
}

void KnownPairs::update(std::span<const TrackedObject> objects,
                        std::span<const std::uint32_t> changed) noexcept {
  regained_.clear();
  for (const std::uint32_t i : changed) {
    const bool known = objects[i].known();
    const bool fresh = known && !objects[i].input.late;
    set(i, !objects[i].absent, present_);
    if (known_.has(i) == known && fresh_.has(i) == fresh) continue;
    if (set(i, known, known_) && known) regained_.push_back(i);
    set(i, fresh, fresh_);
  }
}

bool KnownPairs::set(std::size_t object, bool is_member, Kind& kind) noexcept {
  std::uint64_t& word = kind.members[object / 64];
  const std::uint64_t bit = std::uint64_t{1} << object % 64;
  if (kind.has(object) == is_member) return false;
  std::uint64_t pairs = 0;
  for (std::size_t i = 0; i < words_; ++i) {
    pairs += static_cast<std::uint64_t>(
        std::popcount(neighbours_[object * words_ + i] & kind.members[i]));
  }
  word ^= bit;
  kind.pairs = is_member ? kind.pairs + pairs : kind.pairs - pairs;
  return true;
}

}  // namespace clearance
