#include "core/batch/slots.hpp"

#include <algorithm>

#include "core/batch/lane.hpp"

namespace clearance {

// Blocks for all pairs, with the holes that close_holes() leaves and a block that is not full for
// each pair of features. A round that opens more holes makes append() close them all.
BatchSlots::BatchSlots(BatchPairs& of)
    : of_(of),
      slots_(of.pairs.size()),
      blocks_((of.pairs.size() + kFeaturePairs * kMostHoles) / kBlockLanes + 2 * kFeaturePairs) {
  free_.reserve(blocks_.size());
  for (Settled& s : settled_) {
    s.blocks.reserve(blocks_.size());
    s.holes.reserve(of.pairs.size() + 1);
  }
  clear();
}

void BatchSlots::clear() noexcept {
  std::fill(slots_.begin(), slots_.end(), Slot{});
  for (Settled& s : settled_) {
    s.blocks.clear();
    s.holes.clear();
    s.pairs = 0;
  }
  pairs_ = 0;
  free_.clear();
  for (std::size_t i = blocks_.size(); i-- > 0;) free_.push_back(static_cast<std::uint32_t>(i));
}

// The pair enters a hole if there is one: vectors stay full, and nothing has to be moved
// afterwards.
void BatchSlots::enter(std::uint32_t pair) noexcept {
  const FeaturePair features = feature_pair(of_.states[pair]);
  ++settled_[static_cast<std::size_t>(features)].pairs;
  ++pairs_;
  std::vector<Slot>& holes = settled_[static_cast<std::size_t>(features)].holes;
  Slot slot;
  while (slot.block == kNowhere && !holes.empty()) {
    if (is_hole(holes.back(), features)) slot = holes.back();
    holes.pop_back();
  }
  place(pair, slot.block == kNowhere ? append(features) : slot);
  fill(pair);
}

// The lane stays where it is, without a pair, until another pair enters it or close_holes() moves
// the last pair there.
void BatchSlots::leave(std::uint32_t pair) noexcept {
  const Slot slot = slots_[pair];
  BatchBlock& from = blocks_[slot.block];
  take_last_points(from, slot.lane, of_.states[pair]);
  from.pair[slot.lane] = of_.no_pair();
  from.taken &= static_cast<std::uint8_t>(~(1U << slot.lane));
  slots_[pair] = {};
  Settled& of = settled_[static_cast<std::size_t>(from.features)];
  of.holes.push_back(slot);
  --of.pairs;
  --pairs_;
}

void BatchSlots::fill(std::uint32_t pair) noexcept {
  const Slot slot = slots_[pair];
  fill_lane(blocks_[slot.block], slot.lane, of_.a(pair), of_.b(pair), of_.states[pair]);
}

void BatchSlots::place(std::uint32_t pair, Slot slot) noexcept {
  BatchBlock& to = blocks_[slot.block];
  to.pair[slot.lane] = pair;
  to.body_a[slot.lane] = of_.pairs[pair].a;
  to.body_b[slot.lane] = of_.pairs[pair].b;
  to.taken |= static_cast<std::uint8_t>(1U << slot.lane);
  slots_[pair] = slot;
}

// Is this slot still a hole? It may have been filled or given up in the meantime.
bool BatchSlots::is_hole(Slot slot, FeaturePair features) const noexcept {
  const BatchBlock& of = blocks_[slot.block];
  return of.features == features && slot.lane < of.lanes && of.pair[slot.lane] == of_.no_pair();
}

// A new lane at the end.
BatchSlots::Slot BatchSlots::append(FeaturePair features) noexcept {
  // With no holes left, every pair of features has one block at most that is not full.
  if (free_.empty()) close_holes(0);
  std::vector<std::uint32_t>& blocks = settled_[static_cast<std::size_t>(features)].blocks;
  if (blocks.empty() || blocks_[blocks.back()].lanes == kBlockLanes) {
    open_block(blocks_[free_.back()], features, of_.no_pair());
    blocks.push_back(free_.back());
    free_.pop_back();
  }
  return {blocks.back(), blocks_[blocks.back()].lanes++};
}

// Takes the last pair of the same features, so that the list gets shorter at its end.
void BatchSlots::close_holes(std::size_t most) noexcept {
  for (std::size_t features = 0; features < kFeaturePairs; ++features) {
    Settled& of = settled_[features];
    while (of.holes.size() > most) {
      const Slot slot = of.holes.back();
      of.holes.pop_back();
      close_last(of);
      if (!is_hole(slot, static_cast<FeaturePair>(features))) continue;
      const std::uint32_t pair = take_last(of);
      place(pair, slot);
      fill(pair);
      close_last(of);
    }
  }
}

// Gives up lanes at the end that hold no pair.
void BatchSlots::close_last(Settled& of) noexcept {
  while (!of.blocks.empty()) {
    const BatchBlock& end = blocks_[of.blocks.back()];
    if (end.pair[end.lanes - 1U] != of_.no_pair()) return;
    (void)take_last(of);
  }
}

// Gives up the last lane of a pair of features; the pair that was in it.
std::uint32_t BatchSlots::take_last(Settled& of) noexcept {
  BatchBlock& end = blocks_[of.blocks.back()];
  const std::size_t lane = --end.lanes;
  const std::uint32_t pair = end.pair[lane];
  if (pair != of_.no_pair()) {
    take_last_points(end, lane, of_.states[pair]);
    end.pair[lane] = of_.no_pair();
    end.taken &= static_cast<std::uint8_t>(~(1U << lane));
  }
  if (end.lanes == 0) {
    free_.push_back(of.blocks.back());
    of.blocks.pop_back();
  }
  return pair;
}

}  // namespace clearance
