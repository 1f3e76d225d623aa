// The element of a cloud that is nearest to a convex part, with certified bounds.
#pragma once

#include <array>
#include <cstdint>

#include "core/distance.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "monitor/clouds/point_cloud.hpp"
#include "monitor/clouds/slab_body.hpp"

namespace clearance {

// A half-space n.x <= offset that contains a part, in the frame of the part.
struct PartPlane {
  Vec3 normal = Vec3::Zero();  // unit
  double offset = 0.0;         // m, rounding included
};

// The state of a part between queries, also from one frame to the next, and for any cloud. The
// block and the features are hints. The planes are facts about `part`: they stay true wherever it
// moves. A query of another body drops them.
struct CloudTracking {
  static constexpr std::size_t kPlanes = 12;

  std::uint32_t block = 0;  // the block of the last nearest element
  TrackingState features;   // of the part and that element
  const ConvexBody* part = nullptr;
  std::array<PartPlane, kPlanes> planes;
  std::uint32_t known = 0, next = 0;  // planes; the place of the next one
};

enum class CloudAnswer : std::uint8_t {
  kNearest,
  kEmpty,    // the cloud has no element: both bounds are infinite
  kBadPose,  // as DistanceStatus::kBadPose: nothing is known
};

// lower <= signed distance of the part and the nearest element <= upper, rounding included, as in
// DistanceResult. If the core's queries converge and all coordinates are below 100 m, upper - lower
// is at most 1e-9 m. Points and normal are in the frame of the part. They belong to the element
// that has the least upper bound.
struct NearestElement {
  CloudAnswer answer = CloudAnswer::kEmpty;
  double lower = kInfinity, upper = kInfinity;  // m
  Vec3 normal = Vec3::Zero();                   // unit, from the part towards the element
  Vec3 point_on_part = Vec3::Zero(), point_on_element = Vec3::Zero();
  // Index of the point in the input of PointCloud::build(), or DepthCloud::source() of the pixel.
  std::uint32_t source = 0;
  std::uint32_t queries = 0;  // of the core
};

// noexcept, no heap, deterministic. Any hint is accepted. The body at the address `tracking.part`
// must be the one that it was.
[[nodiscard]] NearestElement nearest_element(const ConvexBody& part, const PointCloud& cloud,
                                             const RelativePose& part_from_cloud,
                                             CloudTracking& tracking) noexcept;
// The same for the slabs of a depth image. `body` is scratch memory.
[[nodiscard]] NearestElement nearest_element(const ConvexBody& part, const DepthCloud& cloud,
                                             SlabBody& body, const RelativePose& part_from_cloud,
                                             CloudTracking& tracking) noexcept;

}  // namespace clearance
