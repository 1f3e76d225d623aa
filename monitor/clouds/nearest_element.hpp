// The element of a cloud that is nearest to a convex part, with certified bounds.
#pragma once

#include <cstdint>

#include "core/distance.hpp"
#include "monitor/clouds/cloud_tracking.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "monitor/clouds/point_cloud.hpp"
#include "monitor/clouds/slab_body.hpp"

namespace clearance {

enum class CloudAnswer : std::uint8_t {
  kNearest,
  kEmpty,    // the cloud has no element: both bounds are infinite
  kBadPose,  // as DistanceStatus::kBadPose: nothing is known
};

// The work limit: a part that is deep in a cloud overlaps thousands of elements, and a query of the
// core takes up to a hundred times as long in an overlap. As soon as an overlap is certified and
// the queries in overlaps have cost this much, no further element is queried. The unit is a query
// of a polyhedron or a truncated cone and a point, some 0.7 us. A query of an ellipsoid and a
// point, or of a curved part and a slab or cube, takes 80 us (kCostOfCurved). A query of a
// polyhedron and a slab or cube takes 14 us (kCostOfBodies).
inline constexpr std::uint32_t kMostOverlapWork = 8192, kCostOfCurved = 128, kCostOfBodies = 32;

// lower <= signed distance of the part and the nearest element <= upper, rounding included, as in
// DistanceResult. If the core's queries converge and all coordinates are below 100 m, upper - lower
// is at most 1e-9 m within the work limit, which only an overlap with many elements exceeds. Both
// bounds hold beyond it, too. Points and normal are in the frame of the part. They belong to the
// element that has the least upper bound.
struct NearestElement {
  CloudAnswer answer = CloudAnswer::kEmpty;
  double lower = kInfinity, upper = kInfinity;  // m
  Vec3 normal = Vec3::Zero();                   // unit, from the part towards the element
  Vec3 point_on_part = Vec3::Zero(), point_on_element = Vec3::Zero();
  // Index of the point in the input of PointCloud::build(), or DepthCloud::source() of the pixel.
  std::uint32_t source = 0;
  std::uint32_t queries = 0;       // of the core
  std::uint32_t overlap_work = 0;  // the cost of those in overlaps
  bool within_work_limit = true;
};

// noexcept, no heap, deterministic. Any hint is accepted. The body at the address `tracking.part`
// must be the one that it was.
[[nodiscard]] NearestElement nearest_element(
    const ConvexBody& part, const PointCloud& cloud, const RelativePose& part_from_cloud,
    CloudTracking& tracking, std::uint32_t most_overlap_work = kMostOverlapWork) noexcept;
// The same for the slabs of a depth image. `body` is scratch memory.
[[nodiscard]] NearestElement nearest_element(
    const ConvexBody& part, const DepthCloud& cloud, SlabBody& body,
    const RelativePose& part_from_cloud, CloudTracking& tracking,
    std::uint32_t most_overlap_work = kMostOverlapWork) noexcept;

}  // namespace clearance
