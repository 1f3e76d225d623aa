// The instruction sets that vector code may use on this machine, one at a time.
#pragma once

#include <hwy/targets.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "core/distance.hpp"

namespace clearance {

// While an object of this class lives, all vector code uses one instruction set.
class OnlyWith {
 public:
  explicit OnlyWith(std::int64_t target) { choose(target); }
  ~OnlyWith() { choose(0); }
  OnlyWith(const OnlyWith&) = delete;
  OnlyWith& operator=(const OnlyWith&) = delete;

 private:
  static void choose(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

// The supported numbers of lanes: one (not on Arm, whose minimum is two), two, four, eight, as far
// as this machine supports them.
inline std::vector<std::int64_t> vector_widths() {
  std::vector<std::int64_t> all;
  for (const std::int64_t target : {HWY_SCALAR, HWY_SSE4, HWY_NEON, HWY_AVX2, HWY_AVX3}) {
    if ((HWY_TARGETS & hwy::SupportedTargets() & target) != 0) all.push_back(target);
  }
  return all;
}

inline bool same_bits(const DistanceResult& r, const DistanceResult& s) {
  const auto same = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  return same(r.distance, s.distance) && same(r.lower, s.lower) && same(r.upper, s.upper) &&
         same(r.normal, s.normal) && same(r.point_on_a, s.point_on_a) &&
         same(r.point_on_b, s.point_on_b) && r.status == s.status && r.path == s.path &&
         r.iterations == s.iterations;
}

}  // namespace clearance
