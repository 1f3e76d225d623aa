// Shelves the elements of a cloud in which a robot sees itself.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/convex_body.hpp"
#include "core/pose.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "monitor/clouds/point_cloud.hpp"
#include "monitor/clouds/slab_body.hpp"

namespace clearance {

// A box along the axes of a cloud's frame, m; low > high: it is empty.
struct CloudBox {
  Vec3 low = Vec3::Constant(kInfinity), high = Vec3::Constant(-kInfinity);

  [[nodiscard]] bool is_empty() const noexcept { return !(low.x() <= high.x()); }
  // Adds what is within the radius of a point.
  void add(const Vec3& point, double radius) noexcept {
    low = low.cwiseMin((point.array() - radius).matrix());
    high = high.cwiseMax((point.array() + radius).matrix());
  }
  void add(const CloudBox& other) noexcept {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
};

// The shell that shelving has made blind. Anything within `thickness` of the part may be hidden: a
// hand there is shelved with the part.
struct BlindShell {
  std::size_t elements = 0;
  double thickness = 0.0;  // m: no point of a shelved element is farther from the part
  double shell = 0.0;      // m: the widest that shelved one
  // The elements for which samples stand, and those of them for which the sample is deep: the
  // sensor has seen through the part's surface there (CentreLimit::depth).
  std::size_t sampled = 0, deep = 0;
  // Boxes of the cloud's frame that contain the shelved elements, and the large ones of them
  // (CentreLimit::large).
  CloudBox all, large;

  void add(const BlindShell& other) noexcept {
    elements += other.elements;
    thickness = std::max(thickness, other.thickness);
    shell = std::max(shell, other.shell);
    sampled += other.sampled;
    deep += other.deep;
    all.add(other.all);
    large.add(other.large);
  }
};

// The true place of a ball's point is within the stated error of its centre. The rest of the radius
// spans the distance to its neighbours, and may be far longer.
struct CentreLimit {
  double most = kInfinity;  // m, >= the shell: the points of the part itself are within this of it
  DepthError error;
  bool along_ray = false;  // depth is the distance from the sensor, not z
  // The size above which an element is large, m: besides the part, it may contain other bodies.
  double large = kInfinity;
  // An element is deep if all of it lies deeper in the part than this and the shell, m. NaN: no
  // element is sampled.
  double depth = std::numeric_limits<double>::quiet_NaN();
};

// A depth costs up to a hundred queries, so the samples thin out after the first elements of a
// part: a sample stands for so many elements. Some of a small part are needed, since those at its
// edge are never deep.
[[nodiscard]] constexpr std::size_t sampled_stride(std::size_t elements) noexcept {
  return elements < 512 ? 8 : 256;
}

// Shelves every element that comes within `shell` (m, >= 0) of the part: queries do not meet it any
// more. The pose is that of the frame's stamp, never the present one. A surface of the robot lies
// in the parts, and the elements contain it, so a shell of 0 is enough if the pose is exact. The
// caller adds the error of the pose to the shell, and calls refit() of the cloud after the last
// part. A ball stays if its centre is farther from the part than the limit and its own error. A bad
// pose shelves nothing. noexcept, no heap, deterministic.
[[nodiscard]] BlindShell shelve_own_points(const ConvexBody& part,
                                           const RelativePose& part_from_cloud, double shell,
                                           DepthCloud& cloud, SlabBody& body,
                                           const CentreLimit& limit = {}) noexcept;
[[nodiscard]] BlindShell shelve_own_points(const ConvexBody& part,
                                           const RelativePose& part_from_cloud, double shell,
                                           PointCloud& cloud,
                                           const CentreLimit& limit = {}) noexcept;

}  // namespace clearance
