// The kinds of the closest features of A and B. Feature tracking, its first transition and a
// batch's blocks all branch on this and on nothing else.
#pragma once

#include <cstddef>

#include "core/distance_result.hpp"

namespace clearance {

// The feature named first is A's. Numbered as 3 * kind on A + kind on B.
enum class FeaturePair : int {
  kVertexVertex,
  kVertexEdge,
  kVertexFacet,
  kEdgeVertex,
  kEdgeEdge,
  kEdgeFacet,
  kFacetVertex,
  kFacetEdge,
  kFacetFacet,
};
inline constexpr std::size_t kFeaturePairs = 9;

// Requires features that the bodies have, or kUnknown. With kUnknown the value is none of the
// enumerators.
[[nodiscard]] constexpr FeaturePair feature_pair(FeatureKind on_a, FeatureKind on_b) noexcept {
  return static_cast<FeaturePair>(3 * static_cast<int>(on_a) + static_cast<int>(on_b));
}
[[nodiscard]] constexpr FeaturePair feature_pair(const TrackingState& state) noexcept {
  return feature_pair(state.a.kind, state.b.kind);
}
[[nodiscard]] constexpr FeatureKind kind_on_a(FeaturePair pair) noexcept {
  return static_cast<FeatureKind>(static_cast<int>(pair) / 3);
}
[[nodiscard]] constexpr FeatureKind kind_on_b(FeaturePair pair) noexcept {
  return static_cast<FeatureKind>(static_cast<int>(pair) % 3);
}

}  // namespace clearance
