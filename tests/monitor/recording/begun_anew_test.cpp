// Recordings of a time that goes back, as that of a simulation does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/monitor/replay/offline_replay_run.hpp"

namespace clearance::test {
namespace {

// A hand comes near a box in ticks 500 to 520, and the time begins anew before that.
class BegunAnew : public OfflineReplayTest {
 protected:
  static constexpr int kTicks = 700;

  // Returns the files in their order. `begins_ns`: the time to which it goes back.
  std::vector<std::filesystem::path> record(const RecordingOptions& options, int back_at,
                                            std::int64_t begins_ns = kStart) {
    cell.scene.objects[0].max_speed = 1000.0;
    Monitor monitor(cell.scene);
    Recorder recorder(run, cell, kStart, options);
    for (int tick = 0; tick < kTicks; ++tick) {
      const std::int64_t now_ns =
          tick < back_at ? kStart + tick * kTick : begins_ns + (tick - back_at) * kTick;
      const auto sequence = static_cast<std::uint64_t>(tick + 1);
      const double height = tick >= 500 && tick < 520 ? 0.05 : 0.5;
      PoseBatch batch{SourceName("all"), sequence, cell.scene.revision, {}};
      batch.samples = {sample(0, at(0, 0, 0.15 + height), now_ns),
                       sample(1, at(0, 1, 0.5), now_ns)};
      recorder.poses(batch);
      const SourceUse use{batch.source, sequence};
      recorder.report(monitor.tick(batch.samples, now_ns), std::span(&use, 1));
    }
    EXPECT_TRUE(recorder.close()) << recorder.error();
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(run.parent_path()))
      found.push_back(entry.path());
    std::ranges::sort(found, {}, [](const auto& file) { return file.stem(); });
    return found;
  }
  // The cycles of the reports in a file, whose times do not go back.
  static std::vector<std::uint64_t> cycles(const std::filesystem::path& file) {
    std::vector<std::uint64_t> all;
    std::int64_t before = 0;
    for (const Kept& message : messages_of(file)) {
      EXPECT_GE(message.log_ns, std::exchange(before, message.log_ns)) << file;
      if (message.kind == TopicKind::kDistances)
        all.push_back(decoded<clearance_msg_Distances>(message)->cycle);
    }
    return all;
  }
};

TEST_F(BegunAnew, GoesOnInAnotherFileAndReplaysToTheBit) {
  const auto files = record({.overwrite = false}, 300);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0], run);
  EXPECT_EQ(cycles(files[0]).back(), 300u);
  EXPECT_EQ(cycles(files[1]).front(), 301u);
  const OfflineReplay same =
      replay_offline(cell, run, {.compare = Comparison::kBits, .continued_in = {files[1]}});
  EXPECT_TRUE(same.ok()) << same.text();
  EXPECT_EQ(same.compared, kTicks);
  EXPECT_EQ(same.last_ns - same.first_ns, (kTicks - 2) * kTick) << "it is counted on";
}

// Every tick counts, also those before the first one of the recording.
TEST_F(BegunAnew, IsJudgedUpToItsEndWhateverTimeItBeginsWith) {
  const auto files = record({.overwrite = false}, 300, kStart - 10'000 * kTick);
  ASSERT_EQ(files.size(), 2u);
  const OfflineReplay same =
      replay_offline(cell, run, {.compare = Comparison::kBits, .continued_in = {files[1]}});
  EXPECT_TRUE(same.ok()) << same.text();
  EXPECT_EQ(same.compared, kTicks);
  EXPECT_THAT(same.notes, testing::Contains(testing::HasSubstr("the time goes back")));
  const OfflineReplay near = replay_offline(
      cell, run, {.start_s = 0.45, .continued_in = {files[1]}, .expect_min_distance = 0.06});
  ASSERT_EQ(near.failures.size(), 1u);
  EXPECT_NEAR(near.failures[0].time_s, 0.499, 1e-9);
}

// What was before is not around an event.
TEST_F(BegunAnew, HasNothingFromBeforeInAFileOfAnEvent) {
  RecordingOptions options{.overwrite = false};
  options.events.around_ns = 100 * kTick;
  options.events.ring_bytes = 1 << 20;
  const auto files = record(options, 480);
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(cycles(files[0]).front(), 481u);
  EXPECT_EQ(cycles(files[0]).back(), 601u);
}

}  // namespace
}  // namespace clearance::test
