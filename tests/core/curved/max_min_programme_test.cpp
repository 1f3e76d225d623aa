// The max-min programme of a step. Oracles: the Karush-Kuhn-Tucker equations solved for every
// subset of the functions, and a check that no other displacement is better.
#include "core/curved/max_min_programme.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using Functions = std::array<PlaneFunction, 5>;

double least_at(const Functions& f, std::size_t count, const PlaneMatrix& q, const Vec2& s) {
  double least = kInfinity;
  for (std::size_t i = 0; i < count; ++i) {
    least = std::min(least, f[i].value + f[i].slope.dot(s) - 0.5 * s.dot(q * s));
  }
  return least;
}

// Solves the equations of a subset: Q s = sum w_i slope_i, sum w_i = 1, and value_i + slope_i.s
// equal for all i. The result is the least of all functions at s, provided that no weight is
// negative.
double best_of_subset(const Functions& f, const std::vector<std::size_t>& subset, std::size_t count,
                      const PlaneMatrix& q) {
  const auto n = static_cast<Eigen::Index>(subset.size());
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n + 3, n + 3);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + 3);
  m.topLeftCorner(2, 2) << q.xx, q.xy, q.xy, q.yy;
  for (Eigen::Index i = 0; i < n; ++i) {
    const PlaneFunction& g = f[subset[static_cast<std::size_t>(i)]];
    m.block(0, 2 + i, 2, 1) = -g.slope;
    m(2, 2 + i) = 1.0;
    m.block(3 + i, 0, 1, 2) = g.slope.transpose();
    m(3 + i, n + 2) = -1.0;
    right[3 + i] = -g.value;
  }
  right[2] = 1.0;
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(m);
  if (!lu.isInvertible()) return -kInfinity;
  const Eigen::VectorXd x = lu.solve(right);
  if (x.segment(2, n).minCoeff() < 0.0) return -kInfinity;
  return least_at(f, count, q, Vec2(x[0], x[1]));
}

double best_of_all_subsets(const Functions& f, std::size_t count, const PlaneMatrix& q) {
  double best = -kInfinity;
  for (unsigned bits = 1; bits < (1u << count); ++bits) {
    std::vector<std::size_t> subset;
    for (std::size_t i = 0; i < count; ++i) {
      if (bits & (1u << i)) subset.push_back(i);
    }
    if (subset.size() <= 3) best = std::max(best, best_of_subset(f, subset, count, q));
  }
  return best;
}

struct Programme {
  Functions functions{};
  std::size_t count;
  PlaneMatrix q;
};

Programme programme_of(Random& random) {
  Programme p;
  p.count = static_cast<std::size_t>(random.integer(1, 5));
  const double x = random.log_uniform(0.01, 10), y = random.log_uniform(0.01, 10);
  p.q = {x, random.uniform(-0.9, 0.9) * std::sqrt(x * y), y};
  for (PlaneFunction& f : p.functions) {
    f = {random.uniform(-1, 1), {random.uniform(-2, 2), random.uniform(-2, 2)}};
  }
  return p;
}

TEST(MaxMinProgramme, FindsTheBestOfAllSubsets) {
  Random random(1);
  int several = 0;
  for (int k = 0; k < 3000; ++k) {
    const Programme p = programme_of(random);
    const PlaneStep step = max_min(p.functions, p.count, p.q);
    const double best = best_of_all_subsets(p.functions, p.count, p.q);
    const double size = 1.0 + std::abs(best);
    EXPECT_NEAR(step.value, best, 1e-9 * size) << k;
    EXPECT_NEAR(least_at(p.functions, p.count, p.q, step.step), best, 1e-9 * size) << k;
    several += std::count_if(step.weights.begin(), step.weights.end(),
                             [](double w) { return w > 0.0; }) == 3;
  }
  EXPECT_GT(several, 300);
}

TEST(MaxMinProgramme, HasWeightsOfSumOneWhoseMeanSlopeIsThatOfTheStep) {
  Random random(2);
  for (int k = 0; k < 3000; ++k) {
    const Programme p = programme_of(random);
    const PlaneStep step = max_min(p.functions, p.count, p.q);
    double sum = 0.0;
    Vec2 slope = Vec2::Zero();
    for (std::size_t i = 0; i < p.count; ++i) {
      EXPECT_GE(step.weights[i], 0.0);
      sum += step.weights[i];
      slope += step.weights[i] * p.functions[i].slope;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_LE((slope - p.q * step.step).norm(), 1e-9) << k;
  }
}

TEST(MaxMinProgramme, HasNoBetterStep) {
  Random random(3);
  for (int k = 0; k < 300; ++k) {
    const Programme p = programme_of(random);
    const PlaneStep step = max_min(p.functions, p.count, p.q);
    for (int i = 0; i < 100; ++i) {
      const double length = random.log_uniform(1e-4, 10.0);
      const Vec2 other = step.step + length * Vec2(random.uniform(-1, 1), random.uniform(-1, 1));
      EXPECT_LE(least_at(p.functions, p.count, p.q, other), step.value + 1e-9);
    }
  }
}

TEST(MaxMinProgramme, OfOneFunctionIsNewtonsStep) {
  const PlaneStep step = max_min({PlaneFunction{3.0, {2.0, 4.0}}}, 1, {2.0, 0.0, 4.0});
  EXPECT_LE((step.step - Vec2(1.0, 1.0)).norm(), 1e-15);
  EXPECT_NEAR(step.value, 3.0 + 0.5 * (2.0 + 4.0), 1e-15);
  EXPECT_EQ(step.weights[0], 1.0);
}

}  // namespace
}  // namespace clearance
