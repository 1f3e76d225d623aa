// Tables that a ConvexBody keeps beside its features, in the order in which queries read them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/vec.hpp"

namespace clearance {

struct ConvexBody;

// Rows of vectors, one row a feature, as vector registers read them: four vectors at a time, their
// x, then their y, their z, and for facets their offsets. Each row begins with a new four. The last
// vector of a row is repeated up to a multiple of four.
template <int kNumbers>
class VectorRows {
 public:
  // The length of a row of n vectors.
  [[nodiscard]] static constexpr std::int32_t length(std::int32_t n) noexcept {
    return (n + 3) / 4 * 4;
  }
  // Before the first vector of a row, the rows before it have a length of `first`.
  [[nodiscard]] const double* row(std::int32_t first) const noexcept {
    return values_.data() + static_cast<std::ptrdiff_t>(first) * kNumbers;
  }
  // Number k of vector i of a row.
  [[nodiscard]] double number(std::int32_t first, std::int32_t i, std::int32_t k) const noexcept {
    return values_[index(first, i, k)];
  }
  // For a row of n.
  void set(std::int32_t first, std::int32_t n, std::int32_t i, std::int32_t k, double to) noexcept {
    values_[index(first, i, k)] = to;
    if (i != n - 1) return;
    for (std::int32_t pad = n; pad < length(n); ++pad) values_[index(first, pad, k)] = to;
  }
  [[nodiscard]] std::size_t bytes() const noexcept { return values_.size() * sizeof(double); }
  // Sets all numbers to NaN. The row of a feature without neighbours keeps them.
  void resize(std::size_t length) {
    values_.assign(std::max(length, std::size_t{4}) * kNumbers,
                   std::numeric_limits<double>::quiet_NaN());
  }

 private:
  [[nodiscard]] static std::size_t index(std::int32_t first, std::int32_t i,
                                         std::int32_t k) noexcept {
    return static_cast<std::size_t>(first + i / 4 * 4) * kNumbers +
           static_cast<std::size_t>(4 * k + i % 4);
  }
  std::vector<double> values_;
};

// The normals and offsets of all facets: n x, then n y, n z and n offsets.
class PlaneTable {
 public:
  [[nodiscard]] const double* data() const noexcept { return values_.data(); }
  // Number k of facet i of n.
  void set(std::int32_t n, std::int32_t i, std::int32_t k, double to) noexcept {
    values_[static_cast<std::size_t>(k * n + i)] = to;
  }
  [[nodiscard]] std::size_t bytes() const noexcept { return values_.size() * sizeof(double); }
  // Reads of four may run over the end.
  void resize(std::size_t n) { values_.assign(4 * n + 4, 0.0); }

 private:
  std::vector<double> values_;
};

// A limit of a facet's polygon in its plane: inward.x >= offset. An edge gives one limit, its inner
// side. An edge that ends at a sharp vertex gives a second one, the part before its end. Without
// it, a point that rounding puts off both edges may be past the vertex by that rounding over the
// sine of half the angle.
struct FacetLimit {
  Vec3 inward;
  double offset;
};

// A facet's vertex is sharp if the cosine of its angle exceeds this. The sine of half the angle is
// then 1/3 or less.
inline constexpr double kSharpCorner = 7.0 / 9.0;

// The directions in which a body is unbounded. They are sums of multiples of its lines (the
// lineality space) and non-negative multiples of its other extreme rays.
struct RecessionCone {
  // Unit and orthogonal; two of them span a whole plane.
  std::array<Vec3, 2> lines{Vec3::Zero(), Vec3::Zero()};
  std::size_t line_count = 0;
  std::vector<Vec3> rays;  // unit
  // Some direction at right angles to the lines has at least this derivative along every ray,
  // rounding included. 0 or less: no such direction is known.
  double least = 0.0;
  // Unit: a direction of the cone that leads away from every facet; zero: there is none.
  Vec3 inwards = Vec3::Zero();

  // The part of v at right angles to the lines.
  [[nodiscard]] Vec3 across_lines(Vec3 v) const noexcept {
    for (std::size_t i = 0; i < line_count; ++i) v -= v.dot(lines[i]) * lines[i];
    return v;
  }
};

// A cube around the origin whose faces are grids. The cell of a direction names the support point
// along the middle of the cell. With 6 x 8 x 8 cells the climb on a facet-ball of 2,042 facets
// takes 3 edges on average. The table is no larger than the vertices of a body of 26 facets.
class StartTable {
 public:
  static constexpr int kGrid = 8;
  static constexpr int kCells = 6 * kGrid * kGrid;

  [[nodiscard]] std::int32_t at(const Vec3& direction) const noexcept {
    return cells_[static_cast<std::size_t>(cell(direction))];
  }
  void set(int cell, std::int32_t vertex) noexcept {
    cells_[static_cast<std::size_t>(cell)] = vertex;
  }

  // Any direction, zero and NaN included, has a cell.
  [[nodiscard]] static int cell(const Vec3& d) noexcept {
    const double x = std::abs(d.x()), y = std::abs(d.y()), z = std::abs(d.z());
    const int axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
    const double major = d[axis], u = d[(axis + 1) % 3], v = d[(axis + 2) % 3];
    const double scale = 0.5 * kGrid / std::abs(major);
    return ((axis * 2 + (major < 0.0)) * kGrid + step(u * scale)) * kGrid + step(v * scale);
  }
  [[nodiscard]] static Vec3 middle(int cell) noexcept {
    const auto coordinate = [](int step) { return (step + 0.5) * 2.0 / kGrid - 1.0; };
    const int face = cell / (kGrid * kGrid), axis = face / 2;
    Vec3 d;
    d[axis] = face % 2 == 0 ? 1.0 : -1.0;
    d[(axis + 1) % 3] = coordinate(cell / kGrid % kGrid);
    d[(axis + 2) % 3] = coordinate(cell % kGrid);
    return d;
  }

 private:
  static int step(double from_middle) noexcept {
    const double s = from_middle + 0.5 * kGrid;
    return s > 0.0 ? (s < kGrid ? static_cast<int>(s) : kGrid - 1) : 0;
  }
  std::array<std::int32_t, kCells> cells_{};
};

// The features of a box whose faces are across the axes of its frame. A cold query of two boxes
// with parallel axes begins at the features that face each other.
struct BoxFeatures {
  // The centre and half of the edge lengths, m; `half` is zero if the body is no such box. Reads of
  // four go on in the next member.
  Vec3 centre = Vec3::Zero();
  double unused = 0.0;
  Vec3 half = Vec3::Zero();
  double length = 0.0;  // of `half`, m
  // The feature that lies farthest in a direction: a facet for one axis, an edge for two, and a
  // vertex for three. Bit i of the index: the direction has a component along axis i; bit 3 + i: it
  // is negative. Without such a component, bit 3 + i does not matter.
  std::array<std::int8_t, 64> farthest{};

  [[nodiscard]] bool exist() const noexcept { return length > 0.0; }
};

// The last step of the factories: makes all members of ConvexBody that it documents as made here,
// and frees spare memory.
void add_query_tables(ConvexBody& body);

// Bytes that a body takes, all of its tables included, without the allocator's overhead.
[[nodiscard]] std::size_t footprint(const ConvexBody& body) noexcept;

}  // namespace clearance
