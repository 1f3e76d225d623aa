// The whole tick compared with oracles, on cells whose objects an adversary moves.
//
// Oracles: for capsules and spheres, the closed form in long double. For polyhedra, cold queries of
// the core about every pair, in every tick and at instants between. Longer runs of millions of
// ticks: CLEARANCE_TICKS=25000 monitor_tests --gtest_filter='*Adversaries*'.
#include "tests/monitor/adversary/adversary.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/monitor/adversary/cells.hpp"
#include "tests/monitor/adversary/judge.hpp"

namespace clearance {
namespace {

using test::Style;

int ticks_of_a_run(int usual) {
  const char* asked = std::getenv("CLEARANCE_TICKS");
  return asked != nullptr ? std::atoi(asked) : usual;
}

struct DrivenCell {
  const char* name;
  Scene (*make)(Random&);
  const test::Oracle* oracle;
  double room;          // m
  std::uint32_t ample;  // a budget that covers all queries of any tick
  int ticks;            // length of a usual run
};
std::ostream& operator<<(std::ostream& out, const DrivenCell& cell) { return out << cell.name; }

constexpr DrivenCell kThinBodies{"ThinBodies", test::thin_bodies, &test::kClosedForm, 3.0, 1000,
                                 300};
constexpr DrivenCell kCapsules{"Capsules", test::capsules, &test::kClosedForm, 2.5, 200, 400};
constexpr DrivenCell kPolyhedra{"Polyhedra", test::polyhedra, &test::kBruteForce, 1.0, 400, 60};

class Adversaries : public testing::TestWithParam<std::tuple<DrivenCell, Style, std::uint32_t>> {};

std::string name_of(const testing::TestParamInfo<Adversaries::ParamType>& info) {
  return (std::ostringstream() << std::get<1>(info.param) << "WithBudget"
                               << std::get<2>(info.param))
      .str();
}

INSTANTIATE_TEST_SUITE_P(ThinBodies, Adversaries,
                         testing::Combine(testing::Values(kThinBodies),
                                          testing::Values(Style::kCrawl, Style::kSpin,
                                                          Style::kJitter, Style::kTeleport),
                                          testing::Values(0u, 1u, 7u, 40u, 1000u)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(
    Capsules, Adversaries,
    testing::Combine(testing::Values(kCapsules),
                     testing::Values(Style::kCrawl, Style::kSpin, Style::kTeleport, Style::kDart,
                                     Style::kCrowd, Style::kAway, Style::kLate),
                     testing::Values(0u, 2u, 30u, 200u)),
    name_of);
INSTANTIATE_TEST_SUITE_P(
    Polyhedra, Adversaries,
    testing::Combine(testing::Values(kPolyhedra),
                     testing::Values(Style::kCrawl, Style::kSpin, Style::kTeleport, Style::kDart,
                                     Style::kBullets, Style::kCrowd, Style::kAway, Style::kLate,
                                     Style::kAllLate, Style::kLost),
                     testing::Values(0u, 3u, 40u, 400u)),
    name_of);

// The minimum is certified again within this number of ticks after the last fault: `refresh_s` of
// these cells.
constexpr int kAgainWithin = 200;

TEST_P(Adversaries, FindNoFalseBoundNoWrongMinimumAndNoZoneEntryMissedAndAllIsKnownAfterwards) {
  const auto [cell, style, budget] = GetParam();
  Random random(71);
  Scene scene = cell.make(random);
  scene.budget = budget;
  Monitor monitor(scene);
  test::Adversary adversary(scene, style, cell.room, 72 + budget);
  test::Judge judge(scene, *cell.oracle, style, budget == cell.ample);
  const int ticks = ticks_of_a_run(cell.ticks);
  for (int t = 0; t < ticks; ++t) {
    const Report& report = adversary.tick(monitor);
    if (!judge.accepts(report, monitor, adversary)) return;
  }
  if (budget == cell.ample && !test::falls_silent(style) && style != Style::kAway) {
    EXPECT_LE(judge.uncertain_zones(), ticks / 50)
        << "of " << 2 * ticks << " zones were entered for caution";
  }
  adversary.rest();
  bool is_certified = false;
  for (int t = 0; t < kAgainWithin && !is_certified; ++t) {
    const Report& report = adversary.tick(monitor);
    if (!judge.accepts(report, monitor, adversary)) return;
    ASSERT_EQ(report.unknown + report.stale, 0u) << t << " ticks after the last fault";
    is_certified = report.minimum_certified;
  }
  EXPECT_TRUE(is_certified || budget < 2) << "that budget refreshes too few pairs";
}

}  // namespace
}  // namespace clearance
