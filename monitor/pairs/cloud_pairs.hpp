// Part pairs in which one part is the cloud of a sensor: a union of many convex elements.
//
// The signed distance is the least one over all elements. It changes by at most the motion of the
// two, as the distance of two convex parts does. But no direction separates a whole cloud from a
// part, so only displacement carries these bounds.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/pairs/pair_table.hpp"

namespace clearance {

class CloudPairs {
 public:
  // All queries of a tick together may spend this much work on overlaps (nearest_element.hpp). One
  // query may spend a quarter of what is left, so that some is left for every part. Each query
  // may exceed this by one overlapping element.
  static constexpr std::uint32_t kOverlapWorkOfATick = 2048, kShareOfAQuery = 4;

  CloudPairs(const Scene& scene, const std::vector<PosedPart>& parts, const PairTable& table);

  // Call this before the queries of a tick.
  void begin_tick() noexcept { work_left_ = kOverlapWorkOfATick; }
  [[nodiscard]] std::uint32_t overlap_work_left() const noexcept { return work_left_; }

  // The content of a sensor's object from now on; null: none. It must not change while it is here.
  // No element is farther than `pose_error` from its exact place, m. Without elements, no lower
  // bound is larger than `range`, m.
  struct Content {
    const SeenCloud* cloud = nullptr;
    double pose_error = 0.0;
    double range = 0.0;
  };
  void set(std::uint32_t sensor, const Content& content) noexcept { content_[sensor] = content; }
  [[nodiscard]] const Content& content(std::uint32_t sensor) const noexcept {
    return content_[sensor];
  }

  [[nodiscard]] bool has(std::uint32_t part_pair) const noexcept {
    return slot_[part_pair] != kNone;
  }

  // Bounds for the exact poses of both parts. Points and normal are in the world; the normal leads
  // from A to B. Points and normal are NaN if the status is kBadPose, or if the image has no
  // element left. In the second case the lower bound is at most Content::range, and the upper one
  // that of an element anywhere in the view.
  struct Answer {
    DistanceBounds bounds;
    DistanceStatus status = DistanceStatus::kBadPose;
    Vec3 witness_a, witness_b, normal;
    std::uint32_t overlap_work = 0;  // of NearestElement
  };
  // Requires has(). The parts are those of the part pair, placed at any poses. If the work that is
  // left does not suffice, the bounds hold, and the status is kIterationLimit. noexcept, no heap.
  [[nodiscard]] Answer query(std::uint32_t part_pair, const PosedPart& a,
                             const PosedPart& b) noexcept;
  // The same for any two parts; `seen` is what a sensor sees, in this frame.
  [[nodiscard]] static Answer query(const Content& content, const PosedPart& seen,
                                    const PosedPart& part, SlabBody& body, CloudTracking& tracking,
                                    std::uint32_t most_overlap_work = kMostOverlapWork) noexcept;

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::vector<Content> content_;          // by sensor
  std::vector<std::uint32_t> sensor_of_;  // by object
  std::vector<std::uint32_t> slot_;       // by part pair: index into tracking_
  std::vector<CloudTracking> tracking_;
  SlabBody body_;                // scratch
  std::uint32_t work_left_ = 0;  // in this tick
};

}  // namespace clearance
