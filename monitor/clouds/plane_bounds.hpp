// Lower bounds of eight elements or boxes at once, by planes that contain a part on one side.
//
// A plane n.x <= h with a unit normal contains the part. So a point p has a signed distance of at
// least n.p - h, inside the part as well. The bound of a body is that of its point with the least
// n.p. Vector code computes eight of them (Highway chooses the width at run time, and no bit
// depends on it).
#pragma once

#include <array>
#include <cstddef>

#include "core/pose.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "monitor/clouds/point_cloud.hpp"

namespace clearance {

inline constexpr std::size_t kCloudLanes = 8;
static_assert(PointCloud::kFanOut == kCloudLanes && DepthCloud::kFanOut == kCloudLanes);

// A half-space n.x <= offset that contains a part.
struct PartPlane {
  Vec3 normal = Vec3::Zero();  // unit
  double offset = kInfinity;   // m, rounding included
};

// A plane a lane, in the frame of the part.
struct PlaneLanes {
  alignas(32) std::array<double, kCloudLanes> x, y, z, offset;

  void set(std::size_t lane, const PartPlane& plane) noexcept {
    x[lane] = plane.normal.x();
    y[lane] = plane.normal.y();
    z[lane] = plane.normal.z();
    offset[lane] = plane.offset;
  }
  void fill(const PartPlane& plane) noexcept {
    for (std::size_t lane = 0; lane < kCloudLanes; ++lane) set(lane, plane);
  }
  [[nodiscard]] PartPlane get(std::size_t lane) const noexcept {
    return {{x[lane], y[lane], z[lane]}, offset[lane]};
  }
};

// m; infinite for a lane without an element.
using BoundLanes = std::array<double, kCloudLanes>;

// The bounds less `error` (m), the caller's bound of all roundings. The first form takes a plane a
// lane, in the frame of the part, and its pose; the second form takes one plane for all lanes, in
// the frame of the cloud.
struct PlaneBounds {
  const RelativePose& part_from_cloud;
  double error = 0.0;

  void of(const DepthCloud::Lanes& slabs, const PlaneLanes& planes, BoundLanes& out) const noexcept;
  void of(const DepthCloud::Lanes& slabs, const PartPlane& plane, BoundLanes& out) const noexcept;
  void of(const PointCloud::Boxes& boxes, const PlaneLanes& planes, BoundLanes& out) const noexcept;
  void of(const PointCloud::Boxes& boxes, const PartPlane& plane, BoundLanes& out) const noexcept;
  // The cubes of a block.
  struct Cubes {
    const PointCloud::Block& block;
  };
  void of(const Cubes& cubes, const PlaneLanes& planes, BoundLanes& out) const noexcept;
  void of(const Cubes& cubes, const PartPlane& plane, BoundLanes& out) const noexcept;
  // A lane of a removed point counts like all others.
  void of(const PointCloud::Block& points, const PlaneLanes& planes,
          BoundLanes& out) const noexcept;
  void of(const PointCloud::Block& points, const PartPlane& plane, BoundLanes& out) const noexcept;
};

}  // namespace clearance
