// The thesis's active-set iteration in its variants (§4.1), over the core's tables and its delta,
// alpha and lambda. It has none of the core's additions: no certificate, no rule for ties, no
// feature tracking.
#pragma once

#include "core/active_set/active_feature.hpp"
#include "core/active_set/alpha_step_length.hpp"
#include "core/active_set/delta_step.hpp"
#include "core/active_set/lambda_multipliers.hpp"
#include "tools/bench/thesis/whole_scan.hpp"

namespace clearance::bench {

enum class Release {
  kBase,        // at the optimum of the active set, the best one of both bodies (§3.3.2)
  kDual,        // there, the best one of each body
  kConsistent,  // at every cycle, the best one of both bodies; ends when there is none (§3.4.3.4)
  kAggressive,  // at every cycle, all there are
};

enum class Scan {
  kNeighbours,  // alpha over the feature's own boundary (§3.6.1)
  kAllFacets,   // alpha over all facets (§3.3.1.3)
};

struct LoopEnd {
  bool ok;  // false: not finished after kCycles, which here means that it cycles
  int cycles;
};

namespace variant {

constexpr int kCycles = 1000;
constexpr double kContact = 1e-13;  // m
// A release that gains less than this share of the distance is no gain.
constexpr double kRate = 1e-12;

template <Scan kScan>
bool step(ActiveFeature& a, ActiveFeature& b) {
  const Delta to = delta(a, b);
  const Vec3 move_a = to.a - a.point_A(), move_b = to.b - b.point_A();
  const auto alpha_of = [](const ActiveFeature& side, const Vec3& move) {
    return kScan == Scan::kNeighbours ? alpha(side, move) : alpha_over_all(side, move);
  };
  const Alpha alpha_a = alpha_of(a, move_a), alpha_b = alpha_of(b, move_b);
  advance(a, move_a, alpha_a);
  advance(b, move_b, alpha_b);
  return alpha_a.blocking == kNone && alpha_b.blocking == kNone;
}

inline void let_go(ActiveFeature& side, const Lambda& l) {
  side.place(l.to, l.index, side.point_L());
}

// The best release of both bodies, or of each.
template <Release kRelease>
bool release_best(ActiveFeature& a, ActiveFeature& b, double least) {
  const Vec3 towards = b.point_A() - a.point_A();
  const Lambda lambda_a = lambda(a, towards), lambda_b = lambda(b, -towards);
  const bool a_wants = lambda_a.derivative > least, b_wants = lambda_b.derivative > least;
  const bool both = kRelease == Release::kDual;
  const bool a_first = lambda_a.derivative >= lambda_b.derivative;
  if (a_wants && (both || a_first)) let_go(a, lambda_a);
  if (b_wants && (both || !a_first)) let_go(b, lambda_b);
  return a_wants || b_wants;
}

// Drops every active facet with a negative multiplier at once; returns the feature that is left.
inline bool release_all(ActiveFeature& side, const Vec3& towards_in_a, double least) {
  const Lambda best = lambda(side, towards_in_a);
  if (!(best.derivative > least)) return false;
  const Vec3 towards = side.direction_A_to_L(towards_in_a);
  if (side.feature() == FeatureKind::kEdge) {
    const bool both = (side.edge().inward * towards).minCoeff() > least;
    if (both)
      side.place_inside(side.point_L());
    else
      let_go(side, best);
    return true;
  }
  if (side.feature() != FeatureKind::kVertex) {
    let_go(side, best);
    return true;
  }
  // A vertex: one rising edge leaves that edge, two of one facet that facet, others the inside.
  const Vertex& vertex = side.vertex();
  int rising = 0;
  std::int32_t other = kNone;
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    if (!(side.body().outgoing_of(vertex, i).dot(towards) > least)) continue;
    ++rising;
    const std::int32_t edge = side.body().vertex_edges[vertex.first_edge + i].edge;
    if (edge != best.index) other = edge;
  }
  if (rising == 1) {
    let_go(side, best);
    return true;
  }
  const Edge& e = side.body().edges[best.index];
  const Edge& f = side.body().edges[other];
  for (const std::int32_t facet : e.facet) {
    if (rising != 2 || (facet != f.facet[0] && facet != f.facet[1])) continue;
    side.place(FeatureKind::kFacet, facet, side.point_L());
    return true;
  }
  side.place_inside(side.point_L());
  return true;
}

inline bool release_all(ActiveFeature& a, ActiveFeature& b, double least) {
  const Vec3 towards = b.point_A() - a.point_A();
  const bool from_a = release_all(a, towards, least);
  return release_all(b, -towards, least) || from_a;
}

}  // namespace variant

template <Release kRelease, Scan kScan>
LoopEnd dqp3_variant(ActiveFeature& a, ActiveFeature& b) {
  using namespace variant;
  for (int cycle = 1; cycle <= kCycles; ++cycle) {
    const double apart = (b.point_A() - a.point_A()).norm();
    if (apart < kContact) return {true, cycle};
    const double least = kRate * apart;
    if constexpr (kRelease == Release::kAggressive) {
      release_all(a, b, least);
      if (step<kScan>(a, b) && !release_all(a, b, least)) return {true, cycle};
    } else if constexpr (kRelease == Release::kConsistent) {
      const bool active =
          a.feature() != FeatureKind::kInside && b.feature() != FeatureKind::kInside;
      if (active && !release_best<kRelease>(a, b, least)) return {true, cycle};
      step<kScan>(a, b);
    } else {
      if (!step<kScan>(a, b)) continue;
      const double left = (b.point_A() - a.point_A()).norm();
      if (left < kContact || !release_best<kRelease>(a, b, kRate * left)) return {true, cycle};
    }
  }
  return {false, variant::kCycles};
}

}  // namespace clearance::bench
