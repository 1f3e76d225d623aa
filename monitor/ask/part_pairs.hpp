// All watched pairs of convex parts, bundled by the part that moves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "core/distance_result.hpp"
#include "monitor/ask/posture.hpp"

namespace clearance {

// One part of a link, the tip, against parts that all have the same chain of joints to it: those of
// another link, of the object that carries the tip's robot, or of all other objects that are no
// links.
struct Bundle {
  std::uint32_t tip = 0;  // part
  std::uint32_t object_tip = 0;
  std::uint32_t object_base = 0;  // a link; of several objects, any
  bool base_is_link = false;
  bool base_carries_tip = false;  // the base is what the robot of the tip stands on
  bool keeps_direction = false;   // the tip does
  Chain chain;
  double sum_of_reaches = 0.0;
  // No stated error changes the distance of one of the pairs by more, m.
  double model_error = 0.0;
  std::uint32_t first = 0, end = 0;  // into PartPairs
};

// The box around a part along the axes of the part's frame, errors included. Unbounded parts have
// infinite ones.
struct PartBox {
  Vec3 low, high;
};

struct PartPair {
  std::uint32_t base = 0;  // part; the tip is the bundle's
  std::uint32_t bundle = 0;
  bool swapped = false;  // the base is the second object of the pair in the scene
  // The base is what a sensor sees: index of the state of its queries.
  static constexpr std::uint32_t kNotSeen = ~0u;
  std::uint32_t seen = kNotSeen;
};

class PartPairs {
 public:
  PartPairs(const Scene& scene, Posture& posture);

  [[nodiscard]] std::span<const Bundle> bundles() const noexcept { return bundles_; }
  [[nodiscard]] std::span<const PartPair> pairs() const noexcept { return pairs_; }
  [[nodiscard]] const PartBox& box(std::uint32_t part) const noexcept { return boxes_[part]; }

  // Makes all states of tracking cold.
  void forget() noexcept {
    ++question_;
    for (CloudTracking& tracking : seen_) tracking.forget();
  }
  [[nodiscard]] CloudTracking& seen(std::uint32_t slot) noexcept { return seen_[slot]; }
  [[nodiscard]] SlabBody& slab() noexcept { return slab_; }
  [[nodiscard]] TrackingState& tracking(std::uint32_t pair) noexcept {
    if (tracked_in_[pair] != question_) {
      tracked_in_[pair] = question_;
      tracking_[pair] = {};
    }
    return tracking_[pair];
  }

 private:
  std::vector<Bundle> bundles_;
  std::vector<PartPair> pairs_;  // bundle by bundle
  std::vector<PartBox> boxes_;   // by part
  std::vector<TrackingState> tracking_;
  std::vector<std::uint64_t> tracked_in_;
  std::vector<CloudTracking> seen_;
  SlabBody slab_;  // scratch
  std::uint64_t question_ = 1;
};

}  // namespace clearance
