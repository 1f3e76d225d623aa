// Stops of robots, against machines that stop.
//
// Oracle: that of stopping_machine.hpp.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <vector>

#include "tests/monitor/ask/stopping_machine.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::first_seed, test::Judged, test::StoppingMachine;

constexpr int kPostures = 24;  // of a cell

const test::RecordedMotion& motion() {
  static const test::RecordedMotion read(std::getenv("CLEARANCE_STOPS_MOTION"));
  return read;
}

// From the share of the speed that the report states, down to the margins of the cell.
void obey(const Scene& scene, StoppingMachine& machine, const Report& report, Judged& to) {
  std::vector<double> shares;
  for (const RobotStop& stop : report.stops) shares.push_back(stop.scaling);
  machine.stop(
      shares, [&](std::uint32_t pair) { return test::margin_of(scene, pair); }, to);
}

// Calls stop(scene, machine, report, judged) in postures of a cell.
template <class Stop>
Judged judge_cell(std::uint64_t seed, const Stop& stop, double late = 0.0) {
  const test::DrawnArms arms = test::drawn_arms(seed, true);
  StoppingMachine machine(arms, seed, motion(), late);
  Judged judged;
  for (int i = 0; i < kPostures; ++i) {
    const Report& report = machine.tick(0.1 * (1 + i % 8));
    for (std::uint64_t k = 0; k < repeats(20); ++k) stop(arms.scene, machine, report, judged);
  }
  return judged;
}
template <class Stop>
Judged judge_cells(std::uint64_t cells, const Stop& stop) {
  Judged all;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + repeats(cells); ++seed) {
    const Judged judged = judge_cell(seed, stop);
    EXPECT_EQ(judged.nearer, 0u) << "seed " << seed << ", " << judged.least_left << " m, "
                                 << judged.worst;
    all.add(judged);
  }
  if (std::getenv("CLEARANCE_STOPS_SHOW") != nullptr)
    std::cout << all.stops << " stops, " << all.slowed << " from a lower speed, " << all.distances
              << " distances, the least " << all.least_left << " m above its margin, " << all.worst
              << "\n";
  return all;
}

TEST(StopsOfRobots, AreNeverNearerThanTheBoundUntilTheyStand) {
  const Judged judged = judge_cells(
      16, [](const Scene& scene, StoppingMachine& machine, const Report& report, Judged& to) {
        std::vector<double> bounds(scene.pairs.size(), -kInfinity);
        for (const PairReport& pair : report.pairs)
          if (pair.stop_lower > 0.0) bounds[pair.pair] = pair.stop_lower;
        machine.stop(
            {1.0, 1.0}, [&](std::uint32_t pair) { return bounds[pair]; }, to);
      });
  EXPECT_GT(judged.stops, 500u);
}

// CLEARANCE_STOPS_SEED: the first of the cells. CLEARANCE_STOPS_MOTION: a file whose postures and
// velocities the arms have. CLEARANCE_STOPS_SHOW prints how many stops there were.
TEST(StopsOfRobots, FromTheStatedShareOfTheSpeedKeepTheMargins) {
  const Judged judged = judge_cells(80, obey);
  EXPECT_GT(judged.stops, 1'000u);
  EXPECT_GT(judged.slowed, 10u);
}

TEST(StopsOfRobots, ComeNearerIfTheBrakesActLaterThanStated) {
  Judged judged;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) judged.add(judge_cell(seed, obey, 0.06));
  EXPECT_GT(judged.nearer, 0u);
}

}  // namespace
}  // namespace clearance
