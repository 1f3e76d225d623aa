#include "monitor/recording/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <set>

#include "monitor/files/build_info.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

TEST(Recorder, PutsWhatATickUsedInFrontOfItsReportAndNothingElse) {
  const ScratchFolder folder;
  const Cell cell{bench_cell()};
  record_run(cell, folder / "a.mcap");
  std::vector<std::pair<std::string, std::uint64_t>> since_report;
  for (const Kept& message : messages_of(folder / "a.mcap")) {
    if (message.kind == TopicKind::kPoses) {
      const auto batch = decoded<clearance_msg_PoseBatch>(message);
      since_report.emplace_back(batch->source, batch->sequence_number);
    }
    if (message.kind != TopicKind::kDistances) continue;
    const auto report = decoded<clearance_msg_Distances>(message);
    for (std::uint32_t i = 0; i < report->sources._length; ++i) {
      const clearance_msg_SourceUse& use = report->sources._buffer[i];
      EXPECT_THAT(since_report, testing::Contains(std::pair<std::string, std::uint64_t>(
                                    use.source, use.sequence_number)));
    }
    EXPECT_EQ(report->sources._length == 0, since_report.empty());
    EXPECT_EQ(report->now_ns, message.log_ns);
    since_report.clear();
  }
}

TEST(Recorder, BatchesOfLaterTicksWaitForTheirReport) {
  const ScratchFolder folder;
  const Cell cell{bench_cell()};
  const Scene& scene = cell.scene;
  Monitor monitor(scene);
  Recorder recorder(folder / "a.mcap", cell, kStart);
  const auto batch = [&scene](std::uint64_t number) {
    return PoseBatch{SourceName("arm"), number, scene.revision, {sample(0, at(0, 0, 1), kStart)}};
  };
  for (std::uint64_t number = 1; number <= 3; ++number) recorder.poses(batch(number));
  for (std::uint64_t number = 1; number <= 3; ++number) {
    const SourceUse use{SourceName("arm"), number};
    recorder.report(monitor.tick({}, kStart + static_cast<std::int64_t>(number) * kTick),
                    {&use, 1});
  }
  ASSERT_TRUE(recorder.close());
  std::string order;
  for (const Kept& message : messages_of(folder / "a.mcap")) {
    if (message.kind == TopicKind::kPoses) order += 'p';
    if (message.kind == TopicKind::kDistances) order += 'd';
  }
  EXPECT_EQ("pdpdpd", order);
}

TEST(Recorder, NamesJointsAsTheCellDidThatTheirBatchWasMadeFor) {
  const ScratchFolder folder;
  const Cell first{scara_cell()};
  Cell second{scara_cell()};
  second.scene.variables[0].name = "renamed";
  second.scene.revision = first.scene.revision + 1;
  Monitor monitor(second.scene);
  Recorder recorder(folder / "a.mcap", first, kStart);
  recorder.change(second, {.began_after = 0, .from = 1});
  std::uint64_t number = 0;
  for (const std::uint64_t revision : {first.scene.revision, second.scene.revision}) {
    PoseBatch batch{SourceName("arm"), ++number, revision, {}};
    const auto positions = joints(0.1, 0.2, 0.1, kStart);
    batch.joints.assign(positions.begin(), positions.end());
    recorder.poses(batch);
    const SourceUse use{SourceName("arm"), number};
    recorder.report(monitor.tick({}, kStart + static_cast<std::int64_t>(number) * kTick),
                    {&use, 1});
  }
  ASSERT_TRUE(recorder.close());
  std::vector<std::string> names;
  for (const Kept& message : messages_of(folder / "a.mcap")) {
    if (message.kind == TopicKind::kJointStates)
      names.emplace_back(decoded<clearance_msg_JointStates>(message)->names._buffer[0]);
  }
  EXPECT_THAT(names, testing::ElementsAre(first.scene.variables[0].name, "renamed"));
}

// A ball of 1 m/s at most near a post: it is unknown, then near, late, and near again.
TEST(Recorder, KeepsEachCauseOfAZoneThatStaysActive) {
  const ScratchFolder folder;
  Object ball = moving("ball", {test::ball(0.1)});
  ball.max_speed = 1.0;
  ball.may_jump = true;
  Cell cell{cell_of({fixed("post", {test::ball(0.1)}, at(0, 0, 0)), ball})};
  cell.scene.zones.push_back(zone_over(cell.scene, 0.3, 0.6));
  Monitor monitor(cell.scene);
  Recorder recorder(folder / "a.mcap", cell, kStart);
  std::int64_t now = kStart;
  const auto tick = [&](std::optional<double> x, std::int64_t after_ns = kTick) {
    now += after_ns;
    std::vector<PoseSample> samples;
    if (x) samples.push_back(sample(1, at(*x, 0, 0), now));
    recorder.report(monitor.tick(samples, now), {});
  };
  tick(std::nullopt);
  tick(0.45);
  tick(0.45);
  tick(0.75);  // outside of 0.3 m, and not yet of 0.6 m
  tick(0.85);
  tick(std::nullopt, 150 * kTick);
  tick(0.7);
  ASSERT_TRUE(recorder.close());
  std::vector<std::pair<std::uint64_t, ZoneCause>> causes;
  for (const Kept& message : messages_of(folder / "a.mcap")) {
    if (message.kind != TopicKind::kZones) continue;
    const auto zone = decoded<clearance_msg_ZoneState>(message);
    causes.emplace_back(zone->cycle, static_cast<ZoneCause>(zone->cause));
    EXPECT_EQ(zone->since_cycle, 1u) << zone->cycle;
  }
  EXPECT_EQ(causes, (std::vector<std::pair<std::uint64_t, ZoneCause>>{{1, ZoneCause::kUnknown},
                                                                      {2, ZoneCause::kNear},
                                                                      {6, ZoneCause::kLate},
                                                                      {7, ZoneCause::kNear}}));
}

TEST(Recorder, KeepsTheLineageOfAPartnersReport) {
  const ScratchFolder folder;
  const Cell cell{bench_cell()};
  Monitor monitor(cell.scene);
  Recorder recorder(folder / "a.mcap", cell, kStart);
  recorder.report(monitor.tick({}, kStart), {}, kStart, 7);
  recorder.report(monitor.tick({}, kStart + kTick), {});
  ASSERT_TRUE(recorder.close());
  std::vector<std::uint64_t> lineages;
  for (const Kept& message : messages_of(folder / "a.mcap")) {
    if (message.kind == TopicKind::kDistances)
      lineages.push_back(decoded<clearance_msg_Distances>(message)->lineage);
  }
  EXPECT_EQ(lineages, (std::vector<std::uint64_t>{7, 0}));
}

TEST(Recorder, CrashCostsNoMoreThanTheLastFifthOfASecond) {
  const ScratchFolder folder;
  const Cell cell{bench_cell()};
  const Scene& scene = cell.scene;
  Monitor monitor(scene);
  Recorder recorder(folder / "a.mcap", cell, kStart);
  for (int tick = 0; tick < 1000; ++tick)
    recorder.report(monitor.tick({}, kStart + tick * kTick), {});
  RecordingReader reader(folder / "a.mcap");  // while it is still being written
  RecordedMessage message;
  std::int64_t last_ns = 0;
  while (reader.next(message)) last_ns = message.log_ns;
  EXPECT_GE(last_ns, kStart + 799 * kTick);
  EXPECT_THAT(reader.error(), HasSubstr("cut off"));
}

TEST(Recorder, KeepsTheCellAndTheBuildAsMetadata) {
  const ScratchFolder folder;
  Cell cell{bench_cell()};
  cell.yaml = "name: bench\n";
  record_run(cell, folder / "a.mcap", {.ticks = 1});
  McapReader reader(folder / "a.mcap");
  ASSERT_TRUE(reader.summary());
  const McapMap& about = reader.summary()->metadata.at(std::string(kRecordingMetadata));
  EXPECT_EQ("name: bench\n", about.at("cell"));
  EXPECT_EQ("41", about.at("scene_revision"));
  EXPECT_EQ("bench", about.at("scene"));
  EXPECT_FALSE(about.at("version").empty());
  EXPECT_EQ(kBuild, about.at("build"));
  EXPECT_THAT(kBuild, testing::StartsWith(about.at("version") + ", "));
  EXPECT_THAT(kBuild, testing::Not(HasSubstr("/"))) << "a path";
}

TEST(Recorder, ExistingFileIsKept) {
  const ScratchFolder folder;
  write_text(folder / "a.mcap", "precious");
  const Cell cell{bench_cell()};
  const Recorder recorder(folder / "a.mcap", cell, kStart);
  EXPECT_THAT(recorder.error(), HasSubstr("File exists"));
  EXPECT_EQ("precious", read_text(folder / "a.mcap"));
}

// Types of this project begin with a capital letter, those of IDL do not.
std::set<std::string> types_of_members(const std::string& idl) {
  std::set<std::string> types;
  for (const std::string before : {"sequence<", "\n  "}) {
    for (std::size_t at = idl.find(before); at != std::string::npos; at = idl.find(before, at)) {
      at += before.size();
      const std::size_t end = idl.find_first_of(" ,>", at);
      if (std::isupper(static_cast<unsigned char>(idl[at]))) types.insert(idl.substr(at, end - at));
    }
  }
  return types;
}

TEST(TopicSchema, IsSelfContainedIdlOfItsTypeAndWhatThatNeeds) {
  for (const Topic& topic : kRecordedTopics) {
    const McapSchema& schema = topic_schema(topic.kind);
    EXPECT_EQ(topic.type->m_typename, schema.name);
    const std::string type = schema.name.substr(schema.name.rfind(':') + 1);
    EXPECT_THAT(schema.text, HasSubstr("struct " + type + " {"));
    EXPECT_THAT(schema.text, testing::Not(HasSubstr("//")));
    EXPECT_THAT(schema.text, testing::Not(HasSubstr("#")));
    // The text defines each of this project's types that a member has.
    for (const std::string& member : types_of_members(schema.text)) {
      EXPECT_THAT(schema.text, HasSubstr("struct " + member + " {")) << type;
    }
  }
  EXPECT_THAT(topic_schema(TopicKind::kZones).text, testing::Not(HasSubstr("struct PairDistance")));
  EXPECT_THAT(topic_schema(TopicKind::kPoses).text, HasSubstr("const unsigned long kMaxPoses"));
  EXPECT_EQ("", self_contained_idl(kIdlText, "NoSuchType"));
}

}  // namespace
}  // namespace clearance::test
