// Points and directions of as many pairs as a vector has lanes. Compiled once an instruction set.
//
// Only single roundings in the order of the scalar code: no fused multiply-add, no approximate
// quotient. That is what makes the results independent of the vectors' width.
#if defined(CLEARANCE_BATCH_VECTORS_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_BATCH_VECTORS_INL_HPP_
#undef CLEARANCE_BATCH_VECTORS_INL_HPP_
#else
#define CLEARANCE_BATCH_VECTORS_INL_HPP_
#endif

#include <hwy/highway.h>

#include "core/batch_block.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, kBlockLanes>;
using Lanes = hn::Vec<Tag>;
using LaneMask = hn::Mask<Tag>;

inline constexpr std::size_t kWidth = hn::MaxLanes(Tag());

HWY_INLINE Lanes all(double value) { return hn::Set(Tag(), value); }

struct Points {
  Lanes x, y, z;
};

HWY_INLINE Points operator+(const Points& a, const Points& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Points operator-(const Points& a, const Points& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Points operator-(const Points& a) { return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)}; }
HWY_INLINE Points times(Lanes s, const Points& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
HWY_INLINE Points over(const Points& a, Lanes s) {
  return {hn::Div(a.x, s), hn::Div(a.y, s), hn::Div(a.z, s)};
}
HWY_INLINE Lanes dot(const Points& a, const Points& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Lanes norm(const Points& a) { return hn::Sqrt(dot(a, a)); }
HWY_INLINE Points cross(const Points& a, const Points& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

HWY_INLINE Lanes load(const double* row) { return hn::Load(Tag(), row); }
HWY_INLINE Points load_points(const double* rows) {
  return {load(rows), load(rows + kBlockLanes), load(rows + 2 * kBlockLanes)};
}
HWY_INLINE void store_points(const Points& p, LaneMask where, double* rows) {
  hn::BlendedStore(p.x, where, Tag(), rows);
  hn::BlendedStore(p.y, where, Tag(), rows + kBlockLanes);
  hn::BlendedStore(p.z, where, Tag(), rows + 2 * kBlockLanes);
}

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE void load_columns(const double* const* rows, std::size_t column, Lanes& first,
                             Lanes& second) {
  first = load(rows[0] + column);
  second = load(rows[0] + column + 1);
}
HWY_INLINE void store_columns(Lanes first, Lanes second, double* const* rows, std::size_t column) {
  hn::Store(first, Tag(), rows[0] + column);
  hn::Store(second, Tag(), rows[0] + column + 1);
}

#else

// Two neighbouring numbers from each of rows[0], rows[2], ... side by side.
template <class D>
HWY_INLINE hn::Vec<D> pairs_of_every_other(D d, const double* const* rows, std::size_t column) {
  if constexpr (hn::MaxLanes(D()) == 2) {
    return hn::Load(d, rows[0] + column);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, pairs_of_every_other(half, rows + hn::MaxLanes(half), column),
                       pairs_of_every_other(half, rows, column));
  }
}

// Columns `column` and the next of kWidth rows, which are 16-byte aligned.
HWY_INLINE void load_columns(const double* const* rows, std::size_t column, Lanes& first,
                             Lanes& second) {
  const Tag d;
  const Lanes even = pairs_of_every_other(d, rows, column);
  const Lanes odd = pairs_of_every_other(d, rows + 1, column);
  first = hn::InterleaveLower(d, even, odd);
  second = hn::InterleaveUpper(d, even, odd);
}

template <class D>
HWY_INLINE void store_pairs_to_every_other(D d, hn::Vec<D> v, double* const* rows,
                                           std::size_t column) {
  if constexpr (hn::MaxLanes(D()) == 2) {
    hn::StoreU(v, d, rows[0] + column);
  } else {
    const hn::Half<D> half;
    store_pairs_to_every_other(half, hn::LowerHalf(half, v), rows, column);
    store_pairs_to_every_other(half, hn::UpperHalf(half, v), rows + hn::MaxLanes(half), column);
  }
}

// The reverse of load_columns; rows of any alignment.
HWY_INLINE void store_columns(Lanes first, Lanes second, double* const* rows, std::size_t column) {
  const Tag d;
  store_pairs_to_every_other(d, hn::InterleaveLower(d, first, second), rows, column);
  store_pairs_to_every_other(d, hn::InterleaveUpper(d, first, second), rows + 1, column);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace clearance
HWY_AFTER_NAMESPACE();

#endif
