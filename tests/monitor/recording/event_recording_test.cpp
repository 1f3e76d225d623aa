// Recording by event: what a file holds, and which files go. Thinned recordings.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "monitor/files/attachments.hpp"
#include "monitor/recording/event_files.hpp"
#include "monitor/recording/event_ring.hpp"
#include "monitor/replay/side_feed.hpp"
#include "tests/monitor/replay/offline_replay_run.hpp"

namespace clearance::test {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

class EventRecording : public OfflineReplayTest {
 protected:
  static RecordingOptions around(int ticks) {
    RecordingOptions options{.overwrite = false};
    options.events.around_ns = ticks * kTick;
    options.events.ring_bytes = 1 << 20;
    return options;
  }
  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(run.parent_path()))
      found.push_back(entry.path());
    std::ranges::sort(found);
    return found;
  }
  // The cycles of the reports in a file.
  static std::vector<std::uint64_t> cycles(const std::filesystem::path& file) {
    std::vector<std::uint64_t> all;
    for (const Kept& message : messages_of(file)) {
      if (message.kind == TopicKind::kDistances)
        all.push_back(decoded<clearance_msg_Distances>(message)->cycle);
    }
    return all;
  }
  static std::vector<McapMap> events(const std::filesystem::path& file) {
    std::vector<McapMap> all;
    for (const McapMetadata& found : read_metadata(file)) {
      if (found.name == kEventMetadata) all.push_back(found.values);
    }
    return all;
  }

  // A run whose hand is this far above the box at each tick.
  void run_with(const RecordingOptions& options, int ticks,
                const std::function<double(int)>& height,
                const std::function<void(int, Recorder&)>& between = {}) {
    Monitor monitor(cell.scene);
    Recorder recorder(run, cell, kStart, options);
    for (int tick = 0; tick < ticks; ++tick) {
      const std::int64_t now_ns = kStart + tick * kTick;
      const auto sequence = static_cast<std::uint64_t>(tick + 1);
      PoseBatch batch{SourceName("all"), sequence, cell.scene.revision, {}};
      batch.samples.push_back(sample(0, at(0, 0, 0.15 + height(tick)), now_ns));
      batch.samples.push_back(sample(1, at(0, 1, 0.5), now_ns));
      recorder.poses(batch);
      const SourceUse use{batch.source, sequence};
      recorder.report(monitor.tick(batch.samples, now_ns), std::span(&use, 1));
      if (between) between(tick, recorder);
    }
    EXPECT_TRUE(recorder.close()) << recorder.error();
  }
};

double far_away(int /*tick*/) { return 0.5; }

// A zone's threshold is 0.1 m to enter and 0.15 m to leave.
std::function<double(int)> near_between(int from, int to) {
  return [=](int tick) { return tick >= from && tick < to ? 0.05 : 0.5; };
}

TEST_F(EventRecording, NothingIsWrittenWhereNothingHappens) {
  run_with(around(50), 500, far_away);
  EXPECT_THAT(files(), SizeIs(0));
}

TEST_F(EventRecording, AFileHoldsTheTicksAroundTheEntryOfAZone) {
  cell.scene.objects[0].max_speed = 1000.0;
  run_with(around(100), 1000, near_between(500, 520));
  ASSERT_THAT(files(), SizeIs(1));
  const auto ticks = cycles(files()[0]);
  // Files begin at every fiftieth tick, so up to 50 more stand in front.
  EXPECT_LE(ticks.front(), 401u);
  EXPECT_GE(ticks.front(), 351u);
  EXPECT_EQ(601u, ticks.back());
  EXPECT_EQ(ticks.back() - ticks.front() + 1, ticks.size());
  const auto happened = events(files()[0]);
  ASSERT_THAT(happened, SizeIs(1));
  EXPECT_EQ("zone", happened[0].at("cause"));
  EXPECT_EQ(std::to_string(kStart + 500 * kTick), happened[0].at("t_ns"));
}

// A frame every ten ticks, in front of its report.
TEST_F(EventRecording, AFileHoldsTheFramesOfSensorsAroundTheEvent) {
  cell.scene.objects[0].max_speed = 1000.0;
  CdrEncoder encoder;
  const auto add_frame = [&](int tick, Recorder& recorder) {
    if (tick % 10 != 9) return;
    Sample<clearance_msg_SensorFrame> frame;
    frame->stamp_ns = kStart + tick * kTick;
    recorder.frame(frame->stamp_ns, encoder.encode(*frame));
  };
  run_with(around(100), 1000, near_between(500, 520), add_frame);
  ASSERT_THAT(files(), SizeIs(1));
  const auto ticks = cycles(files()[0]);
  FrameFeed feed(files());
  std::vector<std::int64_t> stamps;
  for (; const clearance_msg_SensorFrame* const frame = feed.front(); feed.pop())
    stamps.push_back(frame->stamp_ns);
  std::vector<std::int64_t> expected;
  for (int tick = 9; tick < 1000; tick += 10) {  // it is recorded with the report of the next tick
    const auto cycle = static_cast<std::uint64_t>(tick + 2);
    if (cycle >= ticks.front() && cycle <= ticks.back()) expected.push_back(kStart + tick * kTick);
  }
  EXPECT_GE(expected.size(), 20u);
  EXPECT_EQ(stamps, expected);
}

TEST_F(EventRecording, AFileStandsAloneAndItsReplayAgrees) {
  cell.scene.objects[0].max_speed = 1000.0;
  run_with(around(100), 1000, near_between(500, 520));
  ASSERT_THAT(files(), SizeIs(1));
  const OfflineReplay replayed = replay_offline(cell, files()[0], {.compare = Comparison::kBounds});
  EXPECT_TRUE(replayed.ok()) << replayed.text();
  EXPECT_EQ(replayed.ticks, replayed.compared);
  // Every zone is stated once in front, then only its changes.
  std::vector<bool> states;
  for (const Kept& message : messages_of(files()[0])) {
    if (message.kind == TopicKind::kZones)
      states.push_back(decoded<clearance_msg_ZoneState>(message)->active);
  }
  EXPECT_THAT(states, ElementsAre(false, true, false));
}

TEST_F(EventRecording, AFileThatReachesBackToTheFirstTickReplaysToTheBit) {
  run_with(around(2000), 700, near_between(500, 520));
  ASSERT_THAT(files(), SizeIs(1));
  const OfflineReplay same = replay_offline(cell, files()[0], {.compare = Comparison::kBits});
  EXPECT_TRUE(same.ok()) << same.text();
  EXPECT_EQ(700u, same.compared);
}

TEST_F(EventRecording, EventsThatOverlapAreInOneFile) {
  cell.scene.objects[0].max_speed = 1000.0;
  run_with(around(100), 1000, [](int tick) {
    return (tick >= 400 && tick < 410) || (tick >= 460 && tick < 470) ? 0.05 : 0.5;
  });
  ASSERT_THAT(files(), SizeIs(1));
  EXPECT_EQ(561u, cycles(files()[0]).back());
  EXPECT_THAT(events(files()[0]), SizeIs(2));
}

TEST_F(EventRecording, EventsFarFromEachOtherHaveAFileEach) {
  cell.scene.objects[0].max_speed = 1000.0;
  run_with(around(100), 1500, [](int tick) {
    return (tick >= 300 && tick < 310) || (tick >= 450 && tick < 460) ? 0.05 : 0.5;
  });
  ASSERT_THAT(files(), SizeIs(2));
  EXPECT_EQ(401u, cycles(files()[0]).back());
  // The second one repeats what was before its event, so it stands alone.
  EXPECT_LE(cycles(files()[1]).front(), 351u);
  for (const auto& file : files()) {
    const OfflineReplay replayed = replay_offline(cell, file, {.compare = Comparison::kBounds});
    EXPECT_TRUE(replayed.ok()) << replayed.text();
  }
}

TEST_F(EventRecording, SilenceIsAFault) {
  RecordingOptions options = around(50);
  Monitor monitor(cell.scene);
  {
    Recorder recorder(run, cell, kStart, options);
    for (int tick = 0; tick < 400; ++tick) {
      const std::int64_t now_ns = kStart + tick * kTick;
      std::vector<PoseSample> samples;
      std::vector<SourceUse> uses;
      if (tick < 200) {
        const auto sequence = static_cast<std::uint64_t>(tick + 1);
        PoseBatch batch{SourceName("all"), sequence, cell.scene.revision, {}};
        batch.samples = {sample(0, at(0, 0, 0.65), now_ns), sample(1, at(0, 1, 0.5), now_ns)};
        samples = batch.samples;
        recorder.poses(batch);
        uses.push_back({batch.source, sequence});
      }
      recorder.report(monitor.tick(samples, now_ns), uses);
    }
    EXPECT_TRUE(recorder.close());
  }
  ASSERT_GE(files().size(), 1u);
  EXPECT_EQ("fault", events(files()[0]).at(0).at("cause"));
}

TEST_F(EventRecording, ACommandIsAnEvent) {
  run_with(around(50), 400, far_away, [](int tick, Recorder& recorder) {
    if (tick == 199) recorder.ask_for_file({RecordedEvent::Cause::kCommand, "a command came"});
  });
  ASSERT_THAT(files(), SizeIs(1));
  EXPECT_EQ("command", events(files()[0]).at(0).at("cause"));
  EXPECT_EQ(251u, cycles(files()[0]).back());
}

TEST_F(EventRecording, TheOldestOwnFilesGoWhenThereAreTooManyBytes) {
  const auto put = [this](const std::string& name, std::size_t bytes) {
    std::ofstream(folder / name) << std::string(bytes, 'x');
  };
  put("run-20200101T000000.000Z.mcap", 5000);
  put("run-20200102T000000.000Z.mcap", 5000);
  put("run-20200103T000000.000Z.mcap", 5000);
  put("run-2.mcap", 5000);                       // not by event
  put("other-20200101T000000.000Z.mcap", 5000);  // of another recording
  put("run-20200101T000000.000Z.mcap.bak", 5000);
  std::filesystem::create_symlink(folder / "run-2.mcap", folder / "run-20190101T000000.000Z.mcap");
  RecordingOptions options = around(50);
  options.events.keep_bytes = 11'000;
  { const EventFiles recording(run, cell.topics, options); }
  std::vector<std::string> names;
  for (const auto& file : files()) names.push_back(file.filename());
  EXPECT_THAT(names,
              ElementsAre("other-20200101T000000.000Z.mcap", "run-2.mcap",
                          "run-20190101T000000.000Z.mcap", "run-20200101T000000.000Z.mcap.bak",
                          "run-20200102T000000.000Z.mcap", "run-20200103T000000.000Z.mcap"));
}

// An event that never ends: the zone stays near.
TEST_F(EventRecording, AnEventWithoutAnEndStaysWithinTheCapInFilesThatStandAlone) {
  cell.scene.objects[0].max_speed = 1000.0;
  RecordingOptions options = around(5000);
  options.compress = false;
  options.events.keep_bytes = 400'000;
  options.events.ring_bytes = 20'000;
  std::uint64_t most = 0;
  const auto look = [&](int /*tick*/, Recorder& recorder) {
    recorder.check();
    std::uint64_t total = 0;
    for (const auto& file : files()) total += std::filesystem::file_size(file);
    most = std::max(most, total);
  };
  run_with(options, 4000, near_between(500, 3900), look);
  EXPECT_LE(most, 400'000u + 100'000u) << "the cap, and the file that is written";
  ASSERT_GE(files().size(), 3u);
  std::vector<std::filesystem::path> in_order = files();
  std::ranges::sort(in_order, {}, [](const auto& file) { return cycles(file).front(); });
  EXPECT_EQ(4000u, cycles(in_order.back()).back());
  for (std::size_t i = 0; i < in_order.size(); ++i) {
    if (i > 0) {
      EXPECT_EQ(cycles(in_order[i - 1]).back() + 1, cycles(in_order[i]).front());
    }
    const OfflineReplay alone = replay_offline(cell, in_order[i], {.compare = Comparison::kBounds});
    EXPECT_TRUE(alone.ok()) << in_order[i] << alone.text();
    const auto is_zone = [](const Kept& message) { return message.kind == TopicKind::kZones; };
    EXPECT_TRUE(std::ranges::any_of(messages_of(in_order[i]), is_zone)) << "states no zone";
  }
}

TEST_F(EventRecording, WithoutAStatedCapItIsATenthOfTheFreeDiskAndOwnFiles) {
  const EventOptions events = around(50).events;
  const auto tenth = [this] {
    return static_cast<double>(std::filesystem::space(run.parent_path()).available) / 10;
  };
  EXPECT_NEAR(tenth(), static_cast<double>(event_cap(run, events)), 0.2 * tenth());
  const auto old = folder / "run-20200101T000000.000Z-3.mcap";
  std::ofstream(old) << "x";
  std::filesystem::resize_file(old, 1'000'000'000'000);  // has no blocks: the disk is as free
  EXPECT_NEAR(tenth() + 1e11, static_cast<double>(event_cap(run, events)), 0.2 * tenth());
  EventOptions stated = events;
  for (const std::uint64_t bytes : {0, 1, 123'456}) {
    stated.keep_bytes = bytes;
    EXPECT_EQ(bytes, event_cap(run, stated));
  }
}

TEST_F(EventRecording, FilesThatContinueAnotherGoByTheirNumberAfterIt) {
  for (const char* const number : {"", "-2", "-10", "-9", "-1", "-x", "-2x"})
    std::ofstream(folder / fmt::format("run-20200101T000000.000Z{}.mcap", number))
        << std::string(1000, 'x');
  RecordingOptions options = around(50);
  options.events.keep_bytes = 1000;
  { const EventFiles recording(run, cell.topics, options); }
  std::vector<std::string> names;
  for (const auto& file : files()) names.push_back(file.filename());
  EXPECT_THAT(names, testing::UnorderedElementsAre(
                         "run-20200101T000000.000Z-10.mcap", "run-20200101T000000.000Z-1.mcap",
                         "run-20200101T000000.000Z-x.mcap", "run-20200101T000000.000Z-2x.mcap"));
}

TEST_F(EventRecording, FilesOfEventsThatAreTooOldGo) {
  for (const char* const name : {"run-20200101T000000.000Z.mcap", "run-20200102T000000.000Z.mcap"})
    std::ofstream(folder / name) << "x";
  std::filesystem::last_write_time(
      folder / "run-20200102T000000.000Z.mcap",
      std::filesystem::file_time_type::clock::now() - std::chrono::hours(3));
  RecordingOptions options = around(50);
  options.events.keep_ns = 7'200'000'000'000;
  { const EventFiles recording(run, cell.topics, options); }
  ASSERT_THAT(files(), SizeIs(1));
  EXPECT_EQ("run-20200101T000000.000Z.mcap", files()[0].filename());
}

TEST_F(EventRecording, AFolderThatIsMissingIsAnErrorAtTheStart) {
  const EventFiles recording(folder / "none" / "run.mcap", cell.topics, around(50));
  EXPECT_FALSE(recording.ok());
  EXPECT_THAT(recording.error(), testing::HasSubstr("none"));
}

TEST_F(EventRecording, ARingThatIsTooSmallShortensTheTimeBefore) {
  cell.scene.objects[0].max_speed = 1000.0;
  RecordingOptions options = around(400);
  options.events.ring_bytes = 200'000;
  run_with(options, 1000, near_between(500, 520));
  ASSERT_THAT(files(), SizeIs(1));
  const auto ticks = cycles(files()[0]);
  EXPECT_GT(ticks.front(), 101u);
  EXPECT_LT(ticks.front(), 500u);
  EXPECT_EQ(901u, ticks.back());
  EXPECT_TRUE(replay_offline(cell, files()[0], {.compare = Comparison::kBounds}).ok());
}

// The oracle is a list of all messages. Sizes are random, up to a third of the ring.
TEST(EventRing, HoldsTheNewestGroupsInOrder) {
  Random random(7);
  EventRing ring(30'000);
  std::vector<std::vector<std::byte>> all;
  std::vector<bool> starts;
  for (int i = 0; i < 5000; ++i) {
    const auto size = static_cast<std::size_t>(random.uniform(0.0, 3000.0));
    all.emplace_back(size, static_cast<std::byte>(i));
    starts.push_back(i % 5 == 0);
    ring.put(
        {.is_start = starts.back(), .scene = static_cast<std::uint32_t>(i), .cdr = all.back()});
    std::vector<std::uint32_t> kept;
    std::size_t bytes = 0;
    ring.for_each([&](const RingMessage& message) {
      kept.push_back(message.scene);
      bytes += message.cdr.size();
      ASSERT_TRUE(std::ranges::equal(all[message.scene], message.cdr));
    });
    ASSERT_FALSE(kept.empty());
    ASSERT_TRUE(starts[kept.front()]);
    ASSERT_EQ(static_cast<std::uint32_t>(i), kept.back());
    for (std::size_t k = 1; k < kept.size(); ++k) ASSERT_EQ(kept[k - 1] + 1, kept[k]);
    if (i > 100) {
      ASSERT_GE(bytes + 5 * 3000 + 3000 + 30 * 40, 30'000u) << "it dropped more than it had to";
    }
  }
}

TEST(EventRing, AMessageThatIsLargerThanTheRingEmptiesItUpToTheNextStart) {
  EventRing ring(4096);
  const std::vector<std::byte> small(100), huge(5000);
  ring.put({.is_start = true, .cdr = small});
  ring.put({.is_start = false, .cdr = huge});
  EXPECT_TRUE(ring.empty());
  ring.put({.is_start = false, .cdr = small});
  EXPECT_TRUE(ring.empty());
  ring.put({.is_start = true, .cdr = small});
  EXPECT_FALSE(ring.empty());
}

TEST_F(EventRecording, AThinnedRecordingKeepsTheNewestBatchesAndEveryZoneChange) {
  cell.scene.objects[0].max_speed = 1000.0;
  RecordingOptions options{.overwrite = true};
  options.ticks_every = 50;
  run_with(options, 1000, near_between(510, 520));
  const auto ticks = cycles(run);
  ASSERT_THAT(ticks, SizeIs(20));
  for (std::size_t i = 0; i < ticks.size(); ++i) EXPECT_EQ(50 * (i + 1), ticks[i]);
  std::size_t batches = 0, zones = 0;
  for (const Kept& message : messages_of(run)) {
    if (message.kind == TopicKind::kPoses) {
      ++batches;
      EXPECT_EQ(0u, decoded<clearance_msg_PoseBatch>(message)->sequence_number % 50);
    }
    zones += message.kind == TopicKind::kZones;
  }
  EXPECT_EQ(20u, batches);
  EXPECT_EQ(3u, zones);
  const OfflineReplay replayed = replay({});
  EXPECT_TRUE(replayed.ok()) << replayed.text();
  EXPECT_EQ(20u, replayed.ticks);
}

}  // namespace
}  // namespace clearance::test
