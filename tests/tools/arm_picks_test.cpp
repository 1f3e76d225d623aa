// The example of an arm that tells the daemon what it holds: its motion, and both runs over DDS.
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "monitor/examples/arm/motion.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

struct Picking {
  double nearest = 0.0, certified = 0.0;
  std::string moving;
};

Picking picking_of(const std::string& output, const std::string& name) {
  Picking picking;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(name + " ")) continue;
    std::istringstream figures(line.substr(name.size()));
    figures >> picking.nearest >> picking.certified >> picking.moving;
  }
  return picking;
}

// Steps are finite differences, checked at the ends and against the motion itself.
TEST(PickingArm, MovesFromRestToRestAsItsRatesSay) {
  const pick::HandPoint from{-0.5, 0.6, 0.31, 0.03}, to{0.7, 0.55, 0.5, 0.01};
  constexpr double kSeconds = 2.0;
  for (const double share : {0.0, 1.0}) {
    const pick::Step step = pick::step_between(from, to, share, kSeconds);
    const pick::Positions end = pick::positions_at(share == 0.0 ? from : to);
    for (int i = 0; i < pick::kJoints; ++i) {
      EXPECT_DOUBLE_EQ(step.positions[i], end[i]);
      EXPECT_NEAR(step.rates[i], 0.0, 1e-3);
    }
  }
  pick::Positions sum = pick::positions_at(from);
  for (int k = 0; k < 1000; ++k) {
    const pick::Step step = pick::step_between(from, to, (k + 0.5) / 1000.0, kSeconds);
    for (int i = 0; i < pick::kJoints; ++i) sum[i] += step.rates[i] * kSeconds / 1000.0;
  }
  const pick::Positions end = pick::positions_at(to);
  for (int i = 0; i < pick::kJoints; ++i) EXPECT_NEAR(sum[i], end[i], 1e-5) << i;
}

TEST(PickingArm, IsNearerToTheWallOnceTheDaemonKnowsThePart) {
  const std::string cell = test::places::sources() + "/config/cells/pick.yaml";
  const DdsOptions dds = own_dds();
  ChildProcess daemon(kDaemon, with({cell}, dds_arguments(dds)));
  ChildProcess arm(test::places::programs() + "/example_arm",
                   with({"pick", cell, "--speed", "2"}, dds_arguments(dds)));
  ASSERT_EQ(arm.wait(std::chrono::seconds(180)), 0) << arm.output();
  const Picking without = picking_of(arm.output(), "not known"),
                with_it = picking_of(arm.output(), "known");
  EXPECT_NEAR(without.nearest, 0.11, 1e-3) << arm.output();
  EXPECT_EQ(with_it.moving, "part") << arm.output();
  // The part stands 90 mm out of the fingertips.
  EXPECT_NEAR(with_it.nearest, without.nearest - 0.09, 1e-3) << arm.output();
  EXPECT_LE(with_it.certified, with_it.nearest) << arm.output();
}

}  // namespace
}  // namespace clearance::test
