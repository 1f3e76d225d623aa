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

using Tag = hn::CappedTag<double, 4>;
using Numbers = hn::Vec<Tag>;

// How deep a point is below facets of a row of `count`, a few at a time.
struct Below {
  const double* row;
  std::size_t count;
  Numbers x, y, z;
  HWY_INLINE Below(const double* facets, std::size_t number, const double* point)
      : row(facets),
        count(number),
        x(hn::Set(Tag(), point[0])),
        y(hn::Set(Tag(), point[1])),
        z(hn::Set(Tag(), point[2])) {}
  [[nodiscard]] HWY_INLINE Numbers operator()(std::size_t i) const {
    const auto number = [&](std::size_t k)
                            HWY_ATTR { return hn::LoadU(Tag(), row + k * count + i); };
    const auto along =
        hn::Add(hn::Add(hn::Mul(number(0), x), hn::Mul(number(1), y)), hn::Mul(number(2), z));
    return hn::Sub(number(3), along);
  }
};

// `row`: of `count` facets. Returns the least depth.
double deepen(const double* row, std::size_t count, const double* point, double label,
              double* depths, double* whose) {
  const Tag tag;
  const Below below(row, count, point);
  const auto self = hn::Set(tag, label);
  auto least = hn::Set(tag, kInfinity);
  for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
    const auto here = below(i), before = hn::LoadU(tag, depths + i);
    const auto deeper = hn::Gt(here, before);
    const auto depth = hn::IfThenElse(deeper, here, before);
    hn::StoreU(depth, tag, depths + i);
    hn::StoreU(hn::IfThenElse(deeper, self, hn::LoadU(tag, whose + i)), tag, whose + i);
    least = hn::Min(least, depth);
  }
  return hn::GetLane(hn::MinOfLanes(tag, least));
}

// The same for the first points, many of them and few facets. Their labels are 0, 1, ...
double deepen_by_all(const double* row, std::size_t count, const double* points, std::size_t end,
                     double* depths, double* whose) {
  const Tag tag;
  auto least = hn::Set(tag, kInfinity);
  for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
    auto depth = hn::LoadU(tag, depths + i), who = hn::Zero(tag);
    for (std::size_t k = 0; k < end; ++k) {
      const auto here = Below(row, count, points + 3 * k)(i);
      const auto deeper = hn::Gt(here, depth);
      depth = hn::IfThenElse(deeper, here, depth);
      who = hn::IfThenElse(deeper, hn::Set(tag, static_cast<double>(k)), who);
    }
    hn::StoreU(depth, tag, depths + i);
    hn::StoreU(who, tag, whose + i);
    least = hn::Min(least, depth);
  }
  return hn::GetLane(hn::MinOfLanes(tag, least));
}

// The lanes of a mask, as indices from `i` on.
HWY_INLINE std::size_t list_lanes(hn::Mask<Tag> which, std::size_t i, std::int32_t* list,
                                  std::size_t size) {
  const Tag tag;
  if (HWY_LIKELY(hn::AllFalse(tag, which))) return size;
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(tag, which, bits);
  for (std::size_t k = 0; k < hn::Lanes(tag); ++k) {
    if (bits[0] >> k & 1) list[size++] = static_cast<std::int32_t>(i + k);
  }
  return size;
}

// Lists where the point is not as deep as `enough`; some may be beyond the row.
std::size_t list_not_below(const double* row, std::size_t count, const double* point, double enough,
                           std::int32_t* list) {
  const Tag tag;
  const Below below(row, count, point);
  std::size_t size = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
    size = list_lanes(hn::Lt(below(i), hn::Set(tag, enough)), i, list, size);
  }
  return size;
}

// A bit a point that is as deep as `enough`.
void mark_deep(const double* row, std::size_t count, const double* points, std::size_t end,
               double enough, std::uint64_t* marks) {
  const Tag tag;
  const hn::RebindToUnsigned<Tag> bits;
  for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
    auto mark = hn::Zero(bits);
    for (std::size_t k = 0; k < end; ++k) {
      const auto deep = hn::Ge(Below(row, count, points + 3 * k)(i), hn::Set(tag, enough));
      const auto bit = hn::Set(bits, std::uint64_t{1} << k);
      mark = hn::Or(mark, hn::And(hn::BitCast(bits, hn::VecFromMask(tag, deep)), bit));
    }
    hn::StoreU(mark, bits, marks + i);
  }
}

// Lists which of the numbers are less than `limit`. least: of the others.
std::size_t list_less(const double* numbers, std::size_t count, double limit, std::int32_t* list,
                      double& least) {
  const Tag tag;
  auto rest = hn::Set(tag, kInfinity);
  std::size_t size = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
    const auto here = hn::LoadU(tag, numbers + i);
    const auto less = hn::Lt(here, hn::Set(tag, limit));
    rest = hn::Min(rest, hn::IfThenElse(less, rest, here));
    size = list_lanes(less, i, list, size);
  }
  least = hn::GetLane(hn::MinOfLanes(tag, rest));
  return size;
}

// The first that is `value`; it is there.
std::size_t find_in(const double* numbers, double value) {
  const Tag tag;
  for (std::size_t i = 0;; i += hn::Lanes(tag)) {
    const auto equal = hn::Eq(hn::LoadU(tag, numbers + i), hn::Set(tag, value));
    const auto found = hn::FindFirstTrue(tag, equal);
    if (found >= 0) return i + static_cast<std::size_t>(found);
  }
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>

namespace clearance {

namespace {

// Those are sooner listed one by one.
constexpr std::size_t kFewFacets = 32;

}  // namespace

HWY_EXPORT(deepen);
HWY_EXPORT(deepen_by_all);
HWY_EXPORT(list_not_below);
HWY_EXPORT(mark_deep);
HWY_EXPORT(list_less);
HWY_EXPORT(find_in);

void DeepestPoints::clear() noexcept {
  const std::size_t facets = body_.facets.size();
  std::fill_n(depths_.begin(), facets, -kInfinity);
  std::fill_n(depths_.begin() + static_cast<std::ptrdiff_t>(facets), 4, kInfinity);
}

void DeepestPoints::add(const Vec3& point, std::int32_t label) noexcept {
  if (count_ == 0) clear();
  points_[count_++] = point;
  least_ = HWY_DYNAMIC_DISPATCH(deepen)(body_.planes.row(0), body_.facets.size(), point.data(),
                                        static_cast<double>(label), depths_.data(), whose_.data());
}

void DeepestPoints::take(std::size_t points) noexcept {
  clear();
  count_ = points;
  has_all_ = true;
  least_ =
      HWY_DYNAMIC_DISPATCH(deepen_by_all)(body_.planes.row(0), body_.facets.size(),
                                          points_[0].data(), count_, depths_.data(), whose_.data());
}

std::int32_t DeepestPoints::where_least() const noexcept {
  return static_cast<std::int32_t>(HWY_DYNAMIC_DISPATCH(find_in)(depths_.data(), least_));
}

std::span<const std::int32_t> DeepestPoints::list_shallower(double enough, double& least) noexcept {
  return {list_.data(), HWY_DYNAMIC_DISPATCH(list_less)(depths_.data(), body_.facets.size(), enough,
                                                        list_.data(), least)};
}

std::span<const std::int32_t> DeepestPoints::mark(double enough, std::size_t main) noexcept {
  const double* row = body_.planes.row(0);
  const std::size_t facets = body_.facets.size();
  main_ = std::uint64_t{1} << main;
  std::size_t size = 0;
  if (facets > kFewFacets) {
    size = HWY_DYNAMIC_DISPATCH(list_not_below)(row, facets, points_[main].data(), enough,
                                                list_.data());
    while (size > 0 && static_cast<std::size_t>(list_[size - 1]) >= facets) --size;
    if (size == 0) return {};
  }
  HWY_DYNAMIC_DISPATCH(mark_deep)
  (row, facets, points_[0].data(), count_, enough, marks_.data());
  for (std::size_t i = 0; facets <= kFewFacets && i < facets; ++i) {
    list_[size] = static_cast<std::int32_t>(i);
    size += (marks_[i] & main_) == 0;
  }
  return {list_.data(), size};
}

}  // namespace clearance
#endif
