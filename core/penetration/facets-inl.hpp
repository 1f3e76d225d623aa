// A vector register of facets, and the depth of a point below them. Compiled once per vector width.
#if defined(CLEARANCE_CORE_FACETS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_FACETS
#undef CLEARANCE_CORE_FACETS
#else
#define CLEARANCE_CORE_FACETS
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, 4>;
using Numbers = hn::Vec<Tag>;

// A vector of facets n.x <= d, of a row of `stride`.
struct Facets {
  Numbers x, y, z, offset;
  HWY_INLINE Facets(const double* row, std::size_t stride)
      : x(hn::LoadU(Tag(), row)),
        y(hn::LoadU(Tag(), row + stride)),
        z(hn::LoadU(Tag(), row + 2 * stride)),
        offset(hn::LoadU(Tag(), row + 3 * stride)) {}

  // The depth of a point below the facets: d - n.x.
  [[nodiscard]] HWY_INLINE Numbers over(const double* point) const {
    const auto number = [&](int k) HWY_ATTR { return hn::Set(Tag(), point[k]); };
    const auto along =
        hn::Add(hn::Add(hn::Mul(x, number(0)), hn::Mul(y, number(1))), hn::Mul(z, number(2)));
    return hn::Sub(offset, along);
  }
};

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
