// The example of an avoiding arm beside the daemon, and the quadratic programme that its controller
// solves.
#include <gtest/gtest.h>

#include <sstream>

#include "monitor/examples/arm/quadratic_programme.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/random.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

// The closed form for one plane: the nearest point in the metric of H, by its multiplier.
TEST(AvoidProgramme, IsTheClosedFormForOneInequality) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(
        4, 4, [&random](Eigen::Index, Eigen::Index) { return random.uniform(-1.0, 1.0); });
    const Eigen::MatrixXd h = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(4, 4);
    const auto any = [&random](Eigen::Index) { return random.uniform(-1.0, 1.0); };
    const Eigen::VectorXd f = Eigen::VectorXd::NullaryExpr(4, any),
                          a = Eigen::VectorXd::NullaryExpr(4, any);
    const double b = random.uniform(-1.0, 1.0);
    const Eigen::VectorXd free = h.inverse() * f, towards = h.inverse() * a;
    const double multiplier = std::max(0.0, (b - a.dot(free)) / a.dot(towards));
    const Eigen::VectorXd x =
        avoid::minimise(h, f, {a.transpose(), Eigen::VectorXd::Constant(1, b)}, 1e9);
    EXPECT_LT((x - free - multiplier * towards).norm(), 1e-9 * (1.0 + x.norm()));
  }
}

TEST(AvoidProgramme, MeetsEveryInequalityWhereThatIsPossibleAndSplitsWhereItIsNot) {
  const Eigen::MatrixXd h = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::VectorXd f = Eigen::Vector2d(3.0, 4.0);
  avoid::Inequalities box{Eigen::MatrixXd(4, 2), Eigen::VectorXd(4)};
  box.a << 1, 0, 0, 1, -1, 0, 0, -1;
  box.b << -1, -1, -1, -1;
  const Eigen::VectorXd corner = avoid::minimise(h, f, box, 1e6);
  EXPECT_LT((corner - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-9);
  // The constraints x >= 1 and x <= -1 have the same penalty, so neither prevails.
  const avoid::Inequalities never{Eigen::MatrixXd{{1.0, 0.0}, {-1.0, 0.0}},
                                  Eigen::Vector2d(1.0, 1.0)};
  const Eigen::VectorXd between = avoid::minimise(h, Eigen::Vector2d::Zero(), never, 10.0);
  EXPECT_LE(std::abs(between[0]), 1.0 + 1e-9);
  EXPECT_NEAR(between[1], 0.0, 1e-12);
}

struct Outcome {
  double nearest = 0.0, mean_error = 0.0, largest_error = 0.0;  // m
};

// Parses the line that begins with `name`.
Outcome outcome_of(const std::string& output, const std::string& name) {
  std::istringstream lines(output);
  Outcome outcome;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(name)) continue;
    std::istringstream figures(line.substr(name.size()));
    std::string slash;
    figures >> outcome.nearest >> outcome.mean_error >> slash >> outcome.largest_error;
  }
  return outcome;
}

TEST(AvoidingArm, KeepsFartherFromMovingObstaclesAndStaysNearItsPath) {
  const std::string cell = test::places::sources() + "/config/cells/avoid.yaml";
  const DdsOptions dds = own_dds();
  ChildProcess daemon(kDaemon, with({cell}, dds_arguments(dds)));
  ChildProcess avoid(test::places::programs() + "/example_arm",
                     with({"avoid", cell, "--seconds", "5"}, dds_arguments(dds)));
  ASSERT_EQ(avoid.wait(std::chrono::seconds(120)), 0) << avoid.output();
  const Outcome without = outcome_of(avoid.output(), "without avoidance"),
                with_it = outcome_of(avoid.output(), "with avoidance");
  EXPECT_LT(without.mean_error, 0.01);
  EXPECT_LT(without.nearest, 0.04) << "the task alone meets nothing: " << avoid.output();
  EXPECT_GT(with_it.nearest, without.nearest + 0.02) << avoid.output();
  EXPECT_LT(with_it.largest_error, 0.05) << avoid.output();
}

}  // namespace
}  // namespace clearance::test
