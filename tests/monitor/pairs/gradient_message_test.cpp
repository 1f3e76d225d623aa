// Gradients on the wire, in a recording and in its replay.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "monitor/recording/recorder.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/replay/report_recorder.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/gradient_message.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::test {
namespace {

Scene scara_with_gradients() {
  Scene scene = scara_cell();
  scene.gradients = true;
  return scene;
}

TEST(GradientMessages, HoldTheReportsNumbersByPairAndJoint) {
  const Scene scene = scara_with_gradients();
  Monitor monitor(scene);
  const Report& report = monitor.tick({}, joints(0.3, 0.5, 0.1, kStart), kStart);
  GradientMessage message(scene);
  Sample<clearance_msg_Gradients> came;
  CdrEncoder encoder;
  ASSERT_TRUE(CdrDecoder().decode(encoder.encode(message.of(report, 7)), came));
  EXPECT_EQ(came->cycle, 1u);
  EXPECT_EQ(came->publish_ns, 7);
  const GradientRows rows = gradient_rows(scene);
  ASSERT_EQ(came->pairs._length, rows.rows.size());
  ASSERT_GT(rows.rows.size(), 3u);
  for (std::uint32_t r = 0; r < came->pairs._length; ++r) {
    const clearance_msg_PairGradient& pair = came->pairs._buffer[r];
    const GradientRow& row = rows.rows[r];
    EXPECT_EQ(pair.pair, report.pairs[row.published].pair);
    EXPECT_EQ(pair.distance, report.pairs[row.published].distance);
    ASSERT_EQ(pair.joints._length, row.end - row.first);
    for (std::uint32_t i = 0; i < pair.joints._length; ++i) {
      EXPECT_EQ(pair.joints._buffer[i].joint, rows.variables[row.first + i]);
      EXPECT_EQ(pair.joints._buffer[i].rate, report.gradients.rates[row.first + i]);
    }
  }
}

std::vector<std::string> gradients_in(const std::filesystem::path& file) {
  std::vector<std::string> found;
  for (const Kept& message : messages_of(file)) {
    if (message.kind != TopicKind::kGradients) continue;
    found.emplace_back(reinterpret_cast<const char*>(message.cdr.data()), message.cdr.size());
  }
  return found;
}

TEST(GradientMessages, AReplayMakesWhatWasRecorded) {
  const Scene scene = scara_with_gradients();
  const ScratchFolder folder;
  Monitor monitor(scene);
  const Cell cell{scene};
  Recorder recorder(folder / "run.mcap", cell, kStart);
  for (int tick = 0; tick < 100; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const auto sent = joints(std::sin(0.01 * tick), 0.002 * tick, 0.1, now);
    PoseBatch batch{SourceName("arm"), static_cast<std::uint64_t>(tick + 1), 0, {}};
    batch.joints.assign(sent.begin(), sent.end());
    recorder.poses(batch);
    recorder.report(monitor.tick({}, sent, now),
                    std::array{SourceUse{batch.source, batch.sequence_number}});
  }
  ASSERT_TRUE(recorder.close()) << recorder.error();
  ReportRecorder again(folder / "again.mcap", cell);
  const OfflineReplay replay = replay_offline(cell, folder / "run.mcap", {},
                                              [&](const ReplayedTick& tick) { again.add(tick); });
  ASSERT_TRUE(replay.ok()) << replay.text();
  ASSERT_TRUE(again.close());
  const auto recorded = gradients_in(folder / "run.mcap");
  EXPECT_EQ(recorded.size(), 100u);
  EXPECT_EQ(recorded, gradients_in(folder / "again.mcap"));
}

}  // namespace
}  // namespace clearance::test
