// The entries of a query: distance() chooses one by the bodies and the state of a pair. Each vector
// width has a set of its own. A batch makes many queries in a row and gets the set once for all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/distance_result.hpp"
#include "core/feature_tracking/feature_tracking.hpp"
#include "core/pose.hpp"

namespace clearance {

// The first 16 entries are for disjoint bodies, both plain, or a point and a plain one. Their index
// is 4 * (kind of the feature on A) + (kind of the feature on B). The further entries are for two
// points, for plain bodies that touched at two facets, and for all other queries.
inline constexpr std::size_t kPointsEntry = 16, kTouchingFacetsEntry = 17, kAnyEntry = 18,
                             kEntries = 19;

struct QueryEntries {
  using ByPoses = DistanceResult (*)(const ConvexBody& a, const ConvexBody& b,
                                     const Pose& world_from_a, const Pose& world_from_b,
                                     TrackingState& state) noexcept;
  using ByRelativePose = DistanceResult (*)(const ConvexBody& a, const ConvexBody& b,
                                            const RelativePose& a_from_b,
                                            TrackingState& state) noexcept;
  // A query of a pair that has made the transitions of `start`.
  using Continued = DistanceResult (*)(const ConvexBody& a, const ConvexBody& b,
                                       const Pose& world_from_a, const Pose& world_from_b,
                                       TrackingState& state, TransitionsMade start) noexcept;

  std::array<ByPoses, kEntries> by_poses;
  std::array<ByRelativePose, kEntries> by_relative_pose;
  ByRelativePose without_depth;
  Continued after_transitions;
};

// One comparison decides for the bodies and for both sides of the state: QueryClass and the kinds
// are numbered for that.
[[nodiscard]] inline std::size_t entry_of(const ConvexBody& a, const ConvexBody& b,
                                          const TrackingState& state) noexcept {
  static_assert(offsetof(TrackingState::Side, penetrating) == 1);
  std::uint16_t on_a;  // the kind and `penetrating`
  std::memcpy(&on_a, &state.a, sizeof on_a);
  const std::uint32_t on_b = static_cast<std::uint32_t>(state.b.kind), classes = query_class(a, b);
  if ((classes | on_a | on_b) < 4) return 4U * on_a + on_b;
  if (state.a.penetrating && state.a.kind == FeatureKind::kFacet &&
      state.b.kind == FeatureKind::kFacet && classes < kTwoPoints) {
    return kTouchingFacetsEntry;
  }
  return classes == kTwoPoints ? kPointsEntry : kAnyEntry;
}

// Those of the machine's vector width. It is looked up once; a program that chooses another width
// afterwards, as tests and benchmarks do, has it looked up again.
[[nodiscard]] const QueryEntries& query_entries() noexcept;
void choose_query_entries() noexcept;

}  // namespace clearance
