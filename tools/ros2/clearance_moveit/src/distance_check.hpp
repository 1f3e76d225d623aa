// Answers a DistanceRequest for two sets of parts.
#pragma once

#include "pair_filter.hpp"
#include "pair_query.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <moveit/collision_detection/collision_common.hpp>

namespace clearance_moveit {

class DistanceCheck {
 public:
  DistanceCheck(const collision_detection::DistanceRequest& request,
                collision_detection::DistanceResult& result)
      : request_(request), result_(result) {}

  // Measures every part of A to every part of B, or to every other part of A if B is A. For the
  // least distance of all, the nearest boxes come first, and most pairs need no query.
  void check(const PosedParts& a, const PosedParts& b, PairFilter& filter);

 private:
  struct Candidate {
    double gap;  // m: of the boxes; -infinity: they overlap
    std::size_t i, j;
  };
  using Pair = std::pair<std::string, std::string>;

  [[nodiscard]] std::vector<Candidate> candidates(const PosedParts& a, const PosedParts& b) const;
  void measure(const PosedParts& a, const PosedParts& b, const Candidate& of, PairFilter& filter);
  // A distance of the pair that is not below this is of no use, m.
  [[nodiscard]] double limit(const Pair& pair) const;
  // The nearest ones of each pair are kept, in their order.
  void take(const collision_detection::DistanceResultsData& found, const Pair& pair);
  [[nodiscard]] bool is_global() const {
    return request_.type == collision_detection::DistanceRequestTypes::GLOBAL;
  }
  [[nodiscard]] bool is_done() const {
    return result_.collision && !request_.enable_signed_distance;
  }

  const collision_detection::DistanceRequest& request_;
  collision_detection::DistanceResult& result_;
};

}  // namespace clearance_moveit
