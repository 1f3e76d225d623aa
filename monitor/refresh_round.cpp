#include "monitor/refresh_round.hpp"

#include <algorithm>

namespace clearance {
namespace {

constexpr std::size_t kMostBlocks = 1u << 16;

}  // namespace

RefreshRound::RefreshRound(std::size_t objects, std::size_t pairs)
    : pairs_(pairs),
      block_(1 + pairs / kMostBlocks),
      entered_((pairs + block_ - 1) / block_, 0),
      lost_sight_(objects, 0),
      known_(objects, 0) {}

std::uint32_t RefreshRound::take_turn(std::uint64_t cycle) noexcept {
  if (next_ % block_ == 0) entered_[next_ / block_] = cycle;
  const auto pair = static_cast<std::uint32_t>(next_);
  if (++next_ == pairs_) next_ = 0;
  if (next_ % block_ == 0) block_before_ = entered_[next_ / block_];
  if (turns_missed_ > 0) --turns_missed_;
  return pair;
}

void RefreshRound::look(const std::vector<ObjectState>& objects) noexcept {
  const std::uint64_t oldest = oldest_turn();
  constexpr std::uint64_t kNobody = ~std::uint64_t{0};
  std::uint64_t regained = kNobody;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const bool known = objects[i].known();
    if (known == static_cast<bool>(known_[i])) continue;
    known_[i] = known;
    if (known) {
      regained = std::min(regained, lost_sight_[i]);
    } else {
      lost_sight_[i] = oldest;
    }
  }
  if (regained == kNobody) return;
  oldest_regained_ = turns_missed_ > 0 ? std::min(oldest_regained_, regained) : regained;
  turns_missed_ = pairs_;
  // A pair of one of these with one that is still out of sight has been unknown for as long.
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (!known_[i]) lost_sight_[i] = std::min(lost_sight_[i], regained);
  }
}

std::uint64_t RefreshRound::oldest_turn() const noexcept {
  return turns_missed_ > 0 ? std::min(oldest_regained_, block_before_) : block_before_;
}

}  // namespace clearance
