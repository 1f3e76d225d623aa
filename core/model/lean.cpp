#include "core/model/lean.hpp"

namespace clearance {
namespace {

LongSum<1> long_sum(double x) noexcept {
  LongSum<1> out;
  out.add(x);
  return out;
}

// conj(a) b: x, y, z, w.
std::array<LongSum<2>, 4> relative(const RelativePose::Orientation& a,
                                   const RelativePose::Orientation& b) noexcept {
  std::array<LongSum<2>, 4> out;
  const auto add = [&](std::size_t to, std::size_t i, std::size_t k, int sign) {
    out[to].add_product(long_sum(a.coeffs()[static_cast<Eigen::Index>(i)]),
                        long_sum(b.coeffs()[static_cast<Eigen::Index>(k)]), sign);
  };
  constexpr std::size_t w = 3;
  for (std::size_t x = 0; x < 3; ++x) {
    const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
    add(x, w, x, 1);
    add(x, x, w, -1);
    add(x, z, y, 1);
    add(x, y, z, -1);
    add(w, x, x, 1);
  }
  add(w, w, w, 1);
  return out;
}

}  // namespace

LongVec<3> long_vec(const ExactDirection& v) noexcept {
  LongVec<3> out;
  for (const ExactDirection::Part& part : v.parts) {
    for (std::size_t i = 0; i < 3; ++i) {
      out[i].add(part.digits[static_cast<Eigen::Index>(i)], part.exponent);
    }
  }
  return out;
}

LongVec<3> long_vec(const Vec3& v) noexcept {
  LongVec<3> out;
  for (std::size_t i = 0; i < 3; ++i) out[i].add(v[static_cast<Eigen::Index>(i)]);
  return out;
}

Lean::Lean(const RelativePose& a_from_b, bool of_quaternions) noexcept {
  if (!of_quaternions) {
    for (std::size_t i = 0; i < 9; ++i) {
      rows_[i / 3][i % 3].add(
          a_from_b.rotation(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)));
    }
    return;
  }
  const auto q = relative(a_from_b.world_from_a, a_from_b.world_from_b);
  constexpr std::size_t w = 3;
  const auto add_twice = [&](LongSum<4>& to, std::size_t i, std::size_t k, int sign) {
    to.add_product(q[i], q[k], sign);
    to.add_product(q[i], q[k], sign);
  };
  for (std::size_t x = 0; x < 3; ++x) {
    const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
    rows_[x][x].add_product(q[w], q[w]);
    rows_[x][x].add_product(q[x], q[x]);
    rows_[x][x].add_product(q[y], q[y], -1);
    rows_[x][x].add_product(q[z], q[z], -1);
    add_twice(rows_[x][y], x, y, 1);
    add_twice(rows_[x][y], w, z, -1);
    add_twice(rows_[x][z], x, z, 1);
    add_twice(rows_[x][z], w, y, 1);
  }
}

LongVec<7> Lean::turned(const LongVec<3>& f) const noexcept {
  return {dot(rows_[0], f), dot(rows_[1], f), dot(rows_[2], f)};
}

LongVec<7> Lean::kept(const LongVec<3>& e) noexcept {
  LongSum<4> one;
  one.add(1.0);
  LongVec<7> out;
  for (std::size_t i = 0; i < 3; ++i) out[i].add_product(one, e[i]);
  return out;
}

}  // namespace clearance
