// Compiled once per vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/penetration/deepest_points.cpp"
#include "core/numerics/simd_targets.hpp"
// This include must come first.
#include "core/penetration/deepest_points.hpp"
#include "core/penetration/facets-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// The lanes of a mask, as indices from `i` on.
HWY_INLINE std::size_t list_lanes(hn::Mask<Tag> which, std::size_t i, std::uint16_t* list,
                                  std::size_t size) {
  const Tag tag;
  if (HWY_LIKELY(hn::AllFalse(tag, which))) return size;
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(tag, which, bits);
  for (std::size_t k = 0; k < hn::Lanes(tag); ++k) {
    list[size] = static_cast<std::uint16_t>(i + k);
    size += bits[0] >> k & 1;
  }
  return size;
}

HWY_INLINE Numbers below(const Facets& facets, const DeepestPoints::Point& point) {
  return hn::Add(facets.over(point.at.data()), hn::Set(Tag(), point.radius));
}

// `row`: of `count` facets. Lists the facets below which no point is as deep as `enough`. rest: the
// least depth of the deepest point below the other facets.
std::size_t list_shallow(const double* row, std::size_t count, const DeepestPoints::Point* points,
                         std::size_t end, double enough, std::uint16_t* list, double& rest_least,
                         std::int32_t& where_least) {
  const Tag tag;
  const auto lanes = static_cast<double>(hn::Lanes(tag));
  auto rest = hn::Set(tag, kInfinity), least = rest, where = hn::Zero(tag);
  auto at = hn::Iota(tag, 0);
  std::size_t size = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
    const Facets facets(row + i, count);
    auto depth = below(facets, points[0]);
    for (std::size_t k = 1; k < end; ++k) depth = hn::Max(depth, below(facets, points[k]));
    if (HWY_UNLIKELY(i + hn::Lanes(tag) > count)) {
      depth = hn::IfThenElse(hn::FirstN(tag, count - i), depth, hn::Set(tag, kInfinity));
    }
    const auto shallow = hn::Lt(depth, hn::Set(tag, enough)), lower = hn::Lt(depth, least);
    rest = hn::Min(rest, hn::IfThenElse(shallow, rest, depth));
    least = hn::IfThenElse(lower, depth, least);
    where = hn::IfThenElse(lower, at, where);
    at = hn::Add(at, hn::Set(tag, lanes));
    size = list_lanes(shallow, i, list, size);
  }
  const auto equal = hn::Eq(least, hn::MinOfLanes(tag, least));
  const auto first = hn::MinOfLanes(tag, hn::IfThenElse(equal, where, hn::Set(tag, kInfinity)));
  rest_least = hn::GetLane(hn::MinOfLanes(tag, rest));
  where_least = static_cast<std::int32_t>(hn::GetLane(first));
  return size;
}

// Lists the facets below which one point is not as deep as `enough`; lanes past the row's end may
// be among them.
std::size_t list_not_below(const double* row, std::size_t count, const DeepestPoints::Point* point,
                           double enough, std::uint16_t* list) {
  const Tag tag;
  std::size_t size = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
    const auto depth = below(Facets(row + i, count), *point);
    size = list_lanes(hn::Lt(depth, hn::Set(tag, enough)), i, list, size);
  }
  return size;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(list_shallow);
HWY_EXPORT(list_not_below);

DeepestPoints::Shallow DeepestPoints::list_shallow(double enough) noexcept {
  Shallow out;
  const std::size_t size =
      HWY_DYNAMIC_DISPATCH(list_shallow)(body_.planes.data(), body_.facets.size(), points_.data(),
                                         count_, enough, list_.data(), out.rest, out.where_least);
  out.facets = {list_.data(), size};
  return out;
}

std::span<const std::uint16_t> DeepestPoints::list_not_below(const Point& point,
                                                             double enough) noexcept {
  const std::size_t facets = body_.facets.size();
  std::size_t size = HWY_DYNAMIC_DISPATCH(list_not_below)(body_.planes.data(), facets, &point,
                                                          point.for_arcs(enough), list_.data());
  while (size > 0 && list_[size - 1] >= facets) --size;
  std::fill_n(listed_.begin(), facets, false);
  for (std::size_t k = 0; k < size; ++k) listed_[list_[k]] = true;
  return {list_.data(), size};
}

}  // namespace clearance
#endif
