// Points and directions of as many pairs as a vector has lanes. Compiled once an instruction set.
//
// Only single roundings in the order of the scalar code: no fused multiply-add, no approximate
// quotient. So the results do not depend on the vectors' width.
#if defined(CLEARANCE_BATCH_VECTORS_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_BATCH_VECTORS_INL_HPP_
#undef CLEARANCE_BATCH_VECTORS_INL_HPP_
#else
#define CLEARANCE_BATCH_VECTORS_INL_HPP_
#endif

#include <hwy/highway.h>

#include "core/batch/block.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A vector of this instruction set, of at most the eight doubles of a block's row.
using Tag = hn::CappedTag<double, kBlockLanes>;
using Lanes = hn::Vec<Tag>;
using LaneMask = hn::Mask<Tag>;

inline constexpr std::size_t kWidth = hn::MaxLanes(Tag());

HWY_INLINE Lanes all(double value) { return hn::Set(Tag(), value); }

// A point, or a direction, of each lane.
struct Points {
  HWY_INLINE Points() {}  // compiled for this instruction set, as a default would not be
  HWY_INLINE Points(Lanes at_x, Lanes at_y, Lanes at_z) : x(at_x), y(at_y), z(at_z) {}
  // One by one: as a whole the compiler copies them in memory.
  HWY_INLINE Points(const Points& p) : x(p.x), y(p.y), z(p.z) {}
  HWY_INLINE Points& operator=(const Points& p) {
    x = p.x;
    y = p.y;
    z = p.z;
    return *this;
  }

  Lanes x, y, z;
};

HWY_INLINE Points operator+(const Points& a, const Points& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Points operator-(const Points& a, const Points& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Points operator-(const Points& a) { return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)}; }
HWY_INLINE Points operator*(Lanes s, const Points& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
HWY_INLINE Points over(const Points& a, Lanes s) {
  return {hn::Div(a.x, s), hn::Div(a.y, s), hn::Div(a.z, s)};
}
// Sums from x to z, like sum3() of core/numerics/vec4-inl.hpp: the order of sums is part of the
// result.
HWY_INLINE Lanes dot(const Points& a, const Points& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Lanes norm(const Points& a) { return hn::Sqrt(dot(a, a)); }
HWY_INLINE Points cross(const Points& a, const Points& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
// Like those for Vec4.
HWY_INLINE Lanes triple(const Points& v, const Points& e, const Points& n) {
  return dot(cross(v, e), n);
}
HWY_INLINE void double_cross(const Points& v, const Points& e, Points& product, Lanes& length) {
  const Points c = cross(v, e);
  product = cross(e, c);
  length = norm(c);
}

HWY_INLINE Lanes load(const double* row) { return hn::Load(Tag(), row); }
// Three rows of a block, from the first lane's number in the first of them.
HWY_INLINE Points load_points(const double* rows) {
  return {load(rows), load(rows + kBlockLanes), load(rows + 2 * kBlockLanes)};
}
// Lanes outside `where` keep their numbers. Masked stores are not used: those of AVX2 are so slow
// on a Zen 4 that batches take 6 to 8 % longer.
HWY_INLINE void store_points(const Points& p, LaneMask where, double* rows) {
  const auto store = [&](Lanes v, double* row)
                         HWY_ATTR { hn::Store(hn::IfThenElse(where, v, load(row)), Tag(), row); };
  store(p.x, rows);
  store(p.y, rows + kBlockLanes);
  store(p.z, rows + 2 * kBlockLanes);
}

// Four columns of as many rows as there are lanes, and back: rows[i][column + k] is lane i of
// column[k]. Rows are 16-byte aligned for loading, anywhere for storing.
struct Columns {
  Lanes column[4];
};

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE Columns load_columns(const double* const* rows, std::size_t column) {
  const double* row = rows[0] + column;
  return {{load(row), load(row + 1), load(row + 2), load(row + 3)}};
}
HWY_INLINE void store_columns(const Columns& c, double* const* rows, std::size_t column) {
  for (std::size_t k = 0; k < 4; ++k) hn::Store(c.column[k], Tag(), rows[0] + column + k);
}

#else

// The 2 x 2 matrices in the 16-byte blocks of two vectors, transposed.
HWY_INLINE Lanes firsts(Lanes a, Lanes b) { return hn::InterleaveLower(Tag(), a, b); }
HWY_INLINE Lanes seconds(Lanes a, Lanes b) { return hn::InterleaveUpper(Tag(), a, b); }

#if HWY_TARGET == HWY_AVX3

// The same with the blocks of two vectors for elements.
HWY_INLINE Lanes first_blocks(Lanes a, Lanes b) {
  return hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a);
}
HWY_INLINE Lanes second_blocks(Lanes a, Lanes b) {
  return hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a));
}

// Four numbers each of rows[0] and rows[4].
HWY_INLINE Lanes load_fours(const double* const* rows, std::size_t column) {
  const hn::Half<Tag> half;
  return hn::Combine(Tag(), hn::LoadU(half, rows[4] + column), hn::LoadU(half, rows[0] + column));
}
HWY_INLINE void store_fours(Lanes v, double* const* rows, std::size_t column) {
  const hn::Half<Tag> half;
  hn::StoreU(hn::LowerHalf(half, v), half, rows[0] + column);
  hn::StoreU(hn::UpperHalf(half, v), half, rows[4] + column);
}

HWY_INLINE Columns load_columns(const double* const* rows, std::size_t column) {
  const Lanes row0 = load_fours(rows, column), row1 = load_fours(rows + 1, column);
  const Lanes row2 = load_fours(rows + 2, column), row3 = load_fours(rows + 3, column);
  const Lanes low02 = firsts(row0, row1), low13 = seconds(row0, row1);
  const Lanes high02 = firsts(row2, row3), high13 = seconds(row2, row3);
  return {{first_blocks(low02, high02), first_blocks(low13, high13), second_blocks(low02, high02),
           second_blocks(low13, high13)}};
}
// The same exchanges, as a transposition is its own inverse.
HWY_INLINE void store_columns(const Columns& c, double* const* rows, std::size_t column) {
  const Lanes low02 = firsts(c.column[0], c.column[1]), low13 = seconds(c.column[0], c.column[1]);
  const Lanes high02 = firsts(c.column[2], c.column[3]);
  const Lanes high13 = seconds(c.column[2], c.column[3]);
  store_fours(first_blocks(low02, high02), rows, column);
  store_fours(first_blocks(low13, high13), rows + 1, column);
  store_fours(second_blocks(low02, high02), rows + 2, column);
  store_fours(second_blocks(low13, high13), rows + 3, column);
}

#else  // two lanes or four

// Two numbers of rows[0], and of rows[2] where there are four lanes.
template <class D>
HWY_INLINE hn::Vec<D> load_twos(D d, const double* const* rows, std::size_t column) {
  if constexpr (hn::MaxLanes(D()) == 2) {
    return hn::Load(d, rows[0] + column);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, load_twos(half, rows + 2, column), load_twos(half, rows, column));
  }
}
template <class D>
HWY_INLINE void store_twos(D d, hn::Vec<D> v, double* const* rows, std::size_t column) {
  if constexpr (hn::MaxLanes(D()) == 2) {
    hn::StoreU(v, d, rows[0] + column);
  } else {
    const hn::Half<D> half;
    store_twos(half, hn::LowerHalf(half, v), rows, column);
    store_twos(half, hn::UpperHalf(half, v), rows + 2, column);
  }
}

HWY_INLINE Columns load_columns(const double* const* rows, std::size_t column) {
  const Lanes even01 = load_twos(Tag(), rows, column);
  const Lanes odd01 = load_twos(Tag(), rows + 1, column);
  const Lanes even23 = load_twos(Tag(), rows, column + 2);
  const Lanes odd23 = load_twos(Tag(), rows + 1, column + 2);
  return {{firsts(even01, odd01), seconds(even01, odd01), firsts(even23, odd23),
           seconds(even23, odd23)}};
}
HWY_INLINE void store_columns(const Columns& c, double* const* rows, std::size_t column) {
  for (std::size_t k = 0; k < 4; k += 2) {
    store_twos(Tag(), firsts(c.column[k], c.column[k + 1]), rows, column + k);
    store_twos(Tag(), seconds(c.column[k], c.column[k + 1]), rows + 1, column + k);
  }
}

#endif
#endif

}  // namespace HWY_NAMESPACE
}  // namespace clearance
HWY_AFTER_NAMESPACE();

#endif
