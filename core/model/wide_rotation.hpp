// The rotation from B's frame to A's in twice the precision of a double: for the few queries that
// hang on where a direction of one body points as seen from the other to the last digit.
#pragma once

#include <array>
#include <optional>

#include "core/gjk/closest_on_simplex.hpp"
#include "core/pose.hpp"

namespace clearance {

struct WideRotation {
  std::array<WideVec, 3> rows;
  double error = 0.0;           // in the 2-norm
  bool of_quaternions = false;  // they say more of it than the pose's matrix
  // The axis of A (0, 1, 2) that B's x, y and z lie along for certain, either way: what lies along
  // such an axis is turned to the bit, and what stands across it stays across. -1: none.
  std::array<int, 3> lands_on{-1, -1, -1};
  [[nodiscard]] bool exact() const noexcept { return error == 0.0; }
  // Is the exact rotation known, be it by the quaternions?
  [[nodiscard]] bool says_all() const noexcept { return exact() || of_quaternions; }
  // Is v, of frame B, turned to the bit?
  [[nodiscard]] bool keeps_bits_of(const Vec3& v) const noexcept {
    const int along = axis_of(v);
    return exact() || (along >= 0 && lands_on[static_cast<std::size_t>(along)] >= 0);
  }
  [[nodiscard]] WideRotation transposed() const noexcept {
    WideRotation out;
    out.error = error;
    out.of_quaternions = of_quaternions;
    out.rows = {{{rows[0].x, rows[1].x, rows[2].x},
                 {rows[0].y, rows[1].y, rows[2].y},
                 {rows[0].z, rows[1].z, rows[2].z}}};
    return out;
  }
  [[nodiscard]] WideVec operator*(const WideVec& v) const noexcept {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
  }

 private:
  // The axis that v lies along, -1: none.
  static int axis_of(const Vec3& v) noexcept {
    for (int i = 0; i < 3; ++i) {
      if (v[i] != 0.0 && v[(i + 1) % 3] == 0.0 && v[(i + 2) % 3] == 0.0) return i;
    }
    return -1;
  }
};

// The pose's own rotation, where that is exact or nothing better is known.
[[nodiscard]] WideRotation wide_rotation(const RelativePose& a_from_b) noexcept;

// The same pose with its rotation rounded once, for a fifteenth of the error; nothing where its
// quaternions do not say more than the pose.
[[nodiscard]] std::optional<RelativePose> rounded_once(const RelativePose& a_from_b) noexcept;

}  // namespace clearance
