// The neighbours of the features of as many pairs as a vector has lanes. Finds their least or
// greatest directional derivative, and the number (NextFeature) of the neighbour that takes over.
// Compiled once an instruction set.
#if defined(CLEARANCE_BATCH_NEIGHBOURS_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_BATCH_NEIGHBOURS_INL_HPP_
#undef CLEARANCE_BATCH_NEIGHBOURS_INL_HPP_
#else
#define CLEARANCE_BATCH_NEIGHBOURS_INL_HPP_
#endif

#include "core/batch/lanes-inl.hpp"
#include "core/vec.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance {
namespace HWY_NAMESPACE {

// The rows of the features of some lanes.
struct FeatureRows {
  const double* rows;  // of the first lane, at kFeatureRows
  const BatchBlock& block;

  [[nodiscard]] HWY_INLINE Points points(std::size_t row) const {
    return load_points(rows + row * kBlockLanes);
  }
  [[nodiscard]] HWY_INLINE Lanes lanes(std::size_t row) const {
    return load(rows + row * kBlockLanes);
  }
  [[nodiscard]] HWY_INLINE Lanes shared(SharedRow row) const {
    return load(rows - (kFeatureRows - row) * kBlockLanes);
  }
  [[nodiscard]] HWY_INLINE Points shared_points(SharedRow row) const {
    return load_points(rows - (kFeatureRows - row) * kBlockLanes);
  }
  // A directional derivative of a neighbour; `of_nothing` if the feature has no neighbours.
  [[nodiscard]] HWY_INLINE Lanes unless_isolated(SharedRow row, Lanes derivative,
                                                 double of_nothing) const {
    if (HWY_LIKELY(block.plain)) return derivative;
    return hn::IfThenElse(hn::Eq(shared(row), all(0.0)), derivative, all(of_nothing));
  }
};

// The least or greatest of some numbers, and the first that is.
struct Extreme {
  Lanes derivative, which;

  HWY_INLINE void lower(Lanes number, Lanes i) { take(hn::Lt(number, derivative), number, i); }
  HWY_INLINE void raise(Lanes number, Lanes i) { take(hn::Gt(number, derivative), number, i); }

 private:
  HWY_INLINE void take(LaneMask where, Lanes number, Lanes i) {
    derivative = hn::IfThenElse(where, number, derivative);
    which = hn::IfThenElse(where, i, which);
  }
};

HWY_INLINE Lanes after(Lanes number) { return hn::Add(number, all(1.0)); }

// Neighbours by their numbers, NextFeature.
HWY_INLINE Lanes named(Lanes which, NextFeature from) { return hn::Add(which, all(from)); }
HWY_INLINE Lanes next_if(LaneMask beyond_rounding, Lanes next) {
  return hn::IfThenElse(beyond_rounding, next, all(kNextUnknown));
}
// If s is past an end of the edge, the vertex there comes first: `at_begin` or the next number.
HWY_INLINE Lanes unless_past_end(Lanes begin, Lanes end, Lanes s, NextFeature at_begin,
                                 Lanes next) {
  next = hn::IfThenElse(hn::Ge(s, end), all(at_begin + 1), next);
  return hn::IfThenElse(hn::Le(s, begin), all(at_begin), next);
}

// The edges of a vertex, A's or B's, or the facets of an edge.
template <bool kOfB>
struct Beside {
  const FeatureRows& at;
  std::size_t row;
  static constexpr SharedRow kBare = kOfB ? kIsolatedB : kIsolatedA;

  [[nodiscard]] HWY_INLINE Extreme least(const Points& g) const {
    return least_of(kOfB ? at.block.most_b : at.block.most_a, g);
  }
  [[nodiscard]] HWY_INLINE Extreme greatest(const Points& g) const {
    return greatest_of(kOfB ? at.block.most_b : at.block.most_a, g);
  }
  [[nodiscard]] HWY_INLINE Extreme least_of_two(const Points& g) const { return least_of(2, g); }
  [[nodiscard]] HWY_INLINE Extreme greatest_of_two(const Points& g) const {
    return greatest_of(2, g);
  }

 private:
  [[nodiscard]] HWY_INLINE Extreme least_of(std::size_t count, const Points& g) const {
    Extreme lowest{all(kInfinity), all(0.0)};
    Lanes number = all(0.0);
    for (std::size_t i = 0; i < count; ++i, number = after(number))
      lowest.lower(along(i, g), number);
    lowest.derivative = at.unless_isolated(kBare, lowest.derivative, kInfinity);
    return lowest;
  }
  [[nodiscard]] HWY_INLINE Extreme greatest_of(std::size_t count, const Points& g) const {
    Extreme highest{all(-kInfinity), all(0.0)};
    Lanes number = all(0.0);
    for (std::size_t i = 0; i < count; ++i, number = after(number))
      highest.raise(along(i, g), number);
    highest.derivative = at.unless_isolated(kBare, highest.derivative, -kInfinity);
    return highest;
  }
  [[nodiscard]] HWY_INLINE Lanes along(std::size_t i, const Points& g) const {
    return dot(at.points(row + kDirectionRows * i), g);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace clearance
HWY_AFTER_NAMESPACE();

#endif
