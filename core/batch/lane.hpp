// One pair's numbers in a block of a batch: written when the pair comes to new features.
#pragma once

#include "core/batch/block.hpp"

namespace clearance {

// Can lanes judge the features of `state`? Only distance() can judge penetrating bodies, two
// unbounded bodies, an unbounded body's edge with an edge or facet, and features with too many
// neighbours.
[[nodiscard]] bool fits_lane(const ConvexBody& a, const ConvexBody& b,
                             const TrackingState& state) noexcept;

// Makes an empty block for tracked pairs with one pair of features. no_pair: one past the last
// pair.
void open_block(BatchBlock& block, FeaturePair features, std::uint32_t no_pair) noexcept;

// Writes the rows of a lane in use. `state` has the block's features.
void fill_lane(BatchBlock& block, std::size_t lane, const ConvexBody& a, const ConvexBody& b,
               const TrackingState& state) noexcept;

// The witness points of the last query that vector code has settled.
[[nodiscard]] Vec3 last_point(const BatchBlock& block, std::size_t lane, SharedRow row) noexcept;
void take_last_points(const BatchBlock& block, std::size_t lane, TrackingState& state) noexcept;

}  // namespace clearance
