// Compiled once per vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/penetration/deepest_vertices.cpp"
#include "core/numerics/simd_targets.hpp"
// This include must come first.
#include <algorithm>

#include "core/penetration/deepest_vertices.hpp"
#include "core/penetration/facets-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

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

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
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

}  // namespace clearance
#endif
