// By how little two rays of two bodies lean apart, and which way: for lines that are parallel but
// for what a quaternion's smallest components say, down to subnormals.
//
// Where a turn about the axes by 90, 120 or 180 degrees leads a ray f of B exactly along a ray e of
// A, what is left of the relative quaternion, (w, v), moves f by 2 (w g + v cross g) / |q|^2,
// g = v cross f: two vectors at right angles, so nothing cancels, and the way is as well known as
// g. That is a sum of products of doubles, and exact: with quaternions scaled up, as their products
// may be subnormal otherwise. In the same way, where a direction m of A would stand exactly across
// f after such a turn, it has the slope 2 (w m.(v cross f) + m.v v.f) / |q|^2 after all of it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/pose.hpp"
#include "core/simplex.hpp"

namespace clearance {

// A sum of doubles, none of it lost: parts that do not overlap, the largest last.
class ExactSum {
 public:
  void add(double x) noexcept;
  void add(const DoubleDouble& x) noexcept {
    add(x.low);
    add(x.high);
  }
  void add(const ExactSum& other, double sign) noexcept {
    for (const double part : other) add(sign * part);
  }
  [[nodiscard]] const double* begin() const noexcept { return parts_.data(); }
  [[nodiscard]] const double* end() const noexcept { return parts_.data() + size_; }
  [[nodiscard]] double rounded() const noexcept { return size_ == 0 ? 0.0 : parts_[size_ - 1]; }
  [[nodiscard]] int sign() const noexcept { return (rounded() > 0.0) - (rounded() < 0.0); }
  // Times 2^exponent, to 2^-104.
  [[nodiscard]] DoubleDouble scaled(int exponent) const noexcept;

 private:
  // Sums that cancel leave parts of few bits, and there may be any number of these; so that the
  // same sum has parts of 53 bits each.
  void spread() noexcept;

  std::array<double, 48> parts_;  // once spread, the doubles' range has room for 40
  std::size_t size_ = 0;
};

class Lean {
 public:
  explicit Lean(const RelativePose& a_from_b) noexcept;

  // B's ray runs along `sign` times A's, plus a positive multiple of `way` (frame A, about unit
  // length, to 2^-96 of that), or exactly, where way is zero.
  struct Apart {
    bool known = false;
    double sign = 1.0;
    WideVec way;
  };
  // e of A and f of B: exact rays.
  [[nodiscard]] Apart apart(const Vec3& e, const Vec3& f) const noexcept;

  // The exact sign of m.Rf, m in frame A and f in frame B: 1, 0, -1; nothing: not known.
  [[nodiscard]] std::optional<int> sign(const Vec3& m, const Vec3& f) const noexcept;

 private:
  struct Turn;
  [[nodiscard]] std::optional<int> sign_of_rise(const Turn& turn, const Vec3& m,
                                                const Vec3& f) const noexcept;
  [[nodiscard]] WideVec moved(const Turn& turn, const Vec3& f, bool& known) const noexcept;

  std::array<ExactSum, 4> q_;  // x, y, z, w, all times one factor
  double lost_ = 0.0;          // what each of them may be off by
};

}  // namespace clearance
