#include "monitor/clouds/nearest_element.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "monitor/clouds/elements.hpp"

namespace clearance {
namespace {

// An element is left out although its bound is below the least one by up to this, m. Otherwise, a
// wall parallel to a face would need a query for each of its points.
constexpr double kGap = 4e-10;
// The roundings of a plane's bound, relative to the coordinates: below 2^5 of 2^-53 for each.
constexpr double kPlaneError = 0x1p-46;
// The origin of the part's frame is the pivot of its motion until it is this far away, m.
constexpr double kPivotMoves = 0.25;
// While more than kManyGroups are stored, a group is removed if its parent's plane leaves it out by
// kSpareToRemove, m.
constexpr std::uint32_t kManyGroups = CloudCut::kSlots / 2;
constexpr double kSpareToRemove = 2e-3;
// Planes towards more children of a group than this cost more queries than they save.
constexpr int kAsksOfAGroup = 2;

template <class Elements>
class Search {
 public:
  Search(const ConvexBody& part, const Elements& elements, const RelativePose& part_from_cloud,
         CloudTracking& tracking, std::uint32_t most_overlap_work) noexcept
      : part_(part),
        elements_(elements),
        cloud_(elements.cloud()),
        pose_(part_from_cloud),
        tracking_(tracking),
        cut_(tracking.cut),
        bounds_{part_from_cloud},
        most_overlap_work_(most_overlap_work) {
    const double coordinates = cloud_.extent() + pose_.translation.norm() + part.bounding_radius;
    moved_ = pose_.translation_error + pose_.rotation_error * cloud_.extent() +
             0x1p-49 * (cloud_.extent() + pose_.translation.norm());
    error_ = kPlaneError * coordinates + 2.0 * moved_;
    bounds_.error = error_;
  }

  [[nodiscard]] NearestElement run() noexcept {
    best_.answer = CloudAnswer::kNearest;
    if (!std::isfinite(error_)) return unknown();
    take_cut();
    evaluate_hint();
    witness_ = in_cloud(part_.interior - pose_.translation);
    if (cut_.count == 0) {
      Group& root = cut_.groups[take_slot()];
      root = {0, CloudCut::kNoSlot, static_cast<std::uint8_t>(cloud_.levels() - 1), 0, 0, true};
      cut_.planes[0].fill({});
      invalidate(0);
    }
    // Slots that are added meanwhile are processed where they are added.
    const std::uint32_t end = cut_.count;
    for (std::uint32_t slot = 0; slot < end; ++slot) {
      const double bound =
          cut_.carried[slot] - cut_.travelled - cut_.turned * cut_.farthest[slot] - error_;
      if (!leaves_out(bound)) process(slot);
    }
    if (cut_.in_use > kManyGroups) remove_a_group();
    if (bad_pose_) return unknown();
    best_.lower = std::min(best_.lower, left_out_);
    tracking_.normal = best_.normal;
    return best_;
  }

  // The part and the point p of the cloud's frame.
  DistanceResult query(const Vec3& p, const DistanceOptions& options) noexcept {
    RelativePose at;
    at.translation = pose_.rotation * p + pose_.translation;
    at.translation_error = moved_;
    ++best_.queries;
    const DistanceResult r = distance(part_, elements_.origin(), at, tracking_.features, options);
    const bool is_ellipsoid = part_.curved.kind == CurvedShape::Kind::kEllipsoid;
    if (!(r.lower > 0.0)) best_.overlap_work += options.depth && is_ellipsoid ? kCostOfCurved : 1;
    keep_plane(r, [&] { return r.normal.dot(at.translation); });
    return r;
  }
  // The part and an element, whose body is placed at p in the cloud's frame.
  template <class Element>
  DistanceResult query(const ConvexBody& body, const Vec3& p, const Element& element) noexcept {
    RelativePose at = pose_;
    at.translation += pose_.rotation * p;
    at.translation_error = moved_;
    ++best_.queries;
    const DistanceResult r = distance(part_, body, at, tracking_.body_features);
    if (!(r.lower > 0.0)) best_.overlap_work += part_.is_curved() ? kCostOfCurved : kCostOfBodies;
    keep_plane(r, [&] {
      return element.least_along(in_cloud(r.normal)) + r.normal.dot(pose_.translation) + error_;
    });
    return r;
  }

  [[nodiscard]] Vec3 in_cloud(const Vec3& direction) const noexcept {
    return pose_.rotation.transpose() * direction;
  }
  // The bound of a body by the plane of the last query, which had one. `least`: its least n.p.
  [[nodiscard]] double bound_by_newest(double least) const noexcept {
    return least - (newest_.offset - newest_.normal.dot(pose_.translation)) - error_;
  }
  [[nodiscard]] bool has_plane() const noexcept { return has_newest_; }  // of the last query
  [[nodiscard]] bool is_left_out(double lower) const noexcept {
    return lower >= best_.lower - kGap;
  }

 private:
  using Group = CloudCut::Group;

  [[nodiscard]] NearestElement unknown() noexcept {
    tracking_.part = nullptr;
    return {.answer = CloudAnswer::kBadPose, .lower = -kInfinity};
  }

  // Keeps the plane of a query. The normal proves `lower`, so the part's support value is at most
  // the body's least n.p, which `least` returns, less `lower`. The gap of the bounds is added,
  // because the normal of an overlap is known to that only.
  template <class Least>
  void keep_plane(const DistanceResult& r, const Least& least) noexcept {
    if (r.status == DistanceStatus::kBadPose) bad_pose_ = true;
    // The error of the pose alone may keep the bounds of a curved part wider than rounding.
    has_newest_ = r.status == DistanceStatus::kConverged ||
                  r.status == DistanceStatus::kOverlapping ||
                  (r.status == DistanceStatus::kIterationLimit && r.lower > 0.0);
    if (!has_newest_) return;
    newest_ = {r.normal, least() - r.lower + (r.upper - r.lower) + error_};
    witness_ = in_cloud(r.point_on_a - pose_.translation);
  }

  // A plane of the ball around the part, for a query that proves none.
  [[nodiscard]] PartPlane plane_of_ball(const Vec3& normal) const noexcept {
    const bool is_unit = std::abs(normal.norm() - 1.0) < 0x1p-20;
    return {is_unit ? Vec3(normal.normalized()) : Vec3(Vec3::UnitX()),
            part_.bounding_radius + part_.radius + part_.position_error + error_};
  }

  // Is every element with this lower bound left out? Then its bound counts for the result.
  bool leaves_out(double lower) noexcept {
    if (!is_left_out(lower)) return false;
    left_out_ = std::min(left_out_, lower);
    return true;
  }

  // The cut of the last query, if it is one of this tree, and the motion since then.
  void take_cut() noexcept {
    if (tracking_.part != &part_ || cut_.levels != cloud_.levels() ||
        cut_.count > CloudCut::kSlots) {
      tracking_.part = &part_;
      cut_.levels = cloud_.levels();
      cut_.count = cut_.in_use = 0;
      cut_.free = CloudCut::kNoSlot;
      cut_.revision = 0;
    }
    const Vec3 origin = -in_cloud(pose_.translation);
    if (cut_.revision != cloud_.revision() || !((origin - cut_.pivot).norm() <= kPivotMoves)) {
      if (cut_.revision != cloud_.revision()) remove_empty_groups();
      cut_.revision = cloud_.revision();
      cut_.travelled = cut_.turned = 0.0;
      cut_.pivot = origin;
      for (std::uint32_t slot = 0; slot < cut_.count; ++slot)
        if (cut_.groups[slot].stored) invalidate(slot);
    } else {
      const Mat3 turn = pose_.rotation - cut_.last.rotation;
      const Vec3 shift = turn * cut_.pivot + (pose_.translation - cut_.last.translation);
      // The 2-norm of a difference of rotations is its Frobenius norm over the root of two. The
      // errors of the two rotations add less than the second term.
      cut_.turned += turn.norm() * (0.70710678118654757 + 0x1p-40) +
                     3.0 * (pose_.rotation_error + cut_.last.rotation_error) + 0x1p-50;
      cut_.travelled += shift.norm() + moved_ + cut_.last_error + error_;
    }
    cut_.last = pose_;
    cut_.last_error = moved_;
  }

  // The bounds of what is left then come from planes alone. They hold, but may be far apart.
  [[nodiscard]] bool is_exhausted() const noexcept {
    return best_.upper < 0.0 && best_.overlap_work >= most_overlap_work_;
  }

  void invalidate(std::uint32_t slot) noexcept {
    cut_.carried[slot] = -kInfinity;
    cut_.farthest[slot] = -1.0;
  }

  [[nodiscard]] std::uint16_t take_slot() noexcept {
    std::uint16_t slot = cut_.free;
    if (slot != CloudCut::kNoSlot) {
      cut_.free = cut_.groups[slot].parent;
    } else if (cut_.count < CloudCut::kSlots) {
      slot = static_cast<std::uint16_t>(cut_.count++);
    } else {
      return CloudCut::kNoSlot;
    }
    ++cut_.in_use;
    return slot;
  }
  void remove(std::uint32_t slot) noexcept {
    Group& group = cut_.groups[slot];
    Group& parent = cut_.groups[group.parent];
    parent.expanded = static_cast<std::uint8_t>(parent.expanded & ~(1U << group.lane));
    group.stored = false;
    group.parent = cut_.free;
    cut_.free = static_cast<std::uint16_t>(slot);
    cut_.carried[slot] = kInfinity;
    cut_.farthest[slot] = 0.0;
    --cut_.in_use;
  }
  // In another frame, groups may be missing. Groups below them have no elements either.
  void remove_empty_groups() noexcept {
    for (std::uint32_t slot = 1; slot < cut_.count; ++slot) {
      const Group& group = cut_.groups[slot];
      if (group.stored && elements_.is_empty(group.level, group.index)) remove(slot);
    }
  }

  // Removes the next group if its parent's plane leaves it out well.
  void remove_a_group() noexcept {
    cut_.checked = cut_.checked + 1 < cut_.count ? cut_.checked + 1 : 1;
    const Group& group = cut_.groups[cut_.checked];
    if (cut_.checked >= cut_.count || !group.stored || group.expanded != 0) return;
    const std::uint16_t parent = group.parent;
    BoundLanes lower;
    elements_.bound(cut_.groups[parent].level, cut_.groups[parent].index, cut_.planes[parent],
                    bounds_, lower);
    const double bound = lower[group.lane];
    if (!(bound >= best_.lower + kSpareToRemove)) return;
    cut_.carried[parent] = std::min(cut_.carried[parent], carried(bound, parent));
    remove(cut_.checked);
  }

  [[nodiscard]] double carried(double bound, std::uint32_t slot) const noexcept {
    return bound + cut_.travelled + cut_.turned * cut_.farthest[slot];
  }

  // The element of the last answer first, which makes the best bound for the others.
  void evaluate_hint() noexcept {
    if (tracking_.block >= cloud_.blocks() || tracking_.lane >= kCloudLanes ||
        !elements_.is_present(tracking_.block, tracking_.lane)) {
      return;
    }
    hint_block_ = tracking_.block;
    hint_lane_ = tracking_.lane;
    hint_lower_ = evaluate(hint_block_, hint_lane_, tracking_.normal);
    hint_plane_ = newest_;
    has_hint_plane_ = has_newest_;
    has_hint_ = true;
  }

  double evaluate(std::size_t b, std::size_t lane, const Vec3& along) noexcept {
    const DistanceResult r = elements_.evaluate(b, lane, along, *this);
    if (leaves_out(r.lower)) return r.lower;
    best_.lower = std::min(best_.lower, r.lower);
    if (!(r.upper < best_.upper)) return r.lower;
    best_.upper = r.upper;
    best_plane_ = has_newest_ ? newest_ : plane_of_ball(r.normal);
    best_.normal = r.normal;
    best_.point_on_part = r.point_on_a;
    best_.point_on_element = r.point_on_b;
    best_.source = elements_.source(b, lane);
    tracking_.block = static_cast<std::uint32_t>(b);
    tracking_.lane = static_cast<std::uint32_t>(lane);
    return r.lower;
  }

  void process(std::uint32_t slot) noexcept {
    Group& group = cut_.groups[slot];
    if (cut_.farthest[slot] < 0.0)
      cut_.farthest[slot] = elements_.farthest(group.level, group.index, cut_.pivot);
    cut_.carried[slot] = carried(least_of(group, cut_.planes[slot], slot), slot);
  }

  // The least bound of all lanes of a group that are not expanded. All elements below the group are
  // then left out or evaluated.
  double least_of(Group& group, PlaneLanes& planes, std::uint32_t slot) noexcept {
    BoundLanes lower;
    elements_.bound(group.level, group.index, planes, bounds_, lower);
    for (std::size_t k = 0; k < kCloudLanes; ++k)
      if ((group.expanded >> k & 1U) != 0) lower[k] = kInfinity;
    unsigned done = 0, asked = 0;  // a bit a lane
    if (has_hint_ && group.level == 0 && group.index == hint_block_) {
      lower[hint_lane_] = hint_lower_;
      if (has_hint_plane_) planes.set(hint_lane_, hint_plane_);
      done |= 1U << hint_lane_;
    }
    for (;;) {
      std::size_t k = kCloudLanes;
      for (std::size_t i = 0; i < kCloudLanes; ++i)
        if ((done >> i & 1U) == 0 && (k == kCloudLanes || lower[i] < lower[k])) k = i;
      if (k == kCloudLanes || is_left_out(lower[k])) break;
      if (is_exhausted()) {
        best_.within_work_limit = false;
        newest_ = best_plane_;
        adopt_plane(group, planes, done, lower);
        break;
      }
      if (group.level == 0) {
        done |= 1U << k;
        const double element = evaluate(group.index, k, {planes.x[k], planes.y[k], planes.z[k]});
        if (has_newest_) adopt_plane(group, planes, done, lower);
        lower[k] = element;
        continue;
      }
      if ((asked >> k & 1U) == 0 && std::popcount(asked) < kAsksOfAGroup) {
        asked |= 1U << k;
        const std::size_t node = group.index * kCloudLanes + k;
        const Vec3 p = elements_.towards(group.level - 1U, node, witness_);
        if (p != witness_) {
          static_cast<void>(query(p, {.depth = false}));
          if (has_newest_) adopt_plane(group, planes, done, lower);
          continue;
        }
      }
      done |= 1U << k;
      lower[k] = expand(group, planes.get(k), k, slot);
    }
    const double least = *std::min_element(lower.begin(), lower.end());
    left_out_ = std::min(left_out_, least);
    return least;
  }

  // The newest plane, for the lanes that it bounds better than theirs.
  void adopt_plane(const Group& group, PlaneLanes& planes, unsigned done,
                   BoundLanes& lower) noexcept {
    const PartPlane in_cloud_frame{in_cloud(newest_.normal),
                                   newest_.offset - newest_.normal.dot(pose_.translation)};
    BoundLanes by_newest;
    elements_.bound(group.level, group.index, in_cloud_frame, bounds_, by_newest);
    const unsigned others = done | group.expanded;
    for (std::size_t k = 0; k < kCloudLanes; ++k) {
      if (!(by_newest[k] > lower[k]) || (others >> k & 1U) != 0) continue;
      lower[k] = by_newest[k];
      planes.set(k, newest_);
    }
  }

  // The group below a lane. Returns its least bound, or infinity if it has a slot of its own.
  double expand(Group& parent, const PartPlane& plane, std::size_t lane,
                std::uint32_t parent_slot) noexcept {
    const auto index = static_cast<std::uint32_t>(parent.index * kCloudLanes + lane);
    const auto level = static_cast<std::uint8_t>(parent.level - 1U);
    const std::uint16_t slot = parent.stored ? take_slot() : CloudCut::kNoSlot;
    if (slot == CloudCut::kNoSlot) {
      Group group{index, CloudCut::kNoSlot, level, static_cast<std::uint8_t>(lane), 0, false};
      PlaneLanes planes;
      planes.fill(plane);
      return least_of(group, planes, slot);
    }
    cut_.groups[slot] = {index, static_cast<std::uint16_t>(parent_slot),
                         level, static_cast<std::uint8_t>(lane),
                         0,     true};
    cut_.planes[slot].fill(plane);
    parent.expanded = static_cast<std::uint8_t>(parent.expanded | 1U << lane);
    invalidate(slot);
    process(slot);
    return kInfinity;
  }

  const ConvexBody& part_;
  const Elements elements_;
  const decltype(std::declval<Elements>().cloud())& cloud_;
  const RelativePose& pose_;
  CloudTracking& tracking_;
  CloudCut& cut_;
  PlaneBounds bounds_;
  double moved_ = 0.0;  // an element's place in the part's frame is at most this far off, m
  double error_ = 0.0;  // of a plane's bound, m
  Vec3 witness_ = Vec3::Zero();  // the part's point in the last answer, in the cloud's frame
  // In the part's frame: planes of the last query, the hint, and the element of least upper bound.
  PartPlane newest_, hint_plane_, best_plane_;
  bool has_newest_ = false, has_hint_ = false, has_hint_plane_ = false, bad_pose_ = false;
  std::size_t hint_block_ = 0, hint_lane_ = 0;
  double hint_lower_ = 0.0, left_out_ = kInfinity;
  std::uint32_t most_overlap_work_;
  NearestElement best_;
};

}  // namespace

NearestElement nearest_element(const ConvexBody& part, const PointCloud& cloud,
                               const RelativePose& part_from_cloud, CloudTracking& tracking,
                               std::uint32_t most_overlap_work) noexcept {
  if (cloud.size() == 0) return {};
  if (cloud.shape() == ElementShape::kCube)
    return Search(part, Cubes(cloud), part_from_cloud, tracking, most_overlap_work).run();
  return Search(part, Balls(cloud), part_from_cloud, tracking, most_overlap_work).run();
}

NearestElement nearest_element(const ConvexBody& part, const DepthCloud& cloud, SlabBody& body,
                               const RelativePose& part_from_cloud, CloudTracking& tracking,
                               std::uint32_t most_overlap_work) noexcept {
  if (cloud.size() == 0) return {};
  return Search(part, Slabs(cloud, body), part_from_cloud, tracking, most_overlap_work).run();
}

}  // namespace clearance
