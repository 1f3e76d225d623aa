// The places of a batch's pairs in its blocks.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/batch.hpp"
#include "core/batch/block.hpp"

namespace clearance {

// The pairs of a batch and their states.
struct BatchPairs {
  std::vector<const ConvexBody*> bodies;
  std::vector<BodyPair> pairs;
  std::vector<TrackingState> states;  // points of pairs in a block are there

  [[nodiscard]] const ConvexBody& a(std::uint32_t pair) const noexcept {
    return *bodies[pairs[pair].a];
  }
  [[nodiscard]] const ConvexBody& b(std::uint32_t pair) const noexcept {
    return *bodies[pairs[pair].b];
  }
  [[nodiscard]] std::uint32_t no_pair() const noexcept {
    return static_cast<std::uint32_t>(pairs.size());
  }
};

// Gives a pair a lane in a block of its features, numbers of its features included. A pair has one
// lane or none. Lanes of the same features fill blocks one after another. All blocks except the
// last are full, apart from holes. Memory is taken once, by the constructor.
class BatchSlots {
 public:
  struct Slot {
    std::uint32_t block = kNowhere, lane = 0;
  };

  explicit BatchSlots(BatchPairs& of);

  void clear() noexcept;
  [[nodiscard]] bool has(std::uint32_t pair) const noexcept {
    return slots_[pair].block != kNowhere;
  }
  [[nodiscard]] Slot of(std::uint32_t pair) const noexcept { return slots_[pair]; }
  [[nodiscard]] const BatchBlock& block_of(std::uint32_t pair) const noexcept {
    return blocks_[slots_[pair].block];
  }
  [[nodiscard]] std::span<BatchBlock> blocks() noexcept { return blocks_; }
  // The blocks of one pair of features.
  [[nodiscard]] std::span<const std::uint32_t> blocks_of(FeaturePair features) const noexcept {
    return settled_[static_cast<std::size_t>(features)].blocks;
  }

  // The number of pairs in all blocks.
  [[nodiscard]] std::uint32_t pairs() const noexcept { return pairs_; }
  // The number of pairs in them.
  [[nodiscard]] std::uint32_t pairs_of(FeaturePair features) const noexcept {
    return settled_[static_cast<std::size_t>(features)].pairs;
  }

  // The pair has none and fits_lane().
  void enter(std::uint32_t pair) noexcept;
  // Takes the points of its last query along, to its state.
  void leave(std::uint32_t pair) noexcept;
  // Moves pairs into lanes that others have left. A few free lanes stay, for the pairs that enter
  // next.
  void close_holes() noexcept { close_holes(kMostHoles); }

 private:
  static constexpr std::uint32_t kNowhere = ~std::uint32_t{0};
  static constexpr std::size_t kMostHoles = 4;  // lanes of a pair of features

  // The tracked pairs with the same pair of features.
  struct Settled {
    std::vector<std::uint32_t> blocks;  // all but the last full, but for
    std::vector<Slot> holes;            // lanes that their pair has left, and some that were
    std::uint32_t pairs = 0;
  };

  void fill(std::uint32_t pair) noexcept;
  void place(std::uint32_t pair, Slot slot) noexcept;
  [[nodiscard]] bool is_hole(Slot slot, FeaturePair features) const noexcept;
  [[nodiscard]] Slot append(FeaturePair features) noexcept;
  void close_holes(std::size_t most) noexcept;
  void close_last(Settled& of) noexcept;
  std::uint32_t take_last(Settled& of) noexcept;

  BatchPairs& of_;
  std::uint32_t pairs_ = 0;
  std::vector<Slot> slots_;  // [pair]
  std::vector<BatchBlock> blocks_;
  std::array<Settled, kFeaturePairs> settled_;
  std::vector<std::uint32_t> free_;  // blocks
};

}  // namespace clearance
