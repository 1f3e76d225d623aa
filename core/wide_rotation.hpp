// The rotation from B's frame to A's in twice the precision of a double: for the few queries that
// hang on where a direction of one body points as seen from the other to the last digit.
#pragma once

#include <array>

#include "core/pose.hpp"
#include "core/simplex.hpp"

namespace clearance {

struct WideRotation {
  std::array<WideVec, 3> rows;
  double error = 0.0;  // in the 2-norm
  // The axis that the exact rotation turns about, if it is one of x, y, z (0, 1, 2); what lies
  // along it stays, to the bit, and what stands across it stays across. -1: none, or not known.
  int axis = -1;

  [[nodiscard]] bool exact() const noexcept { return error == 0.0; }
  [[nodiscard]] WideRotation transposed() const noexcept {
    WideRotation out = *this;
    out.rows = {{{rows[0].x, rows[1].x, rows[2].x},
                 {rows[0].y, rows[1].y, rows[2].y},
                 {rows[0].z, rows[1].z, rows[2].z}}};
    return out;
  }
  [[nodiscard]] WideVec operator*(const WideVec& v) const noexcept {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
  }
};

// The pose's own rotation, where that is exact or nothing better is known.
[[nodiscard]] WideRotation wide_rotation(const RelativePose& a_from_b) noexcept;

}  // namespace clearance
