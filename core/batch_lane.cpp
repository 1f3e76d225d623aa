#include "core/batch_lane.hpp"

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
  void put(const Vertex& vertex) noexcept { put(vertex.position); }
  void put(const Edge& edge) noexcept {
    put(edge.point);
    put(edge.direction);
    put(edge.begin);
    put(edge.end);
    put(edge.inward[0]);
    put(edge.inward[1]);
  }
  void put(const Facet& facet) noexcept {
    put(facet.normal);
    put(facet.offset);
  }
  void put(const FacetSide& side) noexcept {
    put(side.inward);
    put(side.offset);
  }

 private:
  double* at_;
};

bool few(std::int32_t repeats, std::size_t most = kMostRepeats) noexcept {
  return repeats <= static_cast<std::int32_t>(most);
}

// A feature with what vector code needs of it; a facet without sides is one.
bool can_be_judged(const ConvexPolyhedron& body, const Side& side) noexcept {
  switch (side.dimension) {
    case 0:
      return few(body.vertices[side.feature].edges);
    case 1:
      return true;
    case 2:
      return few(body.facets[side.feature].sides);
    default:
      return false;
  }
}

// How often what repeats of the feature does.
std::int32_t repeats(const ConvexPolyhedron& body, const Side& side) noexcept {
  if (side.dimension == 0) return body.vertices[side.feature].edges;
  return side.dimension == 2 ? body.facets[side.feature].sides : 0;
}

void put_feature(LaneWriter& to, const ConvexPolyhedron& body, const Side& side) noexcept {
  if (side.dimension == 0) to.put(body.vertices[side.feature]);
  if (side.dimension == 1) to.put(body.edges[side.feature]);
  if (side.dimension == 2) to.put(body.facets[side.feature]);
}

void put_repeats(BatchBlock& block, std::size_t lane, std::size_t row, const ConvexPolyhedron& body,
                 const Side& side) noexcept {
  LaneWriter to(block, lane, row);
  for (std::int32_t i = 0; i < repeats(body, side); ++i) {
    if (side.dimension == 0) {
      to.put(body.outgoing_of(body.vertices[side.feature], i));
    } else {
      to.put(body.side_of(body.facets[side.feature], i));
    }
  }
}

// Fills `lane` from its own count up to `most` with its last; a half-space, which has no sides,
// with zeros, within which everything lies.
void pad(BatchBlock& block, std::size_t lane, std::size_t row, std::size_t stride,
         std::size_t count, std::size_t most) noexcept {
  for (std::size_t i = count; i < most; ++i) {
    for (std::size_t k = 0; k < stride; ++k) {
      block.rows[row + stride * i + k][lane] =
          count > 0 ? block.rows[row + stride * (count - 1) + k][lane] : 0.0;
    }
  }
}

// Where what repeats of one body's feature stands in a block.
struct RepeatRows {
  std::size_t row, stride;
};

RepeatRows rows_of_a(FeatureKind kind) noexcept {
  switch (kind) {
    case FeatureKind::kVertexVertex:
      return {kFeatureRows + kDirectionsOfA, kDirectionRows};
    case FeatureKind::kVertexEdge:
      return {kFeatureRows + kDirectionsAtEdge, kDirectionRows};
    case FeatureKind::kVertexFacet:
      return {kFeatureRows + kDirectionsAtFacet, kDirectionRows};
    case FeatureKind::kFacetVertex:
      return {kFeatureRows + kSides, kSideRows};
    case FeatureKind::kFacetFacet:
      return {kFeatureRows + kSidesOfA, kSideRows};
    default:
      return {};
  }
}

RepeatRows rows_of_b(FeatureKind kind) noexcept {
  switch (kind) {
    case FeatureKind::kVertexVertex:
      return {kFeatureRows + kDirectionsOfB, kDirectionRows};
    case FeatureKind::kEdgeVertex:
      return {kFeatureRows + kDirectionsAtEdge, kDirectionRows};
    case FeatureKind::kFacetVertex:
      return {kFeatureRows + kDirectionsAtFacet, kDirectionRows};
    case FeatureKind::kVertexFacet:
      return {kFeatureRows + kSides, kSideRows};
    case FeatureKind::kFacetFacet:
      return {kFeatureRows + kSidesOfB, kSideRows};
    default:
      return {};
  }
}

// Every lane is filled up to the most that any needs; `changed` has only its own.
void level(BatchBlock& block, std::size_t changed, const RepeatRows& at,
           const std::array<std::uint8_t, kBlockLanes>& counts, std::uint8_t& most) noexcept {
  if (counts[changed] > most) {
    most = counts[changed];
    for (std::size_t lane = 0; lane < block.lanes; ++lane) {
      if (lane != changed) pad(block, lane, at.row, at.stride, counts[lane], most);
    }
  }
  pad(block, changed, at.row, at.stride, counts[changed], most);
}

bool point_or_segment(const ConvexPolyhedron& body) noexcept {
  return body.facets.empty() && !body.vertices.empty();
}

bool bare(const ConvexPolyhedron& body, const Side& side) noexcept {
  return point_or_segment(body) && (side.dimension == 1 || body.edges.empty());
}

bool plain(const ConvexPolyhedron& body) noexcept {
  return body.bounded() && body.radius == 0.0 && !point_or_segment(body);
}

void put_common(BatchBlock& block, std::size_t lane, const ConvexPolyhedron& a,
                const ConvexPolyhedron& b, const TrackingState& state) noexcept {
  LaneWriter to(block, lane, 0);
  to.put(a.bounding_radius);
  to.put(b.bounding_radius);
  to.put(a.position_error);
  to.put(b.position_error);
  to.put(a.bounded() ? 0.0 : 1.0);
  to.put(b.bounded() ? 0.0 : 1.0);
  to.put(a.radius);
  to.put(b.radius);
  to.put(bare(a, state.a) ? 1.0 : 0.0);
  to.put(bare(b, state.b) ? 1.0 : 0.0);
  put_last_points(block, lane, state);
}

}  // namespace

std::optional<FeatureKind> feature_kind(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                        const TrackingState& state) noexcept {
  if (state.a.deep || !can_be_judged(a, state.a) || !can_be_judged(b, state.b)) return {};
  if (!a.bounded() && !b.bounded()) return {};
  switch (state.a.dimension * 3 + state.b.dimension) {
    case 0:
      return FeatureKind::kVertexVertex;
    case 1:
      return FeatureKind::kVertexEdge;
    case 2:
      return FeatureKind::kVertexFacet;
    case 3:
      return FeatureKind::kEdgeVertex;
    case 4:
      if (!a.bounded() || !b.bounded()) return {};
      return FeatureKind::kEdgeEdge;
    case 6:
      return FeatureKind::kFacetVertex;
    case 8:
      if (!few(repeats(a, state.a), kMostSidesOfTwo)) return {};
      if (!few(repeats(b, state.b), kMostSidesOfTwo)) return {};
      return FeatureKind::kFacetFacet;
    default:
      return {};
  }
}

void fill_lane(BatchBlock& block, std::size_t lane, const ConvexPolyhedron& a,
               const ConvexPolyhedron& b, const TrackingState& state) noexcept {
  put_common(block, lane, a, b, state);
  LaneWriter to(block, lane, kFeatureRows);
  const bool b_first = state.b.dimension > state.a.dimension;  // the owner
  put_feature(to, b_first ? b : a, b_first ? state.b : state.a);
  put_feature(to, b_first ? a : b, b_first ? state.a : state.b);
  const RepeatRows of_a = rows_of_a(block.kind), of_b = rows_of_b(block.kind);
  if (of_a.stride > 0) put_repeats(block, lane, of_a.row, a, state.a);
  if (of_b.stride > 0) put_repeats(block, lane, of_b.row, b, state.b);
  block.repeats_a[lane] = static_cast<std::uint8_t>(repeats(a, state.a));
  block.repeats_b[lane] = static_cast<std::uint8_t>(repeats(b, state.b));
  level(block, lane, of_a, block.repeats_a, block.most_a);
  level(block, lane, of_b, block.repeats_b, block.most_b);
  block.plain = block.plain && plain(a) && plain(b);
}

void put_last_points(BatchBlock& block, std::size_t lane, const TrackingState& state) noexcept {
  LaneWriter to(block, lane, kPointA);
  to.put(state.a.point);
  to.put(state.b.point);
}

Vec3 last_point(const BatchBlock& block, std::size_t lane, CommonRow row) noexcept {
  return {block.rows[row][lane], block.rows[row + 1][lane], block.rows[row + 2][lane]};
}

}  // namespace clearance
