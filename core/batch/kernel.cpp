#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/batch/kernel.cpp"
// Four widths: one lane at the x86-64 baseline, SSE4, AVX2, AVX-512; two lanes, NEON, on Arm.
// Instruction sets between these have the same width as one of them.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#endif
#include <hwy/foreach_target.h>
// Keep this order: foreach_target first.
#include <hwy/highway.h>

#include <utility>

#include "core/batch/block.hpp"
#include "core/batch/parallel_transitions-inl.hpp"
#include "core/batch/transitions-inl.hpp"
#include "core/model/error_bounds.hpp"
#include "core/model/result_numbers.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance {
namespace HWY_NAMESPACE {

// The members of Precision that a certificate needs, m.
struct Precisions {
  Lanes error_bound, gap_tolerance;
};

// precision() of core/model/error_bounds.hpp.
HWY_INLINE Precisions precisions(const double* rows, bool plain, const RelativePoses& pose,
                                 Lanes farthest) {
  const auto row = [&](SharedRow r) HWY_ATTR { return load(rows + r * kBlockLanes); };
  const Lanes translation = norm(pose.translation), radius_a = row(kBoundingRadiusA),
              radius_b = row(kBoundingRadiusB);
  Lanes extent_a = radius_a, extent_b = radius_b, ulps = all(kGapToleranceUlps[0]);
  Lanes on_features = row(kErrorBoundA) + row(kErrorBoundB);
  if (!plain) {
    const Lanes at_a = row(kUnboundedA), at_b = row(kUnboundedB);
    extent_a = hn::Max(radius_a, at_a * ((radius_b + translation) + farthest));
    extent_b = hn::Max(radius_b, at_b * ((radius_a + translation) + farthest));
    on_features = on_features + at_a * (all(kUlp * kUlpsOnA) * extent_a);
    on_features = on_features + at_b * (all(kUlp * kUlpsOnB) * extent_b);
    ulps = hn::IfThenElse(hn::Gt(at_a + at_b, all(0.0)), all(kGapToleranceUlps[1]), ulps);
  }
  const Lanes size = (extent_a + extent_b) + translation;
  const Lanes turned = hn::Min(extent_b, (extent_a + translation) + all(kStretched) * farthest);
  const Lanes between = all(kUlp * kUlpsBetween) * translation + pose.translation_error;
  return {(on_features + between) + pose.rotation_error * turned, (ulps * all(kUlp)) * size};
}

// The numbers of a DistanceResult: m, and points and normal in frame A.
struct Answers {
  Lanes distance, lower, upper;
  Points normal, point_a, point_b;
  LaneMask good;  // certified: distance() would have the same result
};

// `kept` where `where`, else `v`.
HWY_INLINE Points unless(LaneMask where, const Points& kept, const Points& v) {
  return {hn::IfThenElse(where, kept.x, v.x), hn::IfThenElse(where, kept.y, v.y),
          hn::IfThenElse(where, kept.z, v.z)};
}

// Moves from the polyhedra's surfaces to those of the swept-sphere bodies.
HWY_INLINE void add_radii(const double* rows, Answers& r) {
  const Lanes radius_a = load(rows + kRadiusA * kBlockLanes);
  const Lanes radius_b = load(rows + kRadiusB * kBlockLanes);
  const Lanes sum = radius_a + radius_b;
  const LaneMask bare = hn::Eq(sum, all(0.0));  // whose zeros keep their signs
  const Lanes rounding =
      hn::IfThenElse(bare, sum, all(kRadiusRounding) * (sum + hn::Abs(r.upper - sum)));
  r.distance = r.distance - sum;
  r.lower = r.lower - (sum + rounding);
  r.upper = r.upper - (sum - rounding);
  r.point_a = unless(bare, r.point_a, r.point_a + radius_a * r.normal);
  r.point_b = unless(bare, r.point_b, r.point_b - radius_b * r.normal);
  r.good = hn::And(r.good, hn::Gt(r.lower, all(0.0)));
}

// certify() of core/feature_tracking/transitions-inl.hpp.
HWY_INLINE Answers certify(const Closest& c, const Precisions& p) {
  const LaneMask narrow = hn::Le(c.distance - c.certified, p.gap_tolerance);
  Answers r{c.distance,
            c.certified - p.error_bound,
            c.distance + p.error_bound,
            c.normal,
            c.point_a,
            c.point_b,
            hn::And(c.closest, hn::And(hn::Gt(c.certified, p.error_bound), narrow))};
  return r;
}

// Writes the results of all lanes. The single query of a failed lane overwrites its result. A lane
// without a pair writes to the spare result behind the last (BatchBlock::pair).
HWY_INLINE void write(const Answers& r, const BatchBlock& block, std::size_t first,
                      DistanceResult* results) {
  double* to[kWidth];
  for (std::size_t i = 0; i < kWidth; ++i) {
    DistanceResult& result = results[block.pair[first + i]];
    to[i] = number_at(result, 0);
    result.status = DistanceStatus::kConverged;
    result.path = DistancePath::kFeatureTracking;
    result.iterations = 1;
  }
  store_columns({{r.distance, r.lower, r.upper, r.normal.x}}, to, 0);
  store_columns({{r.normal.y, r.normal.z, r.point_a.x, r.point_a.y}}, to, 4);
  store_columns({{r.point_a.z, r.point_b.x, r.point_b.y, r.point_b.z}}, to, 8);
}

// One kind of features a block: the choice is made by the compiler, once for all lanes.
template <FeaturePair kPair>
HWY_INLINE Closest closest(const FeatureRows& at, const RelativePoses& pose) {
  if constexpr (kPair == FeaturePair::kVertexVertex) return vertex_vertex(at, pose);
  if constexpr (kPair == FeaturePair::kVertexEdge) return edge_vertex<true>(at, pose);
  if constexpr (kPair == FeaturePair::kVertexFacet) return facet_vertex<true>(at, pose);
  if constexpr (kPair == FeaturePair::kEdgeVertex) return edge_vertex<false>(at, pose);
  if constexpr (kPair == FeaturePair::kEdgeEdge) return edge_edge(at, pose);
  if constexpr (kPair == FeaturePair::kEdgeFacet) return edge_facet<true>(at, pose);
  if constexpr (kPair == FeaturePair::kFacetVertex) return facet_vertex<false>(at, pose);
  if constexpr (kPair == FeaturePair::kFacetEdge) return edge_facet<false>(at, pose);
  if constexpr (kPair == FeaturePair::kFacetFacet) return facet_facet(at, pose);
}

// Lanes [first, first + kWidth) of a block; bit i: lane first + i is good.
template <FeaturePair kPair>
HWY_INLINE std::size_t judge(BatchBlock& block, std::size_t first, const BatchRound& round,
                             FailedLanes& failed) {
  double* rows = block.rows[0].data() + first;
  const Pose* poses = round.world_from_body;
  const RelativePoses pose = relative_poses(load_poses(poses, &block.body_a[first]),
                                            load_poses(poses, &block.body_b[first]));
  const Closest c = closest<kPair>({rows + kFeatureRows * kBlockLanes, block}, pose);
  Answers r = certify(c, precisions(rows, block.plain, pose, c.distance));
  if (HWY_LIKELY(block.plain)) {
    write(r, block, first, round.results);
  } else {
    add_radii(rows, r);
    write(r, block, first, round.results);
  }
  // Certified or not: only what FailedLanes::lanes names is read. If the closest features are not
  // certified, no neighbour takes over, and distance() gets them unchanged.
  hn::Store(hn::IfThenElse(c.closest, all(kNextUnknown), c.next), Tag(), &failed.next[first]);
  if constexpr (has_derivative(kPair)) {
    hn::Store(c.derivative, Tag(), &failed.derivative[first]);
  }
  // A vertex is its own witness point: those rows never change.
  if constexpr (!at_vertex_of_a(kPair)) {
    store_points(c.point_a, r.good, rows + kPointA * kBlockLanes);
  }
  if constexpr (!at_vertex_of_b(kPair)) {
    store_points(c.local_b, r.good, rows + kPointB * kBlockLanes);
  }
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Tag(), r.good, bits);
  return bits[0];
}

// All lanes of a block; bit i: lane i is good.
template <FeaturePair kPair>
std::size_t judge_block(BatchBlock& block, const BatchRound& round, FailedLanes& failed) {
  std::size_t good = 0;
  for (std::size_t first = 0; first < block.lanes; first += kWidth) {
    good |= judge<kPair>(block, first, round, failed) << first;
  }
  return good;
}

// Lists the failed lanes behind the first `count` entries; returns the new count.
template <FeaturePair kPair>
std::size_t judge_list(const BatchRound& round, std::size_t count) {
  const BatchRound::List& list = round.lists[static_cast<std::size_t>(kPair)];
  for (std::size_t k = 0; k < list.count; ++k) {
    BatchBlock& block = round.blocks[list.blocks[k]];
    if (block.taken == 0) continue;
    // This entry is kept only if a lane has failed; otherwise the next block overwrites it. So
    // BatchRound::failed has one entry more than there are blocks.
    FailedLanes& failed = round.failed[count];
#if HWY_TARGET == HWY_AVX3 && (HWY_TARGETS & HWY_AVX2)
    // The narrower vectors take half the time of the wide ones.
    const std::size_t good = block.lanes <= kWidth / 2
                                 ? N_AVX2::judge_block<kPair>(block, round, failed)
                                 : judge_block<kPair>(block, round, failed);
#else
    const std::size_t good = judge_block<kPair>(block, round, failed);
#endif
    failed.block = list.blocks[k];
    failed.lanes = static_cast<std::uint32_t>(block.taken & ~good);
    count += failed.lanes != 0;
  }
  return count;
}

template <std::size_t... kPairs>
HWY_INLINE std::size_t judge_lists(const BatchRound& round, std::index_sequence<kPairs...>) {
  std::size_t count = 0;
  ((count = judge_list<static_cast<FeaturePair>(kPairs)>(round, count)), ...);
  return count;
}

std::size_t judge_all(const BatchRound& round) {
  return judge_lists(round, std::make_index_sequence<kFeaturePairs>());
}

const char* instruction_set() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace clearance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(judge_all);
HWY_EXPORT(instruction_set);

std::size_t run_batch(const BatchRound& round) noexcept {
  return HWY_DYNAMIC_DISPATCH(judge_all)(round);
}

const char* batch_instruction_set() noexcept { return HWY_DYNAMIC_DISPATCH(instruction_set)(); }

}  // namespace clearance
#endif  // HWY_ONCE
