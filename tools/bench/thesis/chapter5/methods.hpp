// The methods of chapter 5, and what they are compared with, on a pair of ellipsoids.
#pragma once

#include <functional>
#include <vector>

#include "tools/bench/crossed_ellipsoids.hpp"
#include "tools/bench/thesis/chapter5/nearest_point.hpp"

namespace clearance::bench {

// One pair, its models made; runs for at most so many rounds.
using Run = std::function<ClosestPoints(int most_rounds)>;

struct Method {
  const char* name;  // of its rows
  const char* label;
  int most_rounds;  // 0: it has no rounds that could be cut short
  Run (*prepared)(const EllipsoidPair&);
};

[[nodiscard]] const std::vector<Method>& methods();

// Order of the models that stand for "polyhedral model (288 facets)" in Table 5.2.
inline constexpr int kModelOrder = 15;

// The least number of rounds after which (5.2.1) is below the tolerance, if it stays there; 0 where
// it is never found to be.
[[nodiscard]] int rounds_to(double tolerance, const Run& run, int most_rounds,
                            const ClosestPoints& truth);

// §5.1: the nearest point, as §5.2 calls it.
[[nodiscard]] NearestPoint<3> by_dominant_term(const Vec3& axes, const Vec3& p);
// The same with the limits of the thesis's program, as printed in its appendix.
[[nodiscard]] NearestPoint<3> by_dominant_term_as_printed(const Vec3& axes, const Vec3& p);
[[nodiscard]] NearestPoint<3> by_newton(const Vec3& axes, const Vec3& p);

}  // namespace clearance::bench
