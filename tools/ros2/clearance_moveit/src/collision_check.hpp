// Answers a CollisionRequest for two sets of parts.
#pragma once

#include "pair_filter.hpp"
#include "pair_query.hpp"

#include <cstddef>
#include <cstdint>

#include <moveit/collision_detection/collision_common.hpp>

namespace clearance_moveit {

// Parts that are not certified disjoint collide. A request counts across calls, as `result` does.
class CollisionCheck {
 public:
  CollisionCheck(const collision_detection::CollisionRequest& request,
                 collision_detection::CollisionResult& result)
      : request_(request), result_(result) {}

  // Checks every part of A against every part of B, or against every other part of A if B is A.
  void check(const PosedParts& a, const PosedParts& b, PairFilter& filter);

 private:
  void check_parts(const PosedParts& a, std::size_t i, const PosedParts& b, std::size_t j,
                   PairFilter& filter);
  [[nodiscard]] std::size_t wanted(const Owner& a, const Owner& b) const;
  void keep(const collision_detection::Contact& contact);
  void conclude();

  const collision_detection::CollisionRequest& request_;
  collision_detection::CollisionResult& result_;
  bool done_ = false;
};

// Between two bodies that are apart, the depth is 0.
[[nodiscard]] collision_detection::Contact contact_of(const Found& found, const Owner& a,
                                                      const Owner& b);

}  // namespace clearance_moveit
