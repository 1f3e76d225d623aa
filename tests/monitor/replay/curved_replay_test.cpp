// A recorded run of the shipped cell of curved bodies, replayed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "config/cell/cell_file.hpp"
#include "config/cell/simulation.hpp"
#include "monitor/recording/recorder.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

Cell round_arm() {
  return std::get<Cell>(
      read_cell(std::filesystem::path(test::places::sources()) / "config/cells/round_arm.yaml"));
}

// Records ticks of the cell's own motion from `start_s` on, as the daemon does. Returns the least
// reported distance.
double record(const Cell& cell, const std::filesystem::path& file, double start_s, int ticks) {
  Monitor monitor(cell.scene);
  Recorder recorder(file, cell, kStart);
  std::vector<PoseAt> poses;
  double least = kInfinity;
  for (int tick = 0; tick < ticks; ++tick) {
    const std::int64_t now_ns = kStart + tick * kTick;
    poses_at(cell.simulation, start_s + 1e-9 * static_cast<double>(tick * kTick), poses);
    PoseBatch batch{
        SourceName("arm"), static_cast<std::uint64_t>(tick) + 1, cell.scene.revision, {}};
    for (const PoseAt& pose : poses) {
      batch.samples.push_back(test::sample(pose.object, pose.world_from_object, now_ns));
      batch.samples.back().twist = pose.twist;
      batch.samples.back().has_twist = true;
    }
    recorder.poses(batch);
    const Report& report = monitor.tick(batch.samples, now_ns);
    least = std::min(least, report.minimum.distance);
    const std::array uses{SourceUse{batch.source, batch.sequence_number}};
    recorder.report(report, uses);
  }
  EXPECT_TRUE(recorder.close()) << recorder.error();
  return least;
}

TEST(CurvedReplay, GivesTheRecordedReportsBitForBitAndMeetsExpectations) {
  const test::ScratchFolder folder;
  const Cell cell = round_arm();
  // The run covers the time at which the tool is nearest to the table.
  const double least = record(cell, folder / "run.mcap", 0.05, 400);
  EXPECT_GT(least, 0.02);
  const OfflineReplay same =
      replay_offline(cell, folder / "run.mcap",
                     {.compare = Comparison::kBits, .expect_min_distance = 0.99 * least});
  EXPECT_TRUE(same.ok()) << same.text();
  const OfflineReplay nearer =
      replay_offline(cell, folder / "run.mcap", {.expect_min_distance = 1.01 * least});
  EXPECT_FALSE(nearer.ok());
}

}  // namespace
}  // namespace clearance
