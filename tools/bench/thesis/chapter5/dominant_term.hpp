// §5.1: the multiplier of (5.1.6) by its dominant term, with the ratio accelerator.
//
// x_i = a_i^2 p_i / (a_i^2 + lambda) (5.1.5), where the three terms of S(lambda) (5.1.6) have the
// sum 1. The iteration assumes that the terms keep their proportions. A term i is chosen once, and
// lambda is set so that the term becomes its share of the sum (5.1.7). By (5.1.8) this is
//
//     lambda' = (a_i^2 + lambda) sqrt(S) - a_i^2.
//
// The later steps shrink by a constant ratio, with which every other step is extrapolated to its
// limit. An extrapolation that makes S worse is taken back.
#pragma once

#include <algorithm>
#include <cmath>

#include "tools/bench/thesis/chapter5/nearest_point.hpp"

namespace clearance::bench {

// The thesis ends at |S - 1| of 1e-10 at best, and multiplies the lower limit of lambda, minus the
// least semi-axis squared, by 0.999. The limits here are those of doubles, which only helps the
// method.
struct DominantTermOptions {
  double tolerance = 1e-14;  // of S
  int most_iterations = 200;
  double nearest_to_pole = 1e-15;
  double centre = 1e-4;  // below this S(0) the answer is the end of the shortest semi-axis
};

template <int N>
class DominantTerm {
 public:
  DominantTerm(const Point<N>& axes, const Point<N>& p, const DominantTermOptions& options)
      : p_(p),
        squares_(axes.cwiseProduct(axes)),
        weights_(squares_.cwiseProduct(p.cwiseProduct(p))),
        options_(options) {
    shortest_ = axes.minCoeff(&thin_);
    least_ = -shortest_ * shortest_ * (1.0 - options.nearest_to_pole);
  }

  [[nodiscard]] NearestPoint<N> solve() {
    const double at_p = sum(0.0);
    if (at_p < options_.centre) return end_of_the_shortest_axis();
    lambda_ = std::max((at_p - 1.0) * shortest_ * shortest_, 0.5 * least_);
    double s = sum(lambda_);
    choose_closest_to_one(s);
    int iteration = 0;
    while (iteration < options_.most_iterations && !(std::abs(s - 1.0) <= options_.tolerance)) {
      ++iteration;
      s = advance(s, iteration);
      if (lambda_ == before_) break;  // no double in between
    }
    return surface_point(iteration, std::abs(s - 1.0) <= options_.tolerance);
  }

 private:
  [[nodiscard]] double sum(double lambda) const {
    return (weights_.array() / (squares_.array() + lambda).square()).sum();
  }
  [[nodiscard]] double by_term(int i, double s) const {
    return (squares_[i] + lambda_) * std::sqrt(s) - squares_[i];
  }

  void choose_closest_to_one(double s) {
    double closest = 1e10;
    for (int i = 0; i < N; ++i) {
      const double next = by_term(i, s);
      if (!(next > least_)) continue;
      const double off = std::abs(sum(next) - 1.0);
      if (off < closest) {
        closest = off;
        term_ = i;
      }
    }
  }

  // Chooses another term, the one whose step keeps the largest distance from the pole.
  double beyond_the_pole(double s) {
    int farthest = term_ == 0 ? 1 : 0;
    for (int i = 0; i < N; ++i) {
      if (i != term_ && by_term(i, s) > by_term(farthest, s)) farthest = i;
    }
    term_ = farthest;
    steady_ = 0;
    return std::max(by_term(term_, s), least_);
  }

  // One step and the S it leads to; `s` is that of lambda_.
  double advance(double s, int iteration) {
    double next = by_term(term_, s);
    const double plain = next;
    const double change = lambda_ - before_;
    bool extrapolated = false;
    if (steady_ >= 1 && iteration % 2 == 0 && change != 0.0) {
      const double ratio = (next - lambda_) / change;
      if (std::abs(ratio) < 1.0) {
        next += (next - lambda_) * ratio / (1.0 - ratio);
        extrapolated = true;
      }
    }
    if (next < least_) next = beyond_the_pole(s);
    double s_next = sum(next);
    ++steady_;
    if (std::abs(s_next - 1.0) > std::abs(s - 1.0)) {
      steady_ = 0;
      if ((s_next > 1.0) != (s > 1.0)) {
        next = lambda_ + (next - lambda_) * (1.0 - s) / (s_next - s);
      } else if (extrapolated && plain > least_) {
        next = plain;
      } else {
        next = 0.5 * (next + lambda_);
      }
      s_next = sum(next);
    }
    before_ = lambda_;
    lambda_ = next;
    return s_next;
  }

  [[nodiscard]] NearestPoint<N> end_of_the_shortest_axis() const {
    Point<N> end = Point<N>::Zero();
    end[thin_] = std::copysign(shortest_, p_[thin_]);
    return {end, 0, true};
  }
  // By (5.1.5), and along the radius onto the surface.
  [[nodiscard]] NearestPoint<N> surface_point(int iterations, bool converged) const {
    const Point<N> x = (squares_.array() * p_.array() / (squares_.array() + lambda_)).matrix();
    const double level = (x.array().square() / squares_.array()).sum();
    return {x / std::sqrt(level), iterations, converged};
  }

  const Point<N> p_, squares_, weights_;  // a_i^2, a_i^2 p_i^2
  const DominantTermOptions options_;
  Eigen::Index thin_ = 0;
  double shortest_ = 0.0, least_ = 0.0;
  double lambda_ = 0.0, before_ = 0.0;
  int term_ = 0, steady_ = 0;
};

template <int N>
[[nodiscard]] NearestPoint<N> nearest_by_dominant_term(const Point<N>& axes, const Point<N>& p,
                                                       const DominantTermOptions& options = {}) {
  return DominantTerm<N>(axes, p, options).solve();
}

}  // namespace clearance::bench
