#include "core/batch/lane.hpp"

#include <algorithm>
#include <array>
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

// How often what repeats of the feature does.
std::int32_t repeats(const ConvexPolyhedron& body, const Side& side) noexcept {
  if (side.kind == FeatureKind::kVertex) return body.vertices[side.feature].edges;
  return side.kind == FeatureKind::kFacet ? body.facets[side.feature].limits : 0;
}

// A feature with what vector code needs of it; a facet without sides is one. Of a vertex, the
// witness point is where it is, as after any query but those that touch: lanes do not write it.
bool can_be_judged(const ConvexPolyhedron& body, const Side& side) noexcept {
  if (side.kind > FeatureKind::kFacet || !few(repeats(body, side))) return false;
  return side.kind != FeatureKind::kVertex || side.point == body.vertices[side.feature].position;
}

// Vertices, edges and facets as LaneWriters and loops see them.
template <FeatureKind kKind>
struct LaneFeature;

template <>
struct LaneFeature<FeatureKind::kVertex> {
  static constexpr std::size_t kStride = kDirectionRows;
  const Vertex& vertex;
  const VectorRows& table;

  LaneFeature(const ConvexPolyhedron& body, const Side& side) noexcept
      : vertex(body.vertices[side.feature]), table(body.outgoing) {}
  void put(LaneWriter& to) const noexcept { to.put(vertex.position); }
  [[nodiscard]] std::int32_t repeats() const noexcept { return vertex.edges; }
  [[nodiscard]] const double* row() const noexcept { return table.row(vertex.first_edge); }
};

template <>
struct LaneFeature<FeatureKind::kEdge> {
  static constexpr std::size_t kStride = 0;
  const Edge& edge;

  LaneFeature(const ConvexPolyhedron& body, const Side& side) noexcept
      : edge(body.edges[side.feature]) {}
  void put(LaneWriter& to) const noexcept {
    to.put(edge.point);
    to.put(edge.direction);
    to.put(edge.begin);
    to.put(edge.end);
    to.put(edge.inward.row(0));
    to.put(edge.inward.row(1));
  }
};

template <>
struct LaneFeature<FeatureKind::kFacet> {
  static constexpr std::size_t kStride = kSideRows;
  const Facet& facet;
  const VectorRows& table;

  LaneFeature(const ConvexPolyhedron& body, const Side& side) noexcept
      : facet(body.facets[side.feature]), table(body.facet_limits) {}
  void put(LaneWriter& to) const noexcept {
    to.put(facet.normal);
    to.put(facet.offset);
  }
  [[nodiscard]] std::int32_t repeats() const noexcept { return facet.limits; }
  [[nodiscard]] const double* row() const noexcept { return table.row(facet.first_side); }
};

// Of a lane in which less repeats than `most` times: the last once more; of a half-space, which has
// no sides, zeros, within which everything lies.
void lengthen(BatchBlock& block, std::size_t lane, std::size_t row, std::size_t stride,
              std::size_t before, std::size_t most) noexcept {
  for (std::size_t i = stride * before; i < stride * most; ++i) {
    block.rows[row + i][lane] = before > 0 ? block.rows[row + i - stride][lane] : 0.0;
  }
}

// What repeats of one body's feature in a lane, from `row` on.
template <FeatureKind kKind>
void put_row(BatchBlock& block, std::size_t lane, std::size_t row, const LaneFeature<kKind>& of,
             std::size_t most) noexcept {
  constexpr std::size_t kStride = LaneFeature<kKind>::kStride;
  const auto count = static_cast<std::size_t>(of.repeats());
  const double* const from = of.row();
  LaneWriter to(block, lane, row);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < kStride; ++k) to.put(from[k * count + i]);
  }
  lengthen(block, lane, row, kStride, count, most);
}

// Every lane has as many as any needs.
template <FeatureKind kKind>
void put_repeats(BatchBlock& block, std::size_t lane, std::size_t row, const LaneFeature<kKind>& of,
                 std::uint8_t& most) noexcept {
  const auto count = static_cast<std::uint8_t>(of.repeats());
  if (count > most) {
    for (std::size_t other = 0; other < block.lanes; ++other) {
      lengthen(block, other, kFeatureRows + row, LaneFeature<kKind>::kStride, most, count);
    }
    most = count;
  }
  put_row(block, lane, kFeatureRows + row, of, most);
}

// What repeats of both features, of A's first; the edge's neighbours are among its own numbers.
template <FeatureKind kOfA, FeatureKind kOfB>
void put_repeats(BatchBlock& block, std::size_t lane, const LaneFeature<kOfA>& a,
                 const LaneFeature<kOfB>& b) noexcept {
  constexpr bool kAlike = kOfA == kOfB;
  constexpr bool kWithEdge = kOfA == FeatureKind::kEdge || kOfB == FeatureKind::kEdge;
  constexpr std::size_t kAtVertex = kWithEdge ? kDirectionsAtEdge : kDirectionsAtFacet;
  constexpr std::size_t kAtFacet = kWithEdge ? kSidesAtEdge : kSides;
  constexpr bool kVertexOfA = kOfA == FeatureKind::kVertex,
                 kVertexOfB = kOfB == FeatureKind::kVertex;
  constexpr std::size_t kRowOfA =
      kVertexOfA ? (kAlike ? kDirectionsOfA : kAtVertex) : (kAlike ? kSidesOfA : kAtFacet);
  constexpr std::size_t kRowOfB =
      kVertexOfB ? (kAlike ? kDirectionsOfB : kAtVertex) : (kAlike ? kSidesOfB : kAtFacet);
  if constexpr (kOfA != FeatureKind::kEdge) put_repeats(block, lane, kRowOfA, a, block.most_a);
  if constexpr (kOfB != FeatureKind::kEdge) put_repeats(block, lane, kRowOfB, b, block.most_b);
}

template <FeatureKind kOfA, FeatureKind kOfB>
void put_features(BatchBlock& block, std::size_t lane, const ConvexPolyhedron& a,
                  const ConvexPolyhedron& b, const TrackingState& state) noexcept {
  const LaneFeature<kOfA> of_a(a, state.a);
  const LaneFeature<kOfB> of_b(b, state.b);
  LaneWriter to(block, lane, kFeatureRows);
  if constexpr (kOfB > kOfA) {  // the owner
    of_b.put(to);
    of_a.put(to);
  } else {
    of_a.put(to);
    of_b.put(to);
  }
  put_repeats(block, lane, of_a, of_b);
}

using PutFeatures = void (*)(BatchBlock&, std::size_t, const ConvexPolyhedron&,
                             const ConvexPolyhedron&, const TrackingState&) noexcept;

// [feature pair]
template <std::size_t... kPairs>
constexpr std::array<PutFeatures, kFeaturePairs> put_features_table(
    std::index_sequence<kPairs...>) noexcept {
  return {put_features<kind_on_a(static_cast<FeaturePair>(kPairs)),
                       kind_on_b(static_cast<FeaturePair>(kPairs))>...};
}
constexpr auto kPutFeatures = put_features_table(std::make_index_sequence<kFeaturePairs>());

bool point_or_segment(const ConvexPolyhedron& body) noexcept {
  return body.facets.empty() && !body.vertices.empty();
}

bool bare(const ConvexPolyhedron& body, const Side& side) noexcept {
  return point_or_segment(body) && (side.kind == FeatureKind::kEdge || body.edges.empty());
}

bool plain(const ConvexPolyhedron& body) noexcept {
  return body.bounded() && body.radius == 0.0 && !point_or_segment(body);
}

// Zeros until then: nobody has read these rows.
void stay_plain_no_longer(BatchBlock& block) noexcept {
  block.plain = false;
  for (std::size_t row = kBeyondPlain; row < kPointA; ++row) block.rows[row].fill(0.0);
}

void put_common(BatchBlock& block, std::size_t lane, const ConvexPolyhedron& a,
                const ConvexPolyhedron& b, const TrackingState& state) noexcept {
  LaneWriter to(block, lane, 0);
  to.put(a.bounding_radius);
  to.put(b.bounding_radius);
  to.put(a.slack_as_a);
  to.put(b.slack_as_b);
  put_last_points(block, lane, state);
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

std::optional<FeaturePair> lane_features(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                         const TrackingState& state) noexcept {
  if (state.a.penetrating || !can_be_judged(a, state.a) || !can_be_judged(b, state.b)) return {};
  if (!a.bounded() && !b.bounded()) return {};
  const FeaturePair features = feature_pair(state);
  switch (features) {
    case FeaturePair::kEdgeEdge:
      if (!a.bounded() || !b.bounded()) return {};
      break;
    case FeaturePair::kEdgeFacet:
      if (!a.bounded()) return {};
      break;
    case FeaturePair::kFacetEdge:
      if (!b.bounded()) return {};
      break;
    case FeaturePair::kFacetFacet:
      if (!few(repeats(a, state.a), kMostSidesOfTwo)) return {};
      if (!few(repeats(b, state.b), kMostSidesOfTwo)) return {};
      break;
    default:
      break;
  }
  return features;
}

void open_block(BatchBlock& block, FeaturePair features, std::uint32_t no_pair) noexcept {
  block.features = features;
  block.pair.fill(no_pair);
  block.lanes = block.taken = block.most_a = block.most_b = 0;
  block.plain = true;
}

void fill_lane(BatchBlock& block, std::size_t lane, const ConvexPolyhedron& a,
               const ConvexPolyhedron& b, const TrackingState& state) noexcept {
  put_common(block, lane, a, b, state);
  kPutFeatures[static_cast<std::size_t>(block.features)](block, lane, a, b, state);
}

void put_last_points(BatchBlock& block, std::size_t lane, const TrackingState& state) noexcept {
  LaneWriter to(block, lane, kPointA);
  to.put(state.a.point);
  to.put(state.b.point);
}

void take_last_points(const BatchBlock& block, std::size_t lane, TrackingState& state) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    state.a.point[static_cast<Eigen::Index>(i)] = block.rows[kPointA + i][lane];
    state.b.point[static_cast<Eigen::Index>(i)] = block.rows[kPointB + i][lane];
  }
}

Vec3 last_point(const BatchBlock& block, std::size_t lane, CommonRow row) noexcept {
  return {block.rows[row][lane], block.rows[row + 1][lane], block.rows[row + 2][lane]};
}

}  // namespace clearance
