#include "monitor/clouds/own_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/distance.hpp"

namespace clearance {
namespace {

// A bound of the errors in lengths that are computed here, relative to them.
constexpr double kRoundedUp = 1.0 + 0x1p-40;
// Sizes are those of float32: one that is as large as the limit is not larger.
constexpr double kLarger = 1.0 + 0x1p-20;

// The pose of a body whose origin is at a point of the cloud's frame.
RelativePose moved_to(const Vec3& p, const RelativePose& pose) noexcept {
  RelativePose at = pose;
  at.translation = pose.rotation * p + pose.translation;
  at.translation_error = pose.translation_error + pose.rotation_error * p.norm() +
                         0x1p-49 * (p.norm() + pose.translation.norm());
  return at;
}

// Samples an element before it is shelved. `at` places the element's centre, and all of its points
// are within `radius` of it.
void sample(const ConvexBody& part, const ConvexBody& point, const RelativePose& at, double radius,
            double depth, BlindShell& blind) noexcept {
  const std::size_t stride = sampled_stride(blind.elements);
  if (std::isnan(depth) || blind.elements % stride != 3) return;
  TrackingState features;
  blind.sampled += stride;
  if (!(distance(part, point, at, features).upper >= -(depth + radius))) blind.deep += stride;
}

class SlabShelf {
 public:
  SlabShelf(const ConvexBody& part, const RelativePose& pose, double shell, DepthCloud& cloud,
            SlabBody& body, const CentreLimit& limit) noexcept
      : part_(part), pose_(pose), shell_(shell), cloud_(cloud), body_(body), limit_(limit) {}

  BlindShell run() noexcept {
    if (cloud_.levels() > 0) descend(cloud_.levels() - 1, 0);
    return blind_;
  }

 private:
  [[nodiscard]] bool is_near(const DepthCloud::Slab& slab) noexcept {
    // A plane that separated a slab before mostly separates its neighbours as well.
    for (const Plane& plane : planes_) {
      if (slab.least_along(plane.normal) - plane.offset > shell_) return false;
    }
    const DistanceResult r = distance(part_, body_.of(slab), pose_, features_, {.depth = false});
    if (r.status == DistanceStatus::kBadPose || !(r.lower > shell_)) {
      return r.status != DistanceStatus::kBadPose;
    }
    const Vec3 n = pose_.rotation.transpose() * r.normal;
    planes_[next_] = {n, slab.least_along(n) - r.lower};
    next_ = (next_ + 1) % planes_.size();
    return false;
  }

  // A query of a point costs a tenth of that of a slab. Most slabs of the robot have their middle
  // within the shell.
  [[nodiscard]] bool has_near_middle(const DepthCloud::Slab& slab) noexcept {
    const DistanceResult r = distance(part_, body_.origin(), moved_to(slab.middle(), pose_),
                                      point_features_, {.depth = false});
    return r.status != DistanceStatus::kBadPose && r.upper <= shell_;
  }

  void descend(std::size_t level, std::size_t i) noexcept {
    if (DepthCloud::is_empty(cloud_.node(level, i)) || !is_near(cloud_.slab(level, i))) return;
    if (level == 0) {
      shelve(i);
      return;
    }
    const std::size_t first = i * DepthCloud::kFanOut;
    const std::size_t end = std::min(first + DepthCloud::kFanOut, cloud_.nodes(level - 1));
    for (std::size_t child = first; child < end; ++child) descend(level - 1, child);
  }

  void shelve(std::size_t b) noexcept {
    for (std::size_t lane = 0; lane < DepthCloud::kFanOut; ++lane) {
      if (cloud_.block(b).low[lane] > cloud_.block(b).high[lane]) continue;
      const DepthCloud::Slab slab = cloud_.pixel_slab(b, lane);
      if (!has_near_middle(slab) && !is_near(slab)) continue;
      sample(part_, body_.origin(), moved_to(slab.middle(), pose_), slab.diameter(),
             limit_.depth + shell_, blind_);
      cloud_.remove(b, lane);
      ++blind_.elements;
      blind_.shell = shell_;
      const double size = slab.diameter();
      blind_.all.add(slab.middle(), size);
      if (size > kLarger * limit_.large) blind_.large.add(slab.middle(), size);
      blind_.thickness = std::max(blind_.thickness, shell_ + size);
    }
  }

  const ConvexBody& part_;
  const RelativePose& pose_;
  double shell_;
  DepthCloud& cloud_;
  SlabBody& body_;
  const CentreLimit& limit_;
  TrackingState features_, point_features_;
  // Half-spaces n.x <= offset of the cloud's frame that contain the part, but for rounding.
  struct Plane {
    Vec3 normal = Vec3::Zero();
    double offset = kInfinity;
  };
  std::array<Plane, 4> planes_;
  std::size_t next_ = 0;
  BlindShell blind_;
};

class BallShelf {
 public:
  BallShelf(const ConvexBody& part, const RelativePose& pose, double shell,
            const CentreLimit& limit, PointCloud& cloud) noexcept
      : part_(part), pose_(pose), shell_(shell), limit_(limit), cloud_(cloud) {}

  BlindShell run() noexcept {
    if (cloud_.levels() > 0) descend(cloud_.levels() - 1, 0);
    return blind_;
  }

 private:
  // Does the ball of this radius around the point come near?
  [[nodiscard]] bool is_near(const Vec3& p, double radius) noexcept {
    const DistanceResult r =
        distance(part_, cloud_.origin(), moved_to(p, pose_), features_, {.depth = false});
    return r.status != DistanceStatus::kBadPose && r.lower <= (shell_ + radius) * kRoundedUp;
  }
  // The ball around a cube decides for most of them.
  [[nodiscard]] bool is_near(const Cube& cube) noexcept {
    if (!is_near(cube.centre, kCubeRadius * cube.half)) return false;
    const DistanceResult r =
        distance(part_, cloud_.cube_at_origin(cube.half), moved_to(cube.centre, pose_),
                 cube_features_, {.depth = false});
    return r.status != DistanceStatus::kBadPose && r.lower <= shell_ * kRoundedUp;
  }

  // The centre of a ball that is shelved is within the shell and this of the part.
  [[nodiscard]] double reach(const Vec3& p, double radius) const noexcept {
    const double range = p.norm(), depth = limit_.along_ray ? range : p.z();
    const double error = limit_.error.at(depth) * (range / depth) * kRoundedUp;
    return std::min(radius, limit_.most - shell_ + error);
  }

  void descend(std::size_t level, std::size_t i) noexcept {
    const PointCloud::Node& node = cloud_.node(level, i);
    if (PointCloud::is_empty(node)) return;
    Vec3 low, high;
    for (int k = 0; k < 3; ++k) {
      low[k] = node.low[static_cast<std::size_t>(k)];
      high[k] = node.high[static_cast<std::size_t>(k)];
    }
    if (!is_near(0.5 * (low + high), node.radius + 0.5 * (high - low).norm() * kRoundedUp)) return;
    if (level == 0) {
      shelve(i);
      return;
    }
    const std::size_t first = i * PointCloud::kFanOut;
    const std::size_t end = std::min(first + PointCloud::kFanOut, cloud_.nodes(level - 1));
    for (std::size_t child = first; child < end; ++child) descend(level - 1, child);
  }

  void shelve(std::size_t b) noexcept {
    const PointCloud::Block& block = cloud_.block(b);
    for (std::size_t lane = 0; lane < PointCloud::kFanOut; ++lane) {
      if (!block.is_present(lane)) continue;
      const bool is_cube = cloud_.shape() == ElementShape::kCube;
      const double radius = (is_cube ? kCubeRadius : 1.0) * block.radius[lane];
      const Vec3 p(block.x[lane], block.y[lane], block.z[lane]);
      const double near = is_cube ? radius : reach(p, radius);
      if (is_cube ? !is_near(cloud_.cube(b, lane)) : !is_near(p, near)) continue;
      sample(part_, cloud_.origin(), moved_to(p, pose_), radius, limit_.depth + shell_, blind_);
      blind_.elements += cloud_.remove(b, lane) ? 1 : 0;
      blind_.shell = shell_;
      // A cube lies along the axes of the box.
      const double half = is_cube ? block.radius[lane] * kRoundedUp : radius;
      blind_.all.add(p, half);
      if (2.0 * (is_cube ? half : near) > kLarger * limit_.large) blind_.large.add(p, half);
      // A surface between the point and a neighbour that stays may be hidden up to that neighbour.
      blind_.thickness = std::max(blind_.thickness, shell_ + 2.0 * radius);
    }
  }

  const ConvexBody& part_;
  const RelativePose& pose_;
  double shell_;
  const CentreLimit& limit_;
  PointCloud& cloud_;
  TrackingState features_, cube_features_;
  BlindShell blind_;
};

}  // namespace

BlindShell shelve_own_points(const ConvexBody& part, const RelativePose& part_from_cloud,
                             double shell, DepthCloud& cloud, SlabBody& body,
                             const CentreLimit& limit) noexcept {
  return SlabShelf(part, part_from_cloud, shell, cloud, body, limit).run();
}

BlindShell shelve_own_points(const ConvexBody& part, const RelativePose& part_from_cloud,
                             double shell, PointCloud& cloud, const CentreLimit& limit) noexcept {
  return BallShelf(part, part_from_cloud, shell, limit, cloud).run();
}

}  // namespace clearance
