#include "monitor/clouds/nearest_element.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace clearance {
namespace {

// An element is left out although its bound is below the least one by up to this, m. Otherwise, a
// wall parallel to a face would need a query for each of its points.
constexpr double kGap = 4e-10;
// The sum of all roundings of a plane's bound, relative to the coordinates in it. The counts are
// below 2^5 of 2^-53 each.
constexpr double kPlaneError = 0x1p-46;

// A half-space that contains the part, in the frame of the cloud: n.x <= offset. A point p of the
// cloud has a signed distance of at least n.p - offset, inside the part as well.
struct Plane {
  Vec3 normal = Vec3::Zero();
  double offset = 0.0;
};

class Search {
 public:
  Search(const ConvexBody& part, const PointCloud& cloud, const RelativePose& part_from_cloud,
         CloudTracking& tracking) noexcept
      : part_(part), cloud_(cloud), pose_(part_from_cloud), tracking_(tracking) {
    const double coordinates = cloud.extent() + pose_.translation.norm() + part.bounding_radius;
    moved_ = pose_.translation_error + pose_.rotation_error * cloud.extent() +
             0x1p-49 * (cloud.extent() + pose_.translation.norm());
    error_ = kPlaneError * coordinates + 2.0 * moved_;
  }

  [[nodiscard]] NearestElement run() noexcept {
    best_.answer = CloudAnswer::kNearest;
    if (!std::isfinite(error_)) return unknown();
    const std::size_t hint = std::min<std::size_t>(tracking_.block, cloud_.blocks() - 1);
    features_ = tracking_.features;
    evaluate_block(hint);
    visited_ = hint;
    descend(cloud_.levels() - 1, 0);
    if (bad_pose_) return unknown();
    best_.lower = std::min(best_.lower, left_out_);
    return best_;
  }

 private:
  [[nodiscard]] NearestElement unknown() const noexcept {
    NearestElement none;
    none.answer = CloudAnswer::kBadPose;
    none.lower = -kInfinity;
    return none;
  }

  // The part and the point p of the cloud's frame. Keeps the plane that separates them.
  DistanceResult query(const Vec3& p) noexcept {
    RelativePose at;
    at.translation = pose_.rotation * p + pose_.translation;
    at.translation_error = moved_;
    ++best_.queries;
    const DistanceResult r = distance(part_, cloud_.origin(), at, features_);
    if (r.status == DistanceStatus::kBadPose) bad_pose_ = true;
    if (r.status == DistanceStatus::kConverged || r.status == DistanceStatus::kOverlapping) {
      // The normal proves `lower`, so the part's support value is at most n.p - lower. The gap of
      // the bounds is added, because the normal of an overlap is known to that only.
      const Vec3 n = pose_.rotation.transpose() * r.normal;
      planes_[next_] = {n, n.dot(p) - r.lower + (r.upper - r.lower) + error_};
      next_ = (next_ + 1) % planes_.size();
      known_ = std::min(known_ + 1, planes_.size());
    }
    return r;
  }

  // A lower bound for every element below the node.
  [[nodiscard]] double bound(const PointCloud::Node& node) const noexcept {
    double most = -kInfinity;
    for (std::size_t i = 0; i < known_; ++i) {
      const Vec3& n = planes_[i].normal;
      double least = -planes_[i].offset;
      for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        least += std::min(n[k] * node.low[axis], n[k] * node.high[axis]);
      }
      most = std::max(most, least);
    }
    return most - node.radius - error_;
  }

  // Is every element with this lower bound left out? Then its bound counts for the result.
  bool leaves_out(double lower) noexcept {
    if (!(lower >= best_.lower - kGap)) return false;
    left_out_ = std::min(left_out_, lower);
    return true;
  }

  void evaluate_block(std::size_t b) noexcept {
    const PointCloud::Block& block = cloud_.block(b);
    // The nearest element of the newest plane first, which makes the best bound for the others.
    std::array<double, PointCloud::kFanOut> lower;
    std::array<bool, PointCloud::kFanOut> done{};
    for (std::size_t round = 0; round < PointCloud::kFanOut; ++round) {
      lower.fill(-kInfinity);
      for (std::size_t i = 0; i < known_; ++i) {
        const Plane& plane = planes_[i];
        for (std::size_t k = 0; k < PointCloud::kFanOut; ++k) {
          const double at = plane.normal.x() * block.x[k] + plane.normal.y() * block.y[k] +
                            plane.normal.z() * block.z[k] - plane.offset;
          lower[k] = std::max(lower[k], at - block.radius[k] - error_);
        }
      }
      std::size_t next = PointCloud::kFanOut;
      for (std::size_t k = 0; k < PointCloud::kFanOut; ++k) {
        if (done[k] || (next < PointCloud::kFanOut && lower[k] >= lower[next])) continue;
        next = k;
      }
      if (leaves_out(lower[next])) return;  // and with it all others, whose bounds are no smaller
      done[next] = true;
      evaluate(block, b, next);
    }
  }

  void evaluate(const PointCloud::Block& block, std::size_t b, std::size_t k) noexcept {
    const double radius = block.radius[k];
    const DistanceResult r = query({block.x[k], block.y[k], block.z[k]});
    // A ball's signed distance is that of its centre less its radius.
    const double lower = outward(r.lower - radius, -1.0), upper = outward(r.upper - radius, 1.0);
    best_.lower = std::min(best_.lower, lower);
    if (!(upper < best_.upper)) return;
    best_.upper = upper;
    best_.normal = r.normal;
    best_.point_on_part = r.point_on_a;
    best_.point_on_element = r.point_on_b - radius * r.normal;
    best_.source = block.source[k];
    tracking_ = {static_cast<std::uint32_t>(b), features_};
  }

  [[nodiscard]] static double outward(double x, double sign) noexcept {
    return x + sign * 0x1p-52 * std::abs(x);
  }

  void descend(std::size_t level, std::size_t i) noexcept {
    const PointCloud::Node& node = cloud_.node(level, i);
    if (leaves_out(bound(node))) return;
    if (level == 0) {
      if (i != visited_) evaluate_block(i);
      return;
    }
    // A plane towards the middle of the box leaves most boxes out at the price of one query.
    Vec3 middle;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      middle[k] = 0.5 * (double{node.low[axis]} + double{node.high[axis]});
    }
    static_cast<void>(query(middle));
    if (leaves_out(bound(node))) return;

    struct Child {
      double lower;
      std::size_t index;
    };
    std::array<Child, PointCloud::kFanOut> children;
    std::size_t count = 0;
    const std::size_t first = i * PointCloud::kFanOut;
    const std::size_t end = std::min(first + PointCloud::kFanOut, cloud_.nodes(level - 1));
    for (std::size_t c = first; c < end; ++c) {
      const Child child{bound(cloud_.node(level - 1, c)), c};
      std::size_t at = count++;
      for (; at > 0 && child.lower < children[at - 1].lower; --at) children[at] = children[at - 1];
      children[at] = child;
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (!leaves_out(children[k].lower)) descend(level - 1, children[k].index);
    }
  }

  const ConvexBody& part_;
  const PointCloud& cloud_;
  const RelativePose& pose_;
  CloudTracking& tracking_;
  double moved_ = 0.0;  // an element's place in the part's frame is at most this far off, m
  double error_ = 0.0;  // of a plane's bound, m
  TrackingState features_;
  std::array<Plane, 8> planes_;
  std::size_t known_ = 0, next_ = 0;
  std::size_t visited_ = 0;
  double left_out_ = kInfinity;
  bool bad_pose_ = false;
  NearestElement best_;
};

}  // namespace

NearestElement nearest_element(const ConvexBody& part, const PointCloud& cloud,
                               const RelativePose& part_from_cloud,
                               CloudTracking& tracking) noexcept {
  if (cloud.size() == 0) return {};
  return Search(part, cloud, part_from_cloud, tracking).run();
}

}  // namespace clearance
