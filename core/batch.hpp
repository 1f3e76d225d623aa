// The distances of many pairs at once, with one tracking state per pair.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// Two bodies by their indices.
struct BodyPair {
  std::uint32_t a, b;
};

class DistanceBatch {
 public:
  // The bodies must outlive the batch. All memory is allocated here: about 200 bytes a pair.
  // Indices must be below bodies.size(); a body may be in any number of pairs.
  DistanceBatch(std::span<const ConvexBody* const> bodies, std::span<const BodyPair> pairs);
  ~DistanceBatch();
  DistanceBatch(DistanceBatch&&) noexcept;
  DistanceBatch& operator=(DistanceBatch&&) noexcept;

  // Takes one pose a body, as relative_pose() does. Returns one result a pair, in the order of the
  // pairs: that of distance(). The results stay until the next call. No heap, deterministic.
  std::span<const DistanceResult> evaluate(std::span<const Pose> world_from_body) noexcept;

  // The pair's witness point on B in the last round, in frame B and before the radius is added, as
  // in TrackingState.
  [[nodiscard]] Vec3 point_on_b(std::size_t pair) const noexcept;

  // All tracking states become cold.
  void forget() noexcept;

 private:
  class Rounds;
  std::unique_ptr<Rounds> rounds_;
};

}  // namespace clearance
