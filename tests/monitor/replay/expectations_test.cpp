// Expectations in a user's test of a replay: a minimum distance, and zones that stay inactive.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "tests/monitor/replay/offline_replay_run.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

using ReplayExpectations = OfflineReplayTest;

constexpr double kNoCoordinate = std::numeric_limits<double>::quiet_NaN();

TEST_F(ReplayExpectations, ExpectedMinimumDistanceNamesTickPairAndFigureWhenBroken) {
  record_run(cell, run, {.nearest = 0.08});
  EXPECT_TRUE(replay({.expect_min_distance = 0.0799}).ok());
  const OfflineReplay result = replay({.expect_min_distance = 0.09});
  ASSERT_EQ(1u, result.failures.size()) << result.text();
  EXPECT_THAT(result.text(), HasSubstr("hand - box is 0.08"));
  EXPECT_THAT(result.text(), HasSubstr("at least 0.09 m expected"));
  EXPECT_GT(result.failures[0].tick.cycle, 90u);
  EXPECT_LT(result.failures[0].tick.cycle, 101u);
  EXPECT_NEAR(0.08, result.closest->distance, 1e-9);
}

TEST_F(ReplayExpectations, APairWhoseContactIsAsAllowedMayBeNearerAndNoOther) {
  scene.contacts.push_back({"lift", "", "", 0.02, {}, "", "", {1}});
  record_run(cell, run, {.nearest = -0.01});
  EXPECT_TRUE(replay({.expect_min_distance = 0.1}).ok());
  EXPECT_THAT(replay({.expect_min_distance = 2.0}).text(), HasSubstr("tool"));
  scene.contacts[0].depth = 0.005;
  record_run(cell, folder / "deeper.mcap", {.nearest = -0.01});
  run = folder / "deeper.mcap";
  const OfflineReplay deeper = replay({.expect_min_distance = 0.1});
  ASSERT_EQ(1u, deeper.failures.size()) << deeper.text();
  EXPECT_THAT(deeper.text(), HasSubstr("hand - box is -0.00"));
}

// The hand moves back and forth past the box at 1.2 m per tick. `y` is its distance from the centre
// of the box.
void record_darts(const Cell& cell, const std::filesystem::path& file, double y) {
  Monitor monitor(cell.scene);
  Recorder recorder(file, cell, kStart);
  for (int tick = 0; tick < 6; ++tick) {
    const std::int64_t now_ns = kStart + tick * kTick;
    PoseBatch batch{
        SourceName("arm"), static_cast<std::uint64_t>(tick + 1), cell.scene.revision, {}};
    batch.samples.push_back(sample(0, at(tick % 2 == 0 ? -0.6 : 0.6, y, 0), now_ns));
    batch.samples.push_back(sample(1, at(0, 3, 3), now_ns));
    recorder.poses(batch);
    recorder.report(monitor.tick(batch.samples, now_ns),
                    std::array{SourceUse{batch.source, batch.sequence_number}});
  }
  EXPECT_TRUE(recorder.close()) << recorder.error();
}

TEST_F(ReplayExpectations, WhatPassesThroughBetweenTwoTicksBreaksTheExpectedMinimumDistance) {
  record_darts(cell, run, 0.0);
  const OfflineReplay result = replay({.expect_min_distance = 0.2});
  ASSERT_EQ(1u, result.failures.size()) << result.text();
  EXPECT_EQ(2u, result.failures[0].tick.cycle);
  EXPECT_THAT(result.text(), HasSubstr("hand - box was no more than -"));
  EXPECT_THAT(result.text(),
              HasSubstr("apart between this tick and the last, at least 0.2 m expected"));
}

// The least distance is 0.45 m. The displacement of the hand alone would decide nothing.
TEST_F(ReplayExpectations, WhatPassesByBetweenTwoTicksIsLookedAtCloserBeforeItIsJudged) {
  record_darts(cell, run, 0.6);
  const OfflineReplay near = replay({.compare = Comparison::kBits, .expect_min_distance = 0.44});
  EXPECT_TRUE(near.ok()) << near.text();
  EXPECT_THAT(replay({.expect_min_distance = 0.46}).text(), HasSubstr("hand - box was no more"));
}

TEST_F(ReplayExpectations, ExpectedSilentZoneNamesTickPairAndFigureWhenBroken) {
  record_run(cell, run, {.nearest = 0.11});
  EXPECT_TRUE(replay({.expect_no_zone = {"stop"}}).ok());
  record_run(cell, folder / "near.mcap", {.nearest = 0.05});
  run = folder / "near.mcap";
  const OfflineReplay result = replay({.expect_no_zone = {"stop"}});
  ASSERT_EQ(1u, result.failures.size());
  EXPECT_THAT(result.failures[0].what,
              HasSubstr("zone 'stop' is active: hand - box has a clearance of 0.09"));
}

// The hand is 0.08 m above the box in the middle of the run, and 0.28 m in the middle of its first
// half.
TEST_F(ReplayExpectations, EachTellsItsLeastDistanceInTheWindowWhetherItIsMetOrNot) {
  record_run(cell, run, {.nearest = 0.08});
  const OfflineReplay result =
      replay({.expect_between = {{0.05, "hand", "box"}, {0.2, "box", "hand"}},
              .expect_no_zone = {"stop"}});
  ASSERT_EQ(3u, result.expectations.size());
  EXPECT_EQ("at least 0.05 m of hand - box", result.expectations[0].expectation);
  EXPECT_EQ("zone 'stop'", result.expectations[2].expectation);
  for (const ExpectationOutcome& outcome : result.expectations) EXPECT_EQ(101u, outcome.tick.cycle);
  for (const std::size_t i : {0, 1})
    EXPECT_THAT(result.expectations[i].least, HasSubstr("hand - box is 0.08 m apart (bounds 0.0"));
  EXPECT_THAT(result.expectations[2].least, HasSubstr("hand - box has a clearance of 0.08 m"));
  ASSERT_EQ(2u, result.failures.size()) << result.text();
  EXPECT_EQ("at least 0.2 m of box - hand", result.failures[0].expectation);
  EXPECT_EQ("zone 'stop'", result.failures[1].expectation);
  const OfflineReplay first =
      replay({.end_s = 0.05, .expect_between = {{0.05, "hand", "box"}}, .expect_no_zone = {}});
  ASSERT_EQ(1u, first.expectations.size());
  EXPECT_LE(first.expectations[0].tick.cycle, 51u);
  EXPECT_THAT(first.expectations[0].least, HasSubstr("hand - box is 0.28"));
}

TEST_F(ReplayExpectations, NamesWhatTheCellDoesNotHaveAndWhatWasMeant) {
  record_run(cell, run);
  const auto error = [&](const char* a, const char* b) {
    return replay({.expect_between = {{0.05, a, b}}}).error;
  };
  EXPECT_EQ("the cell has neither an object nor a group 'bax'; did you mean 'box'?",
            error("hand", "bax"));
  EXPECT_EQ("the cell has neither an object nor a group 'elsewhere'", error("elsewhere", "box"));
  EXPECT_THAT(error("hand", "hand"), HasSubstr("the cell watches no pair between 'hand' and"));
}

TEST_F(ReplayExpectations, ZoneThatTheCellLacksIsAnErrorThatNamesThoseItHas) {
  record_run(cell, run);
  EXPECT_THAT(replay({.expect_no_zone = {"halt"}}).error,
              HasSubstr("the cell has no zone 'halt'; its zones are 'stop'"));
}

TEST_F(ReplayExpectations, ExpectationsFailWhenAnObjectIsNeverSeen) {
  scene.objects.push_back(moving("ghost", {ball(0.1)}));
  scene.pairs.push_back({0, 3, false});
  record_run(cell, run);
  const OfflineReplay result = replay({.expect_min_distance = 0.01});
  ASSERT_EQ(1u, result.failures.size());
  EXPECT_THAT(result.failures[0].what, HasSubstr("never tells where 'ghost' is"));
}

// The hand and the tool send in every tick. In [silent_from, silent_to) the tool is silent or sends
// NaN. The hand is 0.3 m above the box, and from tick `sinks` on it is `sunk` above it.
struct Silence {
  int ticks = 300, silent_from = 200, silent_to = 300, sinks = 300;
  int hand_ends = 300;  // the hand is silent from this tick on
  double sunk = 0.02;   // m above the box
  bool sends_nan = false;
};

// Nothing is stated of the tool's speed, so it is anywhere once it is late.
void record_silence(Cell& cell, const std::filesystem::path& file, const Silence& run) {
  cell.scene.objects[1].max_speed = kInfinity;
  Monitor monitor(cell.scene);
  Recorder recorder(file, cell, kStart);
  for (int tick = 0; tick < run.ticks; ++tick) {
    const std::int64_t now_ns = kStart + tick * kTick;
    const bool silent = tick >= run.silent_from && tick < run.silent_to;
    PoseBatch batch{
        SourceName("arm"), static_cast<std::uint64_t>(tick + 1), cell.scene.revision, {}};
    const double height = tick < run.sinks ? 0.45 : 0.15 + run.sunk;
    if (tick < run.hand_ends) batch.samples.push_back(sample(0, at(0, 0, height), now_ns));
    if (silent && run.sends_nan)
      batch.samples.push_back(sample(1, at(kNoCoordinate, 1, 0.5), now_ns));
    if (!silent) batch.samples.push_back(sample(1, at(0, 1, 0.5), now_ns));
    recorder.poses(batch);
    recorder.report(monitor.tick(batch.samples, now_ns),
                    std::array{SourceUse{batch.source, batch.sequence_number}});
  }
  EXPECT_TRUE(recorder.close()) << recorder.error();
}

const OfflineReplayOptions kBothExpectations = [] {
  OfflineReplayOptions options;
  options.expect_min_distance = 0.05;
  options.expect_no_zone = {"stop"};
  return options;
}();

TEST_F(ReplayExpectations, ADriverThatEndsShortlyBeforeTheRecordingBreaksNothingAndIsNoted) {
  record_silence(cell, run, {});
  const OfflineReplay result = replay(kBothExpectations);
  EXPECT_TRUE(result.ok()) << result.text();
  EXPECT_THAT(result.notes, testing::Contains(HasSubstr("'tool' was late")));
}

TEST_F(ReplayExpectations, ADriverThatEndsLongBeforeTheRecordingBreaksThem) {
  record_silence(cell, run, {.ticks = 1400, .silent_to = 1400, .sinks = 1400});
  const OfflineReplay result = replay(kBothExpectations);
  ASSERT_EQ(2u, result.failures.size()) << result.text();
  EXPECT_LT(result.failures[0].tick.cycle, 300u);
  EXPECT_THAT(result.text(), HasSubstr("--end"));
  OfflineReplayOptions before = kBothExpectations;
  before.end_s = 0.5;
  EXPECT_EQ(2u, replay(before).failures.size()) << "the recording goes on for longer than 1 s";
  before.end_s = 0.15;
  EXPECT_TRUE(replay(before).ok());
}

TEST_F(ReplayExpectations, ADriverWhoseSamplesAreRefusedToTheEndHasNotEnded) {
  record_silence(cell, run, {.sends_nan = true});
  EXPECT_EQ(2u, replay(kBothExpectations).failures.size());
}

// The hand is 0.12 m above the box: inside of the zone of 0.1 m by the margins alone.
TEST_F(ReplayExpectations, AKnownPairIsInAZoneByItsMarginsAlsoAfterTheEndOfAnotherDriver) {
  scene.objects[0].margin = 0.015;
  scene.objects[2].margin = 0.015;
  record_silence(cell, run, {.sinks = 290, .sunk = 0.12});
  const OfflineReplay result = replay(kBothExpectations);
  ASSERT_EQ(1u, result.failures.size()) << result.text();
  EXPECT_EQ(291u, result.failures[0].tick.cycle);
  EXPECT_THAT(result.failures[0].what, HasSubstr("zone 'stop' is active: hand - box"));
}

TEST_F(ReplayExpectations, ADriverThatIsSilentForAWhileBreaksThemAlsoIfTheJudgementEndsMeanwhile) {
  record_silence(cell, run, {.silent_to = 299});
  EXPECT_EQ(2u, replay(kBothExpectations).failures.size());
  OfflineReplayOptions meanwhile = kBothExpectations;
  meanwhile.end_s = 0.29;
  const OfflineReplay result = replay(meanwhile);
  EXPECT_EQ(2u, result.failures.size()) << result.text();
}

// The tool was late for a while and is on time to the end.
TEST_F(ReplayExpectations, ADriverThatWasSilentForAWhileBreaksThemAlsoIfAnotherOneEndsMeanwhile) {
  record_silence(cell, run, {.silent_from = 100, .silent_to = 200, .hand_ends = 150});
  const OfflineReplay result = replay({.expect_min_distance = 0.05});
  ASSERT_EQ(1u, result.failures.size()) << result.text();
  EXPECT_LT(result.failures[0].tick.cycle, 150u);
}

TEST_F(ReplayExpectations, APairThatIsKnownBreaksThemAlsoAfterTheEndOfAnotherDriver) {
  record_silence(cell, run, {.sinks = 290});
  const OfflineReplay result = replay(kBothExpectations);
  ASSERT_EQ(2u, result.failures.size()) << result.text();
  EXPECT_EQ(291u, result.failures[0].tick.cycle);
  EXPECT_EQ(291u, result.failures[1].tick.cycle);
  EXPECT_THAT(result.failures[1].what, HasSubstr("hand - box"));
}

// The tool is heard for the first time at tick 201.
TEST_F(ReplayExpectations, AreJudgedFromTheFirstTickInWhichTheirObjectsAreKnownAndSayFromWhen) {
  record_silence(cell, run, {.silent_from = 0, .silent_to = 200, .sinks = 300});
  const OfflineReplay result = replay({.expect_min_distance = 0.05});
  EXPECT_TRUE(result.ok()) << result.text();
  EXPECT_EQ(200u, result.not_judged);
  EXPECT_THAT(result.notes,
              testing::Contains(HasSubstr("not judged in the first 200 of 300 tick")));
}

TEST_F(ReplayExpectations, OfOtherPairsAreJudgedWhileAnObjectIsNeverHeard) {
  record_silence(cell, run, {.silent_from = 0, .silent_to = 300, .sinks = 250});
  const OfflineReplay zone = replay({.expect_no_zone = {"stop"}});
  ASSERT_EQ(1u, zone.failures.size()) << zone.text();
  EXPECT_EQ(251u, zone.failures[0].tick.cycle);
  const OfflineReplay pair = replay({.expect_between = {{0.05, "hand", "box"}}});
  ASSERT_EQ(1u, pair.failures.size()) << pair.text();
  EXPECT_EQ(251u, pair.failures[0].tick.cycle);
  EXPECT_EQ(0u, pair.not_judged);
}

TEST_F(ReplayExpectations, AllowAsManyUnknownTicksAsIsStatedAndSayHowManyThereWere) {
  record_silence(cell, run, {.silent_from = 100, .silent_to = 200});
  OfflineReplayOptions options = kBothExpectations;
  options.allow_unknown = 0.1;
  EXPECT_FALSE(replay(options).ok());
  options.allow_unknown = 0.5;
  const OfflineReplay result = replay(options);
  EXPECT_TRUE(result.ok()) << result.text();
  EXPECT_THAT(result.notes, testing::Contains(HasSubstr("as allowed")));
}

TEST_F(ReplayExpectations, BetweenTwoObjectsOrOfAZoneMeanTheirPairsAlone) {
  record_run(cell, run, {.nearest = 0.08});
  EXPECT_TRUE(replay({.expect_between = {{0.09, "hand", "tool"}}}).ok());
  EXPECT_FALSE(replay({.expect_between = {{0.09, "box", "hand"}}}).ok());
  EXPECT_FALSE(replay({.expect_between = {{0.09, "stop", ""}}}).ok());
  const OfflineReplay two =
      replay({.expect_between = {{0.0799, "hand", "box"}, {0.09, "hand", "box"}}});
  ASSERT_EQ(1u, two.failures.size()) << "each has a distance of its own";
  EXPECT_THAT(replay({.expect_between = {{0.09, "hand", "bxo"}}}).error, HasSubstr("'bxo'"));
  EXPECT_THAT(replay({.expect_between = {{0.09, "halt", ""}}}).error, HasSubstr("its zones are"));
}

// The finger is never farther than 1.3 m from the upper link, nor the lower link from the foot.
// Foot and finger keep 1.4 m while the arm is stretched, although their bounds need only certify
// the minimum of 1.25 m.
TEST(ReplayOfARobotAlone, ExpectsNoDistanceThatItsBuildNeverKeeps) {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  const Cell cell = read_good(
      "name: test\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: scara.urdf}]\n"
      "pairs: [{between: [arm, arm]}]\n",
      folder / "cell.yaml");
  const auto replay_with_elbow = [&](double elbow, double expected) {
    std::string csv = "t_ns,shoulder,elbow,push\n";
    for (int i = 0; i < 60; ++i) {
      csv += std::to_string(i * 10'000'000) + "," + std::to_string(0.005 * i) + "," +
             std::to_string(elbow + 0.005 * i) + ",0.2\n";
    }
    write_text(folder / "joints.csv", csv);
    return replay_offline(cell, folder / "joints.csv", {.expect_min_distance = expected});
  };
  const OfflineReplay stretched = replay_with_elbow(0.0, 1.4);
  EXPECT_TRUE(stretched.ok()) << stretched.text();
  EXPECT_THAT(stretched.notes, testing::Contains(testing::AllOf(HasSubstr("upper - finger"),
                                                                HasSubstr("in every posture"))));
  const OfflineReplay folded = replay_with_elbow(2.8, 1.4);
  ASSERT_EQ(folded.failures.size(), 1u) << folded.text();
  EXPECT_THAT(folded.failures[0].what, HasSubstr("foot - finger"));
  EXPECT_FALSE(replay_with_elbow(0.0, 1e3).ok()) << "foot and finger: nothing is proved of them";
}

}  // namespace
}  // namespace clearance::test
