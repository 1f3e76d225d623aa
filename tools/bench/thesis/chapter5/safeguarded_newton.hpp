// The same problem as dominant_term.hpp by Newton's method, for any p and any ratio of semi-axes.
//
// Let a_n be the shortest semi-axis and t = lambda + a_n^2. Then the terms are (a_i p_i / (a_i^2 -
// a_n^2 + t))^2, and their differences are exact. Near its pole, lambda itself would lose digits. 1
// / sqrt(S) is nearly a straight line in t, and concave (J. Moré and D. Sorensen, "Computing a
// trust region step", 1983). So Newton's method on it, started where S is at least 1, rises to the
// root and never passes it. This is the dominant-term iteration with the slope of the sum in place
// of the slope of one term.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/bench/thesis/chapter5/nearest_point.hpp"

namespace clearance::bench {

template <int N>
[[nodiscard]] NearestPoint<N> nearest_by_newton(const Point<N>& axes, const Point<N>& p) {
  constexpr int kMostIterations = 100;
  constexpr double kRounding = 2.0 * std::numeric_limits<double>::epsilon();
  Eigen::Index thin = 0;
  const double shortest = axes.minCoeff(&thin);
  const Point<N> shift = ((axes.array() - shortest) * (axes.array() + shortest)).matrix();
  const Point<N> lifted = axes.cwiseProduct(p);
  // A coordinate of 0 has no term; it would be 0 / 0 at the pole.
  const auto ratios_at = [&](double t) {
    Point<N> ratios;
    for (int i = 0; i < N; ++i) ratios[i] = lifted[i] == 0.0 ? 0.0 : lifted[i] / (shift[i] + t);
    return ratios;
  };
  double t = std::max(0.0, (lifted.cwiseAbs() - shift).maxCoeff());  // one term is 1: S >= 1
  const double highest = lifted.norm();                              // S <= 1
  Point<N> ratios = ratios_at(t);
  int iteration = 0;
  while (iteration < kMostIterations) {
    const double s = ratios.squaredNorm(), root = std::sqrt(s);
    if (!(root - 1.0 > kRounding)) break;
    ++iteration;
    double slope = 0.0;  // of -S / 2
    for (int i = 0; i < N; ++i) {
      if (lifted[i] != 0.0) slope += ratios[i] * ratios[i] / (shift[i] + t);
    }
    const double next = std::min(highest, t + s * (root - 1.0) / slope);
    if (!(next > t)) break;
    t = next;
    ratios = ratios_at(t);
  }
  const double s = ratios.squaredNorm();
  if (t == 0.0 && s < 1.0) {  // p lies in the plane across the shortest axis, far inside
    ratios[thin] = std::sqrt(1.0 - s);
  } else {
    ratios /= std::sqrt(s);
  }
  return {axes.cwiseProduct(ratios), iteration, iteration < kMostIterations};
}

}  // namespace clearance::bench
