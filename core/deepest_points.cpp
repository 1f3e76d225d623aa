// Compiled once a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/deepest_points.cpp"
#include "core/vector_widths.hpp"
// That comes first.
#include <hwy/highway.h>

#include "core/deepest_points.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// `planes`: a row of `count` facets. Returns the least depth.
double deepen(const double* planes, std::size_t count, const double* point, double which,
              double* depths, double* whose) {
  const hn::CappedTag<double, 4> tag;
  const auto x = hn::Set(tag, point[0]), y = hn::Set(tag, point[1]), z = hn::Set(tag, point[2]);
  const auto self = hn::Set(tag, which);
  auto least = hn::Set(tag, kInfinity);
  for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
    const auto number = [&](std::size_t k)
                            HWY_ATTR { return hn::LoadU(tag, planes + k * count + i); };
    const auto along =
        hn::Add(hn::Add(hn::Mul(number(0), x), hn::Mul(number(1), y)), hn::Mul(number(2), z));
    const auto below = hn::Sub(number(3), along), before = hn::LoadU(tag, depths + i);
    const auto deeper = hn::Gt(below, before);
    const auto depth = hn::IfThenElse(deeper, below, before);
    hn::StoreU(depth, tag, depths + i);
    hn::StoreU(hn::IfThenElse(deeper, self, hn::LoadU(tag, whose + i)), tag, whose + i);
    least = hn::Min(least, depth);
  }
  return hn::GetLane(hn::MinOfLanes(tag, least));
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>

namespace clearance {

HWY_EXPORT(deepen);

void DeepestPoints::add(const Vec3& point) noexcept {
  const std::size_t facets = body_.facets.size();
  if (count_ == 0) {
    std::fill_n(depths_.begin(), facets, -kInfinity);
    std::fill_n(depths_.begin() + static_cast<std::ptrdiff_t>(facets), 4, kInfinity);
  }
  points_[count_] = point;
  least_ = HWY_DYNAMIC_DISPATCH(deepen)(body_.planes.row(0), facets, point.data(),
                                        static_cast<double>(count_), depths_.data(), which_.data());
  ++count_;
}

std::int32_t DeepestPoints::where_least() const noexcept {
  const auto end = depths_.begin() + static_cast<std::ptrdiff_t>(body_.facets.size());
  return static_cast<std::int32_t>(std::find(depths_.begin(), end, least_) - depths_.begin());
}

}  // namespace clearance
#endif
