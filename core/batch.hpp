// The distances of many pairs at once: the same answers as distance(), bit for bit, in less time.
//
// Vector code judges the pairs whose last features are still the closest, 1, 2, 4 or 8 at a time.
// Highway chooses the width at run time, and the results do not depend on it. The other pairs are
// queried by distance(), one by one. A batch is for tracked pairs, whose bodies move a little
// between two rounds.
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
  // The bodies must outlive the batch. All memory is allocated here: about 1 kB a pair, 64 bytes a
  // body, and 120 kB. Indices must be below bodies.size(); a body may be in any number of pairs.
  DistanceBatch(std::span<const ConvexBody* const> bodies, std::span<const BodyPair> pairs);
  ~DistanceBatch();
  DistanceBatch(DistanceBatch&&) noexcept;
  DistanceBatch& operator=(DistanceBatch&&) noexcept;

  // Takes one pose a body, as relative_pose() does. Returns one result a pair, in the order of the
  // pairs: that of distance() with one tracking state per pair. The results stay until the next
  // call. No heap, deterministic.
  std::span<const DistanceResult> evaluate(std::span<const Pose> world_from_body) noexcept;

  // The pair's witness point on B in the last round, in frame B and before the radius is added, as
  // in TrackingState.
  [[nodiscard]] Vec3 point_on_b(std::size_t pair) const noexcept;

  // All tracking states become cold.
  void forget() noexcept;

  // The number of pairs of the last round that distance() had to answer.
  [[nodiscard]] std::size_t single_queries() const noexcept;

  // The vector instructions in use here: "AVX3" (AVX-512), "AVX2", "SSE4", "NEON", or "SCALAR" for
  // plain C++.
  [[nodiscard]] static const char* instruction_set() noexcept;

 private:
  class Rounds;
  std::unique_ptr<Rounds> rounds_;
};

}  // namespace clearance
