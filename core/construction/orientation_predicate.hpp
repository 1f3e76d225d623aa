// The side of a plane through three points on which a fourth point lies. The answer is always
// exact, and mostly computed in doubles.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/construction/integer_vector.hpp"

namespace clearance::exact {

// Homogeneous points with a rounded copy of each. A component of the copy is off by at most 2^-52,
// up to a power of two of the whole point, which changes no sign.
class PointSet {
 public:
  explicit PointSet(std::span<const Integer4> points);

  [[nodiscard]] int size() const { return static_cast<int>(exact_.size()); }
  [[nodiscard]] const Integer4& exact(int point) const { return exact_[index(point)]; }
  [[nodiscard]] const std::array<double, 4>& rounded(int point) const {
    return rounded_[index(point)];
  }

 private:
  static std::size_t index(int point) { return static_cast<std::size_t>(point); }

  std::span<const Integer4> exact_;
  std::vector<std::array<double, 4>>
      rounded_;  // NaN where doubles cannot tell (more than 200 binary
                 // orders between two components): no filter passes a NaN
};

// The oriented plane through three points of a set.
class FilteredPlane {
 public:
  FilteredPlane(const PointSet& points, const std::array<int, 3>& vertices);

  // 1 on the side from which the vertices are seen counter-clockwise, 0 on the plane, -1 below.
  [[nodiscard]] int side(const PointSet& points, int point);

 private:
  std::array<int, 3> vertices_;
  std::array<double, 4> plane_;  // plane_through() in doubles
  std::array<double, 4>
      spread_;  // the same sums with every term's absolute value, times the unit of error
  std::unique_ptr<Integer4> exact_;  // made when first needed
};

}  // namespace clearance::exact
