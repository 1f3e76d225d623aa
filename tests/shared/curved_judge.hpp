// Compares answers about curved bodies with the truth in 50 digits, and states in words what is
// wrong with them.
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
  // The size of both bodies and their distance, m. The tolerance of 1e-13 is relative to it.
  [[nodiscard]] double size() const { return size_; }

  // The errors of the result; empty if there are none. It checks the following.
  // - The bounds are compared in 50 digits. For overlapping cores, the lower bound is compared with
  //   what the result's own normal proves. The upper bound is compared with what 40 directions and
  //   their neighbourhoods prove.
  // - If the status is converged, bounds and distance are right to 1e-13 of size().
  // - The witness points of disjoint bodies lie on their bodies to 1e-13 of size().
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
