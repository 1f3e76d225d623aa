// Vectors of arbitrarily large integers: the doubles of a shape, exactly.
//
// A point is homogeneous: (x, y, z, w) with w > 0 stands for (x, y, z) / w. A plane n.x <= d is (n,
// d). A positive factor changes neither. So a power of two makes integers of doubles, and no
// fraction is ever needed. For load time only. Included by the factories' .cpp files, never by a
// public header.
#pragma once

#include <gmpxx.h>

#include <array>
#include <span>

namespace clearance::exact {

using Integer = mpz_class;
using Integer3 = std::array<Integer, 3>;
using Integer4 = std::array<Integer, 4>;

// Points, planes and what is made of them are numbered by int, containers by std::size_t.
[[nodiscard]] inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

// A positive power of two times `values`, which must be finite.
[[nodiscard]] Integer4 integer_multiple(const std::array<double, 4>& values);

// Divides by the greatest common divisor: the shortest integers of the same meaning.
void reduce(std::span<Integer> vector);

[[nodiscard]] Integer3 cross(const Integer3& a, const Integer3& b);
[[nodiscard]] Integer dot(const Integer3& a, const Integer3& b);
[[nodiscard]] Integer dot(const Integer4& a, const Integer4& b);
[[nodiscard]] bool is_zero(std::span<const Integer> vector);

// The first three of four: a plane's normal, a homogeneous point's direction from the origin.
[[nodiscard]] Integer3 head(const Integer4& vector);

// The plane h with h.a = h.b = h.c = 0. It has h.p > 0 for points p on the side from which a, b, c
// are seen counter-clockwise. Zero when the three points are in one line.
[[nodiscard]] Integer4 plane_through(const Integer4& a, const Integer4& b, const Integer4& c);

}  // namespace clearance::exact
