// The tick on the shipped cells, in their simulated motion.
//
// Oracle: a new query for every pair of parts, without tracking, triage or a motion bound.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/cell/cell_file.hpp"
#include "config/cell/simulation.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/fresh_distance.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/places.hpp"

namespace clearance {
namespace {

using test::kStart;

Cell shipped(const std::string& name) {
  const CellResult read =
      read_cell(std::filesystem::path(test::places::sources()) / "config/cells" / name);
  return std::get<Cell>(read);
}

// A cell in its simulated motion.
class SimulatedCell {
 public:
  explicit SimulatedCell(const std::string& name) : cell(shipped(name)) {
    for (const Object& object : scene.objects)
      world_from_object_.push_back(object.world_from_object);
  }

  const Report& tick(Monitor& monitor, double t_s) {
    poses_at(cell.simulation, t_s, poses_);
    const std::int64_t now_ns = kStart + std::llround(t_s * 1e9);
    samples_.clear();
    for (const PoseAt& pose : poses_) {
      world_from_object_[pose.object] = pose.world_from_object;
      samples_.push_back(test::sample(pose.object, pose.world_from_object, now_ns));
      samples_.back().twist = pose.twist;
      samples_.back().has_twist = true;
    }
    return monitor.tick(samples_, now_ns);
  }

  [[nodiscard]] test::DistanceBounds truth(std::uint32_t pair) const {
    const auto [a, b, publish] = scene.pairs[pair];
    return test::fresh_distance(scene.objects[a], world_from_object_[a], scene.objects[b],
                                world_from_object_[b]);
  }

  Cell cell;
  Scene& scene = cell.scene;

 private:
  std::vector<Pose> world_from_object_;
  std::vector<PoseAt> poses_;
  std::vector<PoseSample> samples_;
};

struct Drive {
  const char* cell;
  std::uint32_t budget;
  double step_s;
};
class ShippedCells : public testing::TestWithParam<Drive> {};

INSTANTIATE_TEST_SUITE_P(
    Monitor, ShippedCells,
    testing::Values(Drive{"mcintyre.yaml", 100, 0.1}, Drive{"mcintyre.yaml", 5, 0.001},
                    Drive{"mcintyre.yaml", 5, 0.1}, Drive{"two_arms.yaml", 2000, 0.1},
                    Drive{"two_arms.yaml", 150, 0.001}, Drive{"two_arms.yaml", 150, 0.1},
                    Drive{"round_arm.yaml", 400, 0.1}, Drive{"round_arm.yaml", 140, 0.001},
                    Drive{"round_arm.yaml", 140, 0.1}));

TEST_P(ShippedCells, EveryBoundHoldsAndTheProvedMinimumIsTheMinimum) {
  const Drive run = GetParam();
  SimulatedCell cell(run.cell);
  cell.scene.budget = run.budget;
  for (Object& object : cell.scene.objects) object.age_limit_ns = std::llround(2e9 * run.step_s);
  Monitor monitor(cell.scene);
  for (int t = 0; t < 60; ++t) {
    const Report& report = cell.tick(monitor, run.step_s * t);
    ASSERT_LE(report.queries, run.budget);
    ASSERT_EQ(report.evaluated + report.carried, report.pairs_total);
    test::DistanceBounds least;
    for (std::uint32_t p = 0; p < report.pairs_total; ++p) {
      const test::DistanceBounds truth = cell.truth(p);
      const PairReport pair = monitor.pair(p);
      ASSERT_LE(pair.lower, truth.upper) << "tick " << t << " pair " << p;
      ASSERT_GE(pair.upper, truth.lower) << "tick " << t << " pair " << p;
      if (pair.status == PairStatus::kConverged) {
        ASSERT_NEAR(pair.upper, truth.upper, 1e-12) << "tick " << t << " pair " << p;
        ASSERT_NEAR(pair.lower, truth.lower, 1e-12) << "tick " << t << " pair " << p;
        ASSERT_NEAR((pair.witness_b - pair.witness_a).norm(), std::abs(pair.distance), 1e-12);
      }
      least.lower = std::min(least.lower, truth.lower);
      least.upper = std::min(least.upper, truth.upper);
    }
    ASSERT_LE(report.lower_all, least.upper);
    if (report.minimum_certified) {
      ASSERT_NEAR(report.minimum.distance, least.upper, 1e-12) << "tick " << t;
    }
  }
}

TEST(Monitor, ShippedCellsHaveEveryPublishedPairEvaluatedAndEverythingProvedInEveryTick) {
  for (const char* name : {"mcintyre.yaml", "two_arms.yaml", "round_arm.yaml"}) {
    SimulatedCell cell(name);
    Monitor monitor(cell.scene);
    for (int t = 0; t < 100; ++t) {
      const Report& report = cell.tick(monitor, 0.001 * t);
      for (const PairReport& pair : report.pairs) {
        EXPECT_EQ(pair.evaluated_cycle, report.cycle) << name << " tick " << t;
      }
      for (const ZoneReport& zone : report.zones) EXPECT_TRUE(zone.certified) << name;
      EXPECT_TRUE(report.minimum_certified) << name << " tick " << t;
    }
  }
}

}  // namespace
}  // namespace clearance
