// Eight pairs of a batch, in the order in which vector code reads them.
//
// A row holds one number of eight tracked pairs and is a cache line. Vectors of 2, 4 or 8 lanes
// read the same rows. All pairs of a block have the same FeaturePair, so that straight-line code
// decides whether the features are still closest. It gathers nothing: a pair's feature numbers are
// written into the rows when the pair comes to these features.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/distance_result.hpp"
#include "core/feature_tracking/feature_pair.hpp"
#include "core/pose.hpp"

namespace clearance {

inline constexpr std::size_t kBlockLanes = 8;

// For these kinds the witness point stays at the vertex: fill_lane() writes it, the vector code
// does not.
constexpr bool at_vertex_of_a(FeaturePair pair) { return kind_on_a(pair) == FeatureKind::kVertex; }
constexpr bool at_vertex_of_b(FeaturePair pair) { return kind_on_b(pair) == FeatureKind::kVertex; }

// Rows that every kind has. Lengths in metres; `unbounded` and `bare` are 1 or 0. The rows from
// kFirstSpecialRow up to the points are neither read nor kept in a plain block.
enum SharedRow : std::size_t {
  kBoundingRadiusA,
  kBoundingRadiusB,
  kErrorBoundA,  // ConvexBody::error_bound_as_a, error_bound_as_b
  kErrorBoundB,
  kFirstSpecialRow,
  kUnboundedA = kFirstSpecialRow,
  kUnboundedB,
  kRadiusA,
  kRadiusB,
  kIsolatedA,  // nothing is beside the feature: a point's only vertex, a segment's only edge
  kIsolatedB,
  kPointA,                // 3 rows: the witness points of the last query, each in its body's frame
  kPointB = kPointA + 3,  // 3 rows
  kFeatureRows = kPointB + 3
};

// Rows of the features, from kFeatureRows on. The feature of more dimensions comes first; if both
// have the same kind, A's does. After the features come the entries that repeat:
//   edge    point 3, direction 3, begin, end, inward[0] 3, inward[1] 3
//   facet   normal 3, offset
//   vertex  position 3
//   limits of a facet: inward 3, offset each; edges of a vertex: outgoing direction 3 each
inline constexpr std::size_t kMostRepeats = 8;  // features with more are left to the single query
inline constexpr std::size_t kEdgeRows = 14, kFacetRows = 4, kVertexRows = 3;
inline constexpr std::size_t kSideRows = 4, kDirectionRows = 3;
inline constexpr std::size_t kInwardRow = 8;  // of an edge

inline constexpr std::size_t kDirectionsOfA = 2 * kVertexRows;  // vertex-vertex
inline constexpr std::size_t kDirectionsOfB = kDirectionsOfA + kMostRepeats * kDirectionRows;
inline constexpr std::size_t kDirectionsAtEdge = kEdgeRows + kVertexRows;  // edge-vertex
inline constexpr std::size_t kSides = kFacetRows + kVertexRows;            // facet-vertex
inline constexpr std::size_t kSidesAtEdge = kFacetRows + kEdgeRows;        // edge-facet
inline constexpr std::size_t kDirectionsAtFacet = kSides + kMostRepeats * kSideRows;
inline constexpr std::size_t kSidesOfA = 2 * kFacetRows;  // facet-facet
inline constexpr std::size_t kMostSidesOfTwo = 6;         // of each: as many as the rows can hold
inline constexpr std::size_t kSidesOfB = kSidesOfA + kMostSidesOfTwo * kSideRows;

inline constexpr std::size_t kRows =
    kFeatureRows + kDirectionsAtFacet + kMostRepeats * kDirectionRows;
static_assert(kSidesOfB + kMostSidesOfTwo * kSideRows <= kRows - kFeatureRows);
static_assert(kSidesAtEdge + kMostRepeats * kSideRows <= kRows - kFeatureRows);

struct alignas(64) BatchBlock {
  std::array<std::uint32_t, kBlockLanes> body_a{}, body_b{};
  std::array<std::uint32_t, kBlockLanes> pair{};  // of a lane not in use: one past the last pair
  // The largest number of entries of any lane since the block was empty, for A's feature and for
  // B's. An entry is an edge of a vertex or a limit of a facet. Lanes with fewer repeat their last
  // one.
  std::uint8_t most_a = 0, most_b = 0;
  std::uint8_t lanes = 0;  // in use: [0, lanes), but for those that a pair has left
  std::uint8_t taken = 0;  // bit i: a pair is in lane i
  bool plain = true;       // no body in it has been unbounded, a point, a segment, or with a radius
  FeaturePair features = FeaturePair::kVertexVertex;
  alignas(64) std::array<std::array<double, kBlockLanes>, kRows> rows{};
};

// The neighbour that takes over when the features are no longer the closest.
enum NextFeature : std::int32_t {
  kNextUnknown = -1,  // rounding cannot tell, or lanes do not decide it
  // 0 and more: an index. For a vertex and an edge, it is the index of an edge of the vertex. For a
  // facet and a vertex, it is that of a side of the facet. For two vertices it is that of an edge
  // of A's vertex.
  kNextOfOther = kMostRepeats,     // + i: the edge of a vertex at a facet, of B's of two
  kNextBeside = 2 * kMostRepeats,  // + k: of an edge at a vertex, its facet
  kNextEnd = kNextBeside + 2,      // + k: of an edge (A's of two) its vertex
  kNextEndB = kNextEnd + 2,        // + k: of B's of two
  // Less than kNextEnd, of two edges: i + kNextBesideB * j, facet i - 1 of A's and j - 1 of B's.
  kNextBesideB = 3,
};

// The lanes of a block whose pairs distance() has to answer: bit i, lane i.
struct alignas(64) FailedLanes {
  std::uint32_t block, lanes;
  alignas(64) std::array<double, kBlockLanes> next;  // NextFeature
  // For two vertices: along that edge. For a facet and a vertex: from the vertex along that edge to
  // the plane, m.
  std::array<double, kBlockLanes> derivative;
};
constexpr bool has_derivative(FeaturePair pair) {
  return pair == FeaturePair::kVertexVertex || pair == FeaturePair::kVertexFacet ||
         pair == FeaturePair::kFacetVertex;
}

// One round of the vector code over all blocks.
struct BatchRound {
  BatchBlock* blocks = nullptr;
  const Pose* world_from_body = nullptr;
  DistanceResult* results = nullptr;  // [pair]
  FailedLanes* failed = nullptr;      // [blocks + 1]
  struct List {
    const std::uint32_t* blocks = nullptr;
    std::size_t count = 0;
  };
  std::array<List, kFeaturePairs> lists;
};

// Judges every lane. If the features of the last query are still closest and the distance is
// certified, writes the result of distance(), bit for bit. The other lanes are listed as failed;
// returns in how many blocks. Uses the widest vectors that the machine has; the results do not
// depend on it.
[[nodiscard]] std::size_t run_batch(const BatchRound& round) noexcept;

// The instruction set that run_batch uses here: "AVX3" (AVX-512), "AVX2", "SSE4", "NEON", "SCALAR".
[[nodiscard]] const char* batch_instruction_set() noexcept;

}  // namespace clearance
