// distance(), from top to bottom: the bodies and the state of a pair choose an entry.
//
//   straight features,
//   or two facets ─────► one transition ─► certified ─────────────────────────────► result
//                             └─ moved ─┐
//   other features, or none ────────────┴─► feature tracking ─► certified ────────► result
//                                                 └─ left open ─► penetrating features
//   two facets that touched ► one transition ─► certified ──────────────────────────► result
//                             └─ moved ─┐
//   touched or penetrated in the last query ► penetrating features ─► certified ───► result
//                                                 └─ left open ─► search.hpp
//   two points ────────────────────────────► a closed form
//   a curved body ─────────────────────────► core/curved
//
// Everything in HWY_NAMESPACE is compiled once a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/query/distance.cpp"
#include "core/numerics/simd_targets.hpp"
// The include above must come first.
#include "core/distance.hpp"
#include "core/query/entries.hpp"
#include "core/query/methods-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

template <FeaturePair kPair>
DistanceResult pair_by_poses(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                             const Pose& world_from_b, TrackingState& state) noexcept {
  return from_pair<kPair>(a, b, WorldPoses{world_from_a, world_from_b}, state);
}
template <FeaturePair kPair>
DistanceResult pair_by_relative_pose(const ConvexBody& a, const ConvexBody& b,
                                     const RelativePose& a_from_b, TrackingState& state) noexcept {
  return from_pair<kPair>(a, b, GivenPose{a_from_b}, state);
}

DistanceResult points_by_poses(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                               const Pose& world_from_b, TrackingState& state) noexcept {
  return between_points(a, b, WorldPoses{world_from_a, world_from_b}, state);
}
DistanceResult points_by_relative_pose(const ConvexBody& a, const ConvexBody& b,
                                       const RelativePose& a_from_b,
                                       TrackingState& state) noexcept {
  return between_points(a, b, GivenPose{a_from_b}, state);
}

DistanceResult touching_facets_by_poses(const ConvexBody& a, const ConvexBody& b,
                                        const Pose& world_from_a, const Pose& world_from_b,
                                        TrackingState& state) noexcept {
  return from_touching_facets(a, b, WorldPoses{world_from_a, world_from_b}, state);
}
DistanceResult touching_facets_by_relative_pose(const ConvexBody& a, const ConvexBody& b,
                                                const RelativePose& a_from_b,
                                                TrackingState& state) noexcept {
  return from_touching_facets(a, b, GivenPose{a_from_b}, state);
}

DistanceResult any_by_poses(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                            const Pose& world_from_b, TrackingState& state) noexcept {
  return from_any_bodies(a, b, WorldPoses{world_from_a, world_from_b}, state, true);
}
DistanceResult any_by_relative_pose(const ConvexBody& a, const ConvexBody& b,
                                    const RelativePose& a_from_b, TrackingState& state) noexcept {
  return from_any_bodies(a, b, GivenPose{a_from_b}, state, true);
}
DistanceResult without_depth(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                             TrackingState& state) noexcept {
  return from_any_bodies(a, b, GivenPose{a_from_b}, state, false);
}

DistanceResult after_transitions(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                                 const Pose& world_from_b, TrackingState& state,
                                 TransitionsMade start) noexcept {
  if (query_class(a, b) == kTwoPoints) {
    return points_by_poses(a, b, world_from_a, world_from_b, state);
  }
  return tracked_or_searched(a, b, WorldPoses{world_from_a, world_from_b}, state, start, true);
}

// For each kind on A the entries by kinds on B: vertex, edge, facet, inside.
constexpr QueryEntries kQueryEntries = {
    {pair_by_poses<FeaturePair::kVertexVertex>, pair_by_poses<FeaturePair::kVertexEdge>,
     pair_by_poses<FeaturePair::kVertexFacet>, any_by_poses,
     pair_by_poses<FeaturePair::kEdgeVertex>, pair_by_poses<FeaturePair::kEdgeEdge>, any_by_poses,
     any_by_poses, pair_by_poses<FeaturePair::kFacetVertex>, any_by_poses,
     pair_by_poses<FeaturePair::kFacetFacet>, any_by_poses, any_by_poses, any_by_poses,
     any_by_poses, any_by_poses, points_by_poses, touching_facets_by_poses, any_by_poses},
    {pair_by_relative_pose<FeaturePair::kVertexVertex>,
     pair_by_relative_pose<FeaturePair::kVertexEdge>,
     pair_by_relative_pose<FeaturePair::kVertexFacet>, any_by_relative_pose,
     pair_by_relative_pose<FeaturePair::kEdgeVertex>, pair_by_relative_pose<FeaturePair::kEdgeEdge>,
     any_by_relative_pose, any_by_relative_pose, pair_by_relative_pose<FeaturePair::kFacetVertex>,
     any_by_relative_pose, pair_by_relative_pose<FeaturePair::kFacetFacet>, any_by_relative_pose,
     any_by_relative_pose, any_by_relative_pose, any_by_relative_pose, any_by_relative_pose,
     points_by_relative_pose, touching_facets_by_relative_pose, any_by_relative_pose},
    without_depth,
    after_transitions};

const QueryEntries* entries_of_width() { return &kQueryEntries; }

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <atomic>

namespace clearance {

HWY_EXPORT(entries_of_width);

namespace {

DistanceResult first_by_poses(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                              const Pose& world_from_b, TrackingState& state) noexcept {
  choose_query_entries();
  return distance(a, b, world_from_a, world_from_b, state);
}
DistanceResult first_by_relative_pose(const ConvexBody& a, const ConvexBody& b,
                                      const RelativePose& a_from_b, TrackingState& state) noexcept {
  choose_query_entries();
  return distance(a, b, a_from_b, state);
}
DistanceResult first_without_depth(const ConvexBody& a, const ConvexBody& b,
                                   const RelativePose& a_from_b, TrackingState& state) noexcept {
  choose_query_entries();
  return distance(a, b, a_from_b, state, {.depth = false});
}

// Every entry chooses the machine's vector width first.
constexpr QueryEntries unchosen() {
  QueryEntries entries{};
  entries.by_poses.fill(first_by_poses);
  entries.by_relative_pose.fill(first_by_relative_pose);
  entries.without_depth = first_without_depth;
  return entries;
}
constexpr QueryEntries kUnchosen = unchosen();

constinit std::atomic<const QueryEntries*> chosen_entries = &kUnchosen;

}  // namespace

void choose_query_entries() noexcept {
  chosen_entries.store(HWY_DYNAMIC_DISPATCH(entries_of_width)(), std::memory_order_relaxed);
}

const QueryEntries& query_entries() noexcept {
  if (chosen_entries.load(std::memory_order_relaxed) == &kUnchosen) choose_query_entries();
  return *chosen_entries.load(std::memory_order_relaxed);
}

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                        const Pose& world_from_b, TrackingState& state) noexcept {
  const QueryEntries* const entries = chosen_entries.load(std::memory_order_relaxed);
  return entries->by_poses[entry_of(a, b, state)](a, b, world_from_a, world_from_b, state);
}

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        TrackingState& state, const DistanceOptions& options) noexcept {
  const QueryEntries* const entries = chosen_entries.load(std::memory_order_relaxed);
  const QueryEntries::ByRelativePose entry = HWY_LIKELY(options.depth)
                                                 ? entries->by_relative_pose[entry_of(a, b, state)]
                                                 : entries->without_depth;
  return entry(a, b, a_from_b, state);
}

}  // namespace clearance
#endif  // HWY_ONCE
