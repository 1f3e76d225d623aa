// Compiled once per vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/penetration/facet_scan.cpp"
#include "core/numerics/simd_targets.hpp"
// This include must come first.
#include <hwy/highway.h>

#include "core/penetration/facet_scan.hpp"

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

// `row`: of facets, `end` of them are to be judged. Labels are 0, 1, ... Returns the least depth.
double deepest_of_all(const double* row, std::size_t stride, std::size_t end, const double* points,
                      std::size_t count, double* depths, double* whose) {
  const Tag tag;
  auto least = hn::Set(tag, kInfinity);
  for (std::size_t i = 0; i < end; i += hn::Lanes(tag)) {
    const Facets facets(row + i, stride);
    auto depth = facets.over(points), who = hn::Zero(tag);
    for (std::size_t k = 1; k < count; ++k) {
      const auto here = facets.over(points + 3 * k);
      const auto deeper = hn::Gt(here, depth);
      depth = hn::IfThenElse(deeper, here, depth);
      who = hn::IfThenElse(deeper, hn::Set(tag, static_cast<double>(k)), who);
    }
    hn::StoreU(depth, tag, depths + i);
    hn::StoreU(who, tag, whose + i);
    if (HWY_UNLIKELY(i + hn::Lanes(tag) > end)) {
      depth = hn::IfThenElse(hn::FirstN(tag, end - i), depth, least);
    }
    least = hn::Min(least, depth);
  }
  return hn::GetLane(hn::MinOfLanes(tag, least));
}

// Sets one bit for each point that is as deep as `enough`.
void mark_deep(const double* row, std::size_t end, const double* points, std::size_t count,
               double enough, std::uint64_t* marks) {
  const Tag tag;
  const hn::RebindToUnsigned<Tag> bits;
  for (std::size_t i = 0; i < end; i += hn::Lanes(tag)) {
    const Facets facets(row + i, end);
    auto mark = hn::Zero(bits);
    for (std::size_t k = 0; k < count; ++k) {
      const auto deep = hn::Ge(facets.over(points + 3 * k), hn::Set(tag, enough));
      const auto bit = hn::Set(bits, std::uint64_t{1} << k);
      mark = hn::Or(mark, hn::And(hn::BitCast(bits, hn::VecFromMask(tag, deep)), bit));
    }
    hn::StoreU(mark, bits, marks + i);
  }
}

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
#include <algorithm>

namespace clearance {

HWY_EXPORT(deepest_of_all);
HWY_EXPORT(mark_deep);

// A larger body's facets a part at a time, each over the one before.
void DeepestVertices::find_deepest() noexcept {
  const std::size_t facets = body_.facets.size();
  for (std::size_t first = 0; first < facets; first += kMostScanned) {
    const std::size_t end = std::min(kMostScanned, facets - first);
    const double least = HWY_DYNAMIC_DISPATCH(deepest_of_all)(body_.planes.data() + first, facets,
                                                              end, points_[0].data(), count_,
                                                              depths_.data(), whose_.data());
    if (!(least < least_)) continue;
    least_ = least;
    where_least_ = static_cast<std::int32_t>(
        first + static_cast<std::size_t>(std::find(depths_.begin(), depths_.begin() + end, least) -
                                         depths_.begin()));
  }
}

std::span<const std::int32_t> DeepestVertices::mark(double enough, std::size_t main) noexcept {
  const std::size_t facets = body_.facets.size();
  HWY_DYNAMIC_DISPATCH(mark_deep)
  (body_.planes.data(), facets, points_[0].data(), count_, enough, marks_.data());
  main_ = std::uint64_t{1} << main;
  std::size_t size = 0;
  for (std::size_t i = 0; i < facets; ++i) {
    list_[size] = static_cast<std::int32_t>(i);
    size += (marks_[i] & main_) == 0;
  }
  return {list_.data(), size};
}

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
