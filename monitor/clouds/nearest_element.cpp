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

double outward(double x, double sign) noexcept { return x + sign * 0x1p-52 * std::abs(x); }

// A query towards the middle of a box costs about as much as the bounds of this many children.
constexpr std::size_t kFewChildren = 4;

using Lanes = std::array<double, 8>;
static_assert(PointCloud::kFanOut == 8 && DepthCloud::kFanOut == 8);

// The elements of a PointCloud, as the search reads them. `least_along` is the minimum of n.p over
// an element, or over a box of them.
class Balls {
 public:
  explicit Balls(const PointCloud& cloud) noexcept : cloud_(cloud) {}

  [[nodiscard]] const PointCloud& cloud() const noexcept { return cloud_; }
  [[nodiscard]] const ConvexBody& origin() const noexcept { return cloud_.origin(); }
  [[nodiscard]] double least_along(std::size_t level, std::size_t i, const Vec3& n) const noexcept {
    const PointCloud::Node& node = cloud_.node(level, i);
    if (PointCloud::is_empty(node)) return kInfinity;
    double least = -node.radius;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      least += std::min(n[k] * node.low[axis], n[k] * node.high[axis]);
    }
    return least;
  }
  [[nodiscard]] Lanes lanes_along(std::size_t b, const Vec3& n) const noexcept {
    const PointCloud::Block& block = cloud_.block(b);
    Lanes least;
    for (std::size_t k = 0; k < least.size(); ++k) {
      least[k] = n.x() * block.x[k] + n.y() * block.y[k] + n.z() * block.z[k] - block.radius[k];
    }
    return least;
  }
  [[nodiscard]] Vec3 middle(std::size_t level, std::size_t i) const noexcept {
    const PointCloud::Node& node = cloud_.node(level, i);
    Vec3 middle;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      middle[k] = 0.5 * (double{node.low[axis]} + double{node.high[axis]});
    }
    return middle;
  }
  [[nodiscard]] std::uint32_t source(std::size_t b, std::size_t lane) const noexcept {
    return cloud_.block(b).source[lane];
  }
  // A ball's signed distance is that of its centre less its radius.
  // The bound of a lane without a plane: none, or infinite for a point that was left out.
  [[nodiscard]] Lanes present(std::size_t b) const noexcept {
    Lanes bound;
    for (std::size_t k = 0; k < bound.size(); ++k) {
      bound[k] = cloud_.block(b).is_present(k) ? -kInfinity : kInfinity;
    }
    return bound;
  }
  template <class Search>
  [[nodiscard]] DistanceResult evaluate(std::size_t b, std::size_t lane,
                                        Search& search) const noexcept {
    const PointCloud::Block& block = cloud_.block(b);
    const double radius = block.radius[lane];
    DistanceResult r = search.query({block.x[lane], block.y[lane], block.z[lane]});
    r.lower = outward(r.lower - radius, -1.0);
    r.upper = outward(r.upper - radius, 1.0);
    r.point_on_b -= radius * r.normal;
    return r;
  }

 private:
  const PointCloud& cloud_;
};

// The elements of a DepthCloud.
class Slabs {
 public:
  Slabs(const DepthCloud& cloud, SlabBody& body) noexcept : cloud_(cloud), body_(body) {}

  [[nodiscard]] const DepthCloud& cloud() const noexcept { return cloud_; }
  [[nodiscard]] const ConvexBody& origin() const noexcept { return body_.origin(); }
  [[nodiscard]] double least_along(std::size_t level, std::size_t i, const Vec3& n) const noexcept {
    if (DepthCloud::is_empty(cloud_.node(level, i))) return kInfinity;
    return cloud_.slab(level, i).least_along(n);
  }
  [[nodiscard]] Lanes lanes_along(std::size_t b, const Vec3& n) const noexcept {
    const DepthCloud::Block& block = cloud_.block(b);
    Lanes least;
    least.fill(kInfinity);
    for (std::size_t k = 0; k < least.size(); ++k) {
      if (block.low[k] <= block.high[k]) least[k] = cloud_.pixel_slab(b, k).least_along(n);
    }
    return least;
  }
  [[nodiscard]] Vec3 middle(std::size_t level, std::size_t i) const noexcept {
    return cloud_.slab(level, i).middle();
  }
  [[nodiscard]] std::uint32_t source(std::size_t b, std::size_t lane) const noexcept {
    return cloud_.source(b, lane);
  }
  // The bound of a lane without a plane: none, or infinite for a pixel that is missing or was left
  // out.
  [[nodiscard]] Lanes present(std::size_t b) const noexcept {
    const DepthCloud::Block& block = cloud_.block(b);
    Lanes bound;
    for (std::size_t k = 0; k < bound.size(); ++k) {
      bound[k] = block.low[k] <= block.high[k] ? -kInfinity : kInfinity;
    }
    return bound;
  }
  template <class Search>
  [[nodiscard]] DistanceResult evaluate(std::size_t b, std::size_t lane,
                                        Search& search) const noexcept {
    const DepthCloud::Slab slab = cloud_.pixel_slab(b, lane);
    return search.query(body_.of(slab), slab);
  }

 private:
  const DepthCloud& cloud_;
  SlabBody& body_;
};

// A half-space that contains the part, in the frame of the cloud: n.x <= offset. A point p of the
// cloud has a signed distance of at least n.p - offset, inside the part as well.
struct Plane {
  Vec3 normal = Vec3::Zero();
  double offset = 0.0;
};

template <class Elements>
class Search {
 public:
  Search(const ConvexBody& part, const Elements& elements, const RelativePose& part_from_cloud,
         CloudTracking& tracking) noexcept
      : part_(part),
        elements_(elements),
        cloud_(elements.cloud()),
        pose_(part_from_cloud),
        tracking_(tracking) {
    const auto& cloud = cloud_;
    const double coordinates = cloud.extent() + pose_.translation.norm() + part.bounding_radius;
    moved_ = pose_.translation_error + pose_.rotation_error * cloud.extent() +
             0x1p-49 * (cloud.extent() + pose_.translation.norm());
    error_ = kPlaneError * coordinates + 2.0 * moved_;
    take_planes();
  }

  [[nodiscard]] NearestElement run() noexcept {
    best_.answer = CloudAnswer::kNearest;
    if (!std::isfinite(error_)) return unknown();
    const std::size_t hint = std::min<std::size_t>(tracking_.block, cloud_.blocks() - 1);
    features_ = tracking_.features;
    evaluate_block(hint);
    visited_ = hint;
    descend(cloud_.levels() - 1, 0);
    tracking_.known = static_cast<std::uint32_t>(known_);
    if (bad_pose_) return unknown();
    best_.lower = std::min(best_.lower, left_out_);
    return best_;
  }

  // The part and the point p of the cloud's frame.
  DistanceResult query(const Vec3& p, TrackingState& features) noexcept {
    RelativePose at;
    at.translation = pose_.rotation * p + pose_.translation;
    at.translation_error = moved_;
    ++best_.queries;
    const DistanceResult r = distance(part_, elements_.origin(), at, features);
    keep_plane(r, [&](const Vec3& n) { return n.dot(p); });
    return r;
  }
  // The part and an element: a point, or a slab, whose body is in the cloud's frame.
  DistanceResult query(const Vec3& p) noexcept { return query(p, features_); }
  DistanceResult query(const ConvexBody& body, const DepthCloud::Slab& slab) noexcept {
    ++best_.queries;
    const DistanceResult r = distance(part_, body, pose_, features_);
    keep_plane(r, [&](const Vec3& n) { return slab.least_along(n); });
    return r;
  }

 private:
  // The planes of former queries, in the frame of the cloud.
  void take_planes() noexcept {
    if (tracking_.part != &part_ || tracking_.known > CloudTracking::kPlanes ||
        tracking_.next >= CloudTracking::kPlanes) {
      tracking_.part = &part_;
      tracking_.known = tracking_.next = 0;
    }
    known_ = tracking_.known;
    for (std::size_t k = 0; k < known_; ++k) {
      const PartPlane& plane = tracking_.planes[k];
      planes_[k] = {pose_.rotation.transpose() * plane.normal,
                    plane.offset - plane.normal.dot(pose_.translation) + error_};
    }
  }
  [[nodiscard]] NearestElement unknown() const noexcept {
    NearestElement none;
    none.answer = CloudAnswer::kBadPose;
    none.lower = -kInfinity;
    return none;
  }

  // Keeps the plane that separates the part from a body whose least n.p is `least(n)`.
  template <class Least>
  void keep_plane(const DistanceResult& r, const Least& least) noexcept {
    if (r.status == DistanceStatus::kBadPose) bad_pose_ = true;
    if (r.status != DistanceStatus::kConverged && r.status != DistanceStatus::kOverlapping) return;
    // The normal proves `lower`, so the part's support value is at most the body's least n.p less
    // `lower`. The gap of the bounds is added, because the normal of an overlap is known to that
    // only.
    const Vec3 n = pose_.rotation.transpose() * r.normal;
    const double offset = least(n) - r.lower + (r.upper - r.lower) + error_;
    const auto next = tracking_.next;
    planes_[next] = {n, offset};
    tracking_.planes[next] = {r.normal, offset + r.normal.dot(pose_.translation) + error_};
    tracking_.next = (next + 1) % CloudTracking::kPlanes;
    known_ = std::max(known_, std::size_t{next} + 1);
  }

  // A lower bound for every element below the node: of the first plane that leaves it out, or of
  // all planes. The plane that left out the last node mostly leaves out the next one as well.
  [[nodiscard]] double bound(std::size_t level, std::size_t i) noexcept {
    const double enough = best_.lower - kGap + error_;
    double most = -kInfinity;
    for (std::size_t k = 0; k < known_; ++k) {
      const std::size_t at = last_ + k < known_ ? last_ + k : last_ + k - known_;
      const Plane& plane = planes_[at];
      most = std::max(most, elements_.least_along(level, i, plane.normal) - plane.offset);
      if (most >= enough) {
        last_ = at;
        break;
      }
    }
    return most - error_;
  }

  // Is every element with this lower bound left out? Then its bound counts for the result.
  bool leaves_out(double lower) noexcept {
    if (!(lower >= best_.lower - kGap)) return false;
    left_out_ = std::min(left_out_, lower);
    return true;
  }

  void evaluate_block(std::size_t b) noexcept {
    Lanes lower = elements_.present(b);
    const auto add_plane = [&](const Plane& plane) {
      const Lanes along = elements_.lanes_along(b, plane.normal);
      for (std::size_t k = 0; k < along.size(); ++k) {
        lower[k] = std::max(lower[k], along[k] - plane.offset - error_);
      }
    };
    for (std::size_t i = 0; i < known_; ++i) add_plane(planes_[i]);
    // The nearest element of the newest plane first, which makes the best bound for the others.
    std::array<bool, PointCloud::kFanOut> done{};
    for (std::size_t round = 0; round < done.size(); ++round) {
      std::size_t next = done.size();
      for (std::size_t k = 0; k < done.size(); ++k) {
        if (done[k] || (next < done.size() && lower[k] >= lower[next])) continue;
        next = k;
      }
      if (leaves_out(lower[next])) return;  // and with it all others, whose bounds are no smaller
      done[next] = true;
      const std::uint32_t place = tracking_.next;
      evaluate(b, next);
      if (tracking_.next != place) add_plane(planes_[place]);
    }
  }

  void evaluate(std::size_t b, std::size_t lane) noexcept {
    const DistanceResult r = elements_.evaluate(b, lane, *this);
    best_.lower = std::min(best_.lower, r.lower);
    if (!(r.upper < best_.upper)) return;
    best_.upper = r.upper;
    best_.normal = r.normal;
    best_.point_on_part = r.point_on_a;
    best_.point_on_element = r.point_on_b;
    best_.source = elements_.source(b, lane);
    tracking_.block = static_cast<std::uint32_t>(b);
    tracking_.features = features_;
  }

  void descend(std::size_t level, std::size_t i) noexcept {
    if (leaves_out(bound(level, i))) return;
    if (level == 0) {
      if (i != visited_) evaluate_block(i);
      return;
    }
    Children children = children_of(level, i);
    // A plane towards the middle of the box leaves most children out at the price of one query.
    if (children.count > kFewChildren) {
      static_cast<void>(query(elements_.middle(level, i), point_features_));
      if (leaves_out(bound(level, i))) return;
      children = children_of(level, i);
    }
    for (std::size_t k = 0; k < children.count; ++k) {
      const Child& child = children.list[k];
      if (!leaves_out(child.lower)) descend(level - 1, child.index);
    }
  }

  struct Child {
    double lower;
    std::size_t index;
  };
  // Those that no plane leaves out, the nearest first.
  struct Children {
    std::array<Child, PointCloud::kFanOut> list;
    std::size_t count = 0;
  };
  [[nodiscard]] Children children_of(std::size_t level, std::size_t i) noexcept {
    Children children;
    const std::size_t first = i * PointCloud::kFanOut;
    const std::size_t end = std::min(first + PointCloud::kFanOut, cloud_.nodes(level - 1));
    for (std::size_t c = first; c < end; ++c) {
      const Child child{bound(level - 1, c), c};
      if (leaves_out(child.lower)) continue;
      std::size_t at = children.count++;
      for (; at > 0 && child.lower < children.list[at - 1].lower; --at) {
        children.list[at] = children.list[at - 1];
      }
      children.list[at] = child;
    }
    return children;
  }

  const ConvexBody& part_;
  const Elements elements_;
  const decltype(std::declval<Elements>().cloud())& cloud_;
  const RelativePose& pose_;
  CloudTracking& tracking_;
  double moved_ = 0.0;      // an element's place in the part's frame is at most this far off, m
  double error_ = 0.0;      // of a plane's bound, m
  TrackingState features_;  // of the part and an element
  TrackingState point_features_;                      // of the part and the middle of a box
  std::array<Plane, CloudTracking::kPlanes> planes_;  // those of tracking_, in the cloud's frame
  std::size_t known_ = 0, last_ = 0;
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
  return Search(part, Balls(cloud), part_from_cloud, tracking).run();
}

NearestElement nearest_element(const ConvexBody& part, const DepthCloud& cloud, SlabBody& body,
                               const RelativePose& part_from_cloud,
                               CloudTracking& tracking) noexcept {
  if (cloud.size() == 0) return {};
  return Search(part, Slabs(cloud, body), part_from_cloud, tracking).run();
}

}  // namespace clearance
