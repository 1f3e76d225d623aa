#include "config/write/warehouse_cell.hpp"

#include <gtest/gtest.h>

#include <variant>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/shared/simulated_samples.hpp"

namespace clearance {
namespace {

Cell cell_of(const WarehouseOptions& options) {
  CellResult result = parse_cell(warehouse_cell(options), "warehouse.yaml");
  if (const auto* errors = std::get_if<std::vector<CellError>>(&result)) {
    ADD_FAILURE() << options.objects << " objects: " << errors->front().text;
    return {};
  }
  return std::get<Cell>(std::move(result));
}

TEST(WarehouseCell, HasAsManyObjectsAsAskedForAndIsAGoodCell) {
  for (const std::uint32_t objects : {kLeastWarehouse, 61u, 127u, 300u, 1000u}) {
    const Cell cell = cell_of({.objects = objects});
    const Scene& scene = cell.scene;
    EXPECT_EQ(scene.objects.size(), objects);
    std::vector<PoseAt> poses;
    poses_at(cell.simulation, 0.0, poses);
    std::size_t moving = 0;
    for (const Object& object : scene.objects) moving += !object.fixed;
    EXPECT_EQ(poses.size(), moving) << "whatever moves is in the simulation, once";
  }
}

TEST(WarehouseCell, IsTheSameForTheSameSeedOnly) {
  EXPECT_EQ(warehouse_cell({.objects = 200, .seed = 7}),
            warehouse_cell({.objects = 200, .seed = 7}));
  EXPECT_NE(warehouse_cell({.objects = 200, .seed = 7}),
            warehouse_cell({.objects = 200, .seed = 8}));
}

TEST(WarehouseCell, NothingTouches) {
  for (const std::uint32_t objects : {100u, 400u}) {
    Cell cell = cell_of({.objects = objects});
    Scene& scene = cell.scene;
    scene.budget = 1'000'000;  // evaluates everything in every tick
    Monitor monitor(scene);
    for (int step = 0; step < 300; ++step) {
      const std::int64_t now = 1'000'000'000 + 100'000'000 * static_cast<std::int64_t>(step);
      const std::vector<PoseSample> samples = simulated_samples(cell.simulation, 0.1 * step, now);
      const Report& report = monitor.tick(samples, now);
      ASSERT_TRUE(report.minimum_certified);
      ASSERT_GT(report.minimum.lower, 0.01)
          << objects << " objects, " << 0.1 * step
          << " s: " << scene.objects[scene.pairs[report.minimum.pair].first].name << " and "
          << scene.objects[scene.pairs[report.minimum.pair].second].name;
    }
  }
}

}  // namespace
}  // namespace clearance
