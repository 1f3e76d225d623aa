#include "tools/bench/thesis/chapter5/point_families.hpp"

#include <cmath>

#include "tools/bench/random.hpp"
#include "tools/bench/thesis/chapter5/digits50.hpp"

namespace clearance::bench {
namespace {

double sign(Random& random) { return random.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0; }
double power(Random& random, double low, double high) {
  return std::pow(10.0, random.uniform(low, high));
}

// (5.1.9).
PointCase drawn(Random& random) {
  const double longest = random.uniform(1.0, 100.0), shortest = random.uniform(0.1, 1.0);
  const double x = random.uniform(-100.0, 100.0), y = random.uniform(-100.0, 100.0);
  return {{longest, 1.0, shortest}, {x, y, random.uniform(-100.0, 100.0)}, 0.0};
}

PointCase of_family(const std::string& family, int k, Random& random) {
  PointCase c = drawn(random);
  const Vec3 on_surface = c.axes.cwiseProduct(random.direction());
  if (family == "ratios") {
    const double ratio = power(random, 0.0, 6.0);
    c.axes = {ratio, k % 2 == 0 ? 1.0 : ratio, 1.0};
    for (int i = 0; i < 3; ++i) c.p[i] = random.uniform(-2.0, 2.0) * c.axes[i];
  } else if (family == "surface") {
    c.p = (1.0 + sign(random) * power(random, -16.0, -3.0)) * on_surface;
  } else if (family == "inside") {
    c.p = random.uniform(0.0, 1.0) * on_surface;
  } else if (family == "centre") {
    for (int i = 0; i < 3; ++i) c.p[i] = sign(random) * power(random, -12.0, -2.0) * c.axes[i];
  } else if (family == "axes") {
    c.p = random.uniform(-2.0, 2.0) * c.axes[k % 3] * Vec3::Unit(k % 3);
  }
  return c;
}

}  // namespace

std::vector<PointCase> point_cases(const std::string& family) {
  constexpr int kCases = 1000;
  Random random(51);
  std::vector<PointCase> cases;
  for (int k = 0; k < kCases; ++k) {
    cases.push_back(of_family(family, k, random));
    cases.back().distance = true_nearest(cases.back().axes, cases.back().p).distance;
  }
  return cases;
}

}  // namespace clearance::bench
