#include "core/batch/lane.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace clearance {
namespace {

using Side = TrackingState::Side;

// Numbers of one lane, row after row.
class LaneWriter {
 public:
  LaneWriter(BatchBlock& block, std::size_t lane, std::size_t row) : at_(&block.rows[row][lane]) {}

  void put(double value) noexcept {
    *at_ = value;
    at_ += kBlockLanes;
  }
  void put(const Vec3& v) noexcept {
    put(v.x());
    put(v.y());
    put(v.z());
  }

 private:
  double* at_;
};

bool few(std::int32_t repeats, std::size_t most = kMostRepeats) noexcept {
  return repeats <= static_cast<std::int32_t>(most);
}

// The number of edges of a vertex, or of limits of a facet.
template <FeatureKind kKind>
std::int32_t repeats_of(const ConvexBody& body, const Side& side) noexcept {
  if constexpr (kKind == FeatureKind::kVertex) return body.vertices[side.feature].edges;
  return body.facets[side.feature].limits;
}
std::int32_t repeats(const ConvexBody& body, const Side& side) noexcept {
  if (side.kind == FeatureKind::kEdge) return 0;
  return side.kind == FeatureKind::kVertex ? repeats_of<FeatureKind::kVertex>(body, side)
                                           : repeats_of<FeatureKind::kFacet>(body, side);
}

// Their numbers as the body keeps them.
template <FeatureKind kKind>
const double* row_of(const ConvexBody& body, const Side& side) noexcept {
  if constexpr (kKind == FeatureKind::kVertex) {
    return body.outgoing.row(body.vertices[side.feature].first_edge);
  }
  return body.facet_limits.row(body.facets[side.feature].first_side);
}
template <FeatureKind kKind>
constexpr std::size_t kStride = kKind == FeatureKind::kVertex ? kDirectionRows : kSideRows;

// Is this a feature that vector code can judge? A facet without sides is one. The witness point of
// a vertex has to be the vertex, because lanes do not write it. This holds after any query except
// of touching bodies.
bool can_be_judged(const ConvexBody& body, const Side& side) noexcept {
  if (side.kind > FeatureKind::kFacet || !few(repeats(body, side))) return false;
  return side.kind != FeatureKind::kVertex || side.point == body.vertices[side.feature].position;
}

// The feature's own numbers.
template <FeatureKind kKind>
void put(const ConvexBody& body, const Side& side, LaneWriter& to) noexcept {
  if constexpr (kKind == FeatureKind::kVertex) {
    to.put(body.vertices[side.feature].position);
  } else if constexpr (kKind == FeatureKind::kFacet) {
    const Facet& facet = body.facets[side.feature];
    to.put(facet.normal);
    to.put(facet.offset);
  } else {
    const Edge& edge = body.edges[side.feature];
    to.put(edge.point);
    to.put(edge.direction);
    to.put(edge.begin);
    to.put(edge.end);
    to.put(edge.inward.row(0));
    to.put(edge.inward.row(1));
  }
}

// Fills a lane with fewer than `most` entries by repeating its last one. A half-space, which has no
// sides, gets zeros: limits within which everything lies.
void lengthen(BatchBlock& block, std::size_t lane, std::size_t row, std::size_t stride,
              std::size_t before, std::size_t most) noexcept {
  for (std::size_t i = stride * before; i < stride * most; ++i) {
    block.rows[row + i][lane] = before > 0 ? block.rows[row + i - stride][lane] : 0.0;
  }
}

// Writes the edges or limits of one body's feature into a lane, from `row` on. Every lane has as
// many as the one with the most.
template <FeatureKind kKind>
void put_repeats(BatchBlock& block, std::size_t lane, std::size_t row, const ConvexBody& body,
                 const Side& side, std::uint8_t& most) noexcept {
  constexpr std::size_t stride = kStride<kKind>;
  const auto count = static_cast<std::size_t>(repeats_of<kKind>(body, side));
  row += kFeatureRows;
  if (count > most) {
    for (std::size_t other = 0; other < block.lanes; ++other) {
      lengthen(block, other, row, stride, most, count);
    }
    most = static_cast<std::uint8_t>(count);
  }
  const double* const from = row_of<kKind>(body, side);
  LaneWriter to(block, lane, row);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < stride; ++k) to.put(from[(i / 4 * stride + k) * 4 + i % 4]);
  }
  lengthen(block, lane, row, stride, count, most);
}

// The first row of these entries, by the kinds of the body's feature and of the other body's. The
// neighbours of an edge are among its own numbers.
constexpr std::size_t repeats_row(FeatureKind of, FeatureKind other, bool is_b) noexcept {
  const bool vertex = of == FeatureKind::kVertex;
  if (of == other && vertex) return is_b ? kDirectionsOfB : kDirectionsOfA;
  if (of == other) return is_b ? kSidesOfB : kSidesOfA;
  if (other == FeatureKind::kEdge) return vertex ? kDirectionsAtEdge : kSidesAtEdge;
  return vertex ? kDirectionsAtFacet : kSides;
}

// Writes first the feature of more dimensions, or A's if both have the same kind; then the edges or
// limits.
template <FeatureKind kOfA, FeatureKind kOfB>
void put_features(BatchBlock& block, std::size_t lane, const ConvexBody& a, const ConvexBody& b,
                  const TrackingState& state) noexcept {
  LaneWriter to(block, lane, kFeatureRows);
  if constexpr (kOfB > kOfA) put<kOfB>(b, state.b, to);
  put<kOfA>(a, state.a, to);
  if constexpr (kOfB <= kOfA) put<kOfB>(b, state.b, to);
  if constexpr (kOfA != FeatureKind::kEdge) {
    constexpr std::size_t row = repeats_row(kOfA, kOfB, false);
    put_repeats<kOfA>(block, lane, row, a, state.a, block.most_a);
  }
  if constexpr (kOfB != FeatureKind::kEdge) {
    constexpr std::size_t row = repeats_row(kOfB, kOfA, true);
    put_repeats<kOfB>(block, lane, row, b, state.b, block.most_b);
  }
}

using PutFeatures = void (*)(BatchBlock&, std::size_t, const ConvexBody&, const ConvexBody&,
                             const TrackingState&) noexcept;

// [feature pair]
template <std::size_t... kPairs>
constexpr std::array<PutFeatures, kFeaturePairs> put_features_table(
    std::index_sequence<kPairs...>) noexcept {
  return {put_features<kind_on_a(static_cast<FeaturePair>(kPairs)),
                       kind_on_b(static_cast<FeaturePair>(kPairs))>...};
}
constexpr auto kPutFeatures = put_features_table(std::make_index_sequence<kFeaturePairs>());

// Bodies without facets have features with nothing beside them.
bool point_or_segment(const ConvexBody& body) noexcept {
  return body.facets.empty() && !body.vertices.empty();
}

// Has the feature no neighbours? The ends of a segment have one, its edge.
bool bare(const ConvexBody& body, const Side& side) noexcept {
  return point_or_segment(body) && (side.kind == FeatureKind::kEdge || body.edges.empty());
}

// Has the body nothing for the rows from kFirstSpecialRow on? Vector code skips these rows in a
// block of plain pairs.
bool plain(const ConvexBody& body) noexcept {
  return body.bounded() && body.radius == 0.0 && !point_or_segment(body);
}

// These rows are not read in a plain block, so they have not been written so far.
void stay_plain_no_longer(BatchBlock& block) noexcept {
  block.plain = false;
  for (std::size_t row = kFirstSpecialRow; row < kPointA; ++row) block.rows[row].fill(0.0);
}

// Writes the numbers of a lane that do not depend on its features: its bodies' and the last witness
// points.
void put_shared(BatchBlock& block, std::size_t lane, const ConvexBody& a, const ConvexBody& b,
                const TrackingState& state) noexcept {
  LaneWriter to(block, lane, 0);
  to.put(a.bounding_radius);
  to.put(b.bounding_radius);
  to.put(a.error_bound_as_a);
  to.put(b.error_bound_as_b);
  LaneWriter points(block, lane, kPointA);
  points.put(state.a.point);
  points.put(state.b.point);
  if (block.plain) {
    if (plain(a) && plain(b)) return;
    stay_plain_no_longer(block);
  }
  to.put(a.bounded() ? 0.0 : 1.0);
  to.put(b.bounded() ? 0.0 : 1.0);
  to.put(a.radius);
  to.put(b.radius);
  to.put(bare(a, state.a) ? 1.0 : 0.0);
  to.put(bare(b, state.b) ? 1.0 : 0.0);
}

}  // namespace

bool fits_lane(const ConvexBody& a, const ConvexBody& b, const TrackingState& state) noexcept {
  if (state.a.penetrating || !can_be_judged(a, state.a) || !can_be_judged(b, state.b)) return false;
  if (!a.bounded() && !b.bounded()) return false;
  // An edge of an unbounded body may have no ends: core/feature_tracking leaves it undecided as
  // well.
  switch (feature_pair(state)) {
    case FeaturePair::kEdgeEdge:
      return a.bounded() && b.bounded();
    case FeaturePair::kEdgeFacet:
      return a.bounded();
    case FeaturePair::kFacetEdge:
      return b.bounded();
    case FeaturePair::kFacetFacet:
      return few(repeats(a, state.a), kMostSidesOfTwo) && few(repeats(b, state.b), kMostSidesOfTwo);
    default:
      return true;
  }
}

void open_block(BatchBlock& block, FeaturePair features, std::uint32_t no_pair) noexcept {
  block.features = features;
  block.pair.fill(no_pair);
  block.lanes = block.taken = block.most_a = block.most_b = 0;
  block.plain = true;
}

void fill_lane(BatchBlock& block, std::size_t lane, const ConvexBody& a, const ConvexBody& b,
               const TrackingState& state) noexcept {
  assert(lane < kBlockLanes && feature_pair(state) == block.features && fits_lane(a, b, state));
  put_shared(block, lane, a, b, state);
  kPutFeatures[static_cast<std::size_t>(block.features)](block, lane, a, b, state);
}

void take_last_points(const BatchBlock& block, std::size_t lane, TrackingState& state) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    state.a.point[static_cast<Eigen::Index>(i)] = block.rows[kPointA + i][lane];
    state.b.point[static_cast<Eigen::Index>(i)] = block.rows[kPointB + i][lane];
  }
}

Vec3 last_point(const BatchBlock& block, std::size_t lane, SharedRow row) noexcept {
  return {block.rows[row][lane], block.rows[row + 1][lane], block.rows[row + 2][lane]};
}

}  // namespace clearance
