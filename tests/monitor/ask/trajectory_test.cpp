// Oracle: the same polynomials in long double, whose rounding is 2,000 times finer.
#include "monitor/ask/trajectory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::trajectory_test {
namespace {

struct Exact {
  long double position, speed, acceleration;
};

// The shoulder between its waypoints `row` and `row` + 1.
Exact exact_at(const JointTrajectory& motion, std::size_t row, long double at) {
  const long double length = static_cast<long double>(motion.times[row + 1]) - motion.times[row];
  const long double p0 = motion.positions[row], p1 = motion.positions[row + 1];
  const long double t = at - motion.times[row], rate = (p1 - p0) / length;
  if (motion.velocities.empty()) return {p0 + t * rate, rate, 0.0L};
  const long double v0 = motion.velocities[row], v1 = motion.velocities[row + 1];
  const long double b = (3.0L * rate - 2.0L * v0 - v1) / length;
  const long double c = (v0 + v1 - 2.0L * rate) / (length * length);
  return {p0 + t * (v0 + t * (b + t * c)), v0 + t * (2.0L * b + 3.0L * t * c),
          2.0L * b + 6.0L * t * c};
}

// The scales of positions and velocities differ, so that terms cancel: a joint that swings to and
// fro between two waypoints at nearly one place.
TEST(Trajectory, BoundsIncludeTheRoundingOfPolynomials) {
  const Scene scene = test::scara_cell();
  const auto shoulder = variable_named(scene, "shoulder");
  ASSERT_TRUE(shoulder);
  std::mt19937_64 engine(35);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  };
  for (int round = 0; round < 20'000; ++round) {
    Question question;
    JointTrajectory& motion = question.motion;
    motion.joints = {"shoulder"};
    double t = between(-1e3, 1e3);
    const double centre = between(-3.0, 3.0), scale = std::pow(10.0, between(-6.0, 0.5));
    for (int row = 0; row < 4; ++row) {
      motion.times.push_back(t);
      t += std::pow(10.0, between(-3.0, 1.0));
      motion.positions.push_back(centre + between(-scale, scale));
      if (round % 4 != 0) motion.velocities.push_back(between(-10.0, 10.0));
    }
    Trajectory trajectory(scene.variables.size());
    ASSERT_FALSE(trajectory.take(question, scene));
    std::vector<TrackedVariable> variables(scene.variables.size());
    std::vector<VariableBounds> bounds(scene.variables.size());
    const auto row = static_cast<std::uint32_t>(engine() % 3);
    Stretch stretch = trajectory.segment(row);
    const double a = between(stretch.from, stretch.to), b = between(stretch.from, stretch.to);
    if (round % 2 == 0) stretch = {row, row, std::min(a, b), std::max(a, b)};
    const double middle = trajectory.middle(stretch);
    trajectory.place(stretch, middle, variables, bounds);
    const VariableBounds& bound = bounds[*shoulder];
    const long double here = variables[*shoulder].position;
    const double rounding = trajectory.position_rounding();
    EXPECT_LE(std::abs(here - exact_at(motion, row, middle).position), rounding) << round;
    for (int i = 0; i < 8; ++i) {
      const double at =
          i == 0   ? stretch.from
          : i == 1 ? stretch.to
                   : std::clamp(between(stretch.from, stretch.to), stretch.from, stretch.to);
      const Exact exact = exact_at(motion, row, at);
      EXPECT_LE(std::abs(exact.position - here), bound.deviation + rounding) << round;
      EXPECT_LE(std::abs(exact.speed), bound.speed) << round;
      EXPECT_LE(std::abs(exact.acceleration), bound.acceleration) << round;
    }
  }
}

}  // namespace
}  // namespace clearance::trajectory_test
