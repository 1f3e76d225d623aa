// Holds answers about curved bodies against the truth in 50 digits, and says in words what is wrong
// with them.
#pragma once

#include <string>
#include <vector>

#include "core/distance_result.hpp"
#include "tests/shared/curved_cases.hpp"

namespace clearance {

class CurvedJudge {
 public:
  explicit CurvedJudge(const hard::CurvedCase& asked);

  [[nodiscard]] const oracle::RealBounds& truth() const { return truth_; }
  [[nodiscard]] bool cores_meet() const { return truth_.lower < -1e300; }
  // Of both bodies and the distance, m: what 1e-13 is relative to.
  [[nodiscard]] double size() const { return size_; }

  // What the result gets wrong; empty when nothing:
  //  - its bounds, compared in 50 digits; of cores that overlap, the lower one with what its own
  //    normal proves, the upper one with what any of 40 directions and their neighbourhood prove
  //  - where it says that it has converged: bounds and distance to 1e-13 of size()
  //  - the witness points of bodies that are apart: on their bodies to 1e-13 of size()
  [[nodiscard]] std::vector<std::string> faults(const DistanceResult& r) const;

 private:
  void judge_bounds(const DistanceResult& r, std::vector<std::string>& faults) const;
  void judge_depth(const DistanceResult& r, std::vector<std::string>& faults) const;
  void judge_points(const DistanceResult& r, std::vector<std::string>& faults) const;
  [[nodiscard]] oracle::Real farthest_apart() const;

  hard::CurvedCase case_;
  double size_;
  oracle::RealBounds truth_;
};

}  // namespace clearance
