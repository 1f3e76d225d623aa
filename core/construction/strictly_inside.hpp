// An interior point of an intersection of half-spaces, or a proof that there is none. The decision
// is exact.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "core/construction/integer_vector.hpp"
#include "core/shapes.hpp"

namespace clearance::exact {

// Rows with a positive combination whose normal is zero and whose offset is zero (`flat`) or less.
// By Farkas' lemma nothing lies strictly inside all of them.
struct NoInterior {
  std::vector<int> rows;  // indices, ascending, at most four
  bool flat;              // the rows still share points, in a common plane
};

// The space that the normals span.
struct NormalSpan {
  int rank;  // 1 to 3
  // Rank 1: the normals' own; rank 2: the one perpendicular to all; rank 3: none.
  Integer3 direction;
};
[[nodiscard]] NormalSpan normal_span(std::span<const HalfSpace> rows);

// A homogeneous point strictly inside every row; or the proof that there is none. Rows: finite, no
// zero normal. It lies about as deep inside as any point, but no deeper than the offsets are large.
[[nodiscard]] std::variant<Integer4, NoInterior> interior_point(std::span<const HalfSpace> rows);

}  // namespace clearance::exact
