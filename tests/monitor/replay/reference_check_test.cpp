// References are closed forms: a sphere of 50 mm above a box of 100 mm half height.
#include "monitor/replay/reference_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/recording/csv_recording.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr int kTicks = 5;
constexpr const char* kHeights[kTicks] = {"0.45", "0.35", "0.25", "0.15", "0.05"};

class Reference : public testing::Test {
 protected:
  // The hand is 0.3, 0.2, 0.1, 0 and -0.1 m above the box. The tool stays away.
  Reference() {
    std::string log = "t_ns,object,px,py,pz,qw,qx,qy,qz\n";
    for (int tick = 0; tick < kTicks; ++tick) {
      const std::string time = std::to_string(time_ns(tick));
      log += time + ",hand,0,0," + kHeights[tick] + ",1,0,0,0\n";
      log += time + ",tool,0,9,0,1,0,0,0\n";
    }
    write_text(folder / "log.csv", log);
    EXPECT_EQ("", record_csv(folder / "log.csv", folder / "run.mcap", &cell).error);
  }
  static std::int64_t time_ns(int tick) { return kStart + tick * kTick; }
  static std::string row(int tick, const std::string& pair, const std::string& distance) {
    return std::to_string(time_ns(tick)) + "," + pair + "," + distance + "\n";
  }
  OfflineReplay held_against(const std::string& rows, std::optional<double> tolerance = 1e-9) {
    write_text(folder / "ref.csv", "t_ns,object_a,object_b,distance\n" + rows);
    return replay_offline(cell, folder / "run.mcap",
                          {.reference = folder / "ref.csv", .tolerance = tolerance});
  }

  ScratchFolder folder;
  Cell cell{bench_cell()};
  Scene& scene = cell.scene;
};

TEST_F(Reference, ThatIsMetEverywhereIsCounted) {
  const OfflineReplay replay = held_against(row(0, "hand,box", "0.3") + row(1, "box,hand", "2e-1") +
                                            row(2, "hand,box", "0.100000000") +
                                            row(3, "hand,box", "0") + row(4, "hand,box", "-0.1"));
  EXPECT_TRUE(replay.ok()) << replay.text();
  EXPECT_EQ(5u, replay.reference->compared);
  EXPECT_EQ(0u, replay.reference->off);
  EXPECT_EQ(0u, replay.reference->outside);
  EXPECT_LT(replay.reference->largest, 1e-14);
}

TEST_F(Reference, OfZeroStandsForAnyOverlap) {
  EXPECT_TRUE(held_against(row(4, "hand,box", "0.0000000000000")).ok());
  EXPECT_FALSE(held_against(row(2, "hand,box", "0.0000000000000")).ok());
}

TEST_F(Reference, ThatIsMissedNamesTickPairAndFigures) {
  const OfflineReplay replay = held_against(
      row(1, "hand,box", "0.2") + row(2, "hand,box", "0.101") + row(3, "hand,box", "0.002"));
  ASSERT_EQ(2u, replay.failures.size()) << replay.text();
  EXPECT_EQ(3u, replay.failures[0].tick.cycle);
  EXPECT_EQ(time_ns(2), replay.failures[0].now_ns);
  EXPECT_EQ(
      "hand - box: converged, distance 0.1 m, reference 0.101 m: not within the tolerance of 1e-09 "
      "m",
      replay.failures[0].what);
  EXPECT_EQ("hand - box: bounds 0.1 m to 0.1 m, reference 0.101 m: outside",
            replay.failures[1].what);
  EXPECT_EQ(2u, replay.reference->off);
  EXPECT_EQ(2u, replay.reference->outside);
  EXPECT_NEAR(0.002, replay.reference->largest, 1e-12);
}

// Without a tolerance, bounds are checked to the digits given.
TEST_F(Reference, IsWithinTheBoundsWhenItsDigitsAllowIt) {
  const auto outside = [this](int tick, const std::string& distance) {
    return held_against(row(tick, "hand,box", distance), std::nullopt).reference->outside;
  };
  EXPECT_EQ(1u, outside(2, "0.12"));
  EXPECT_EQ(0u, outside(2, "0.1"));
  EXPECT_EQ(0u, outside(2, "1e-1"));
  EXPECT_EQ(1u, outside(2, "0.105"));
  EXPECT_EQ(1u, outside(1, "2.4e-1"));
  EXPECT_EQ(1u, outside(1, "0.00000024e+6"));
  EXPECT_EQ(1u, outside(1, "0.2000004"));
}

TEST_F(Reference, MayBeOffByTheToleranceStatedInDistanceAndBounds) {
  EXPECT_TRUE(held_against(row(2, "hand,box", "0.1009"), 1e-3).ok());
  EXPECT_TRUE(held_against(row(2, "hand,box", "0.0991"), 1e-3).ok());
  EXPECT_TRUE(held_against(row(2, "hand,box", "0.1000003"), std::nullopt).reference->off == 0);
  const OfflineReplay replay = held_against(row(2, "hand,box", "0.1011"), 1e-3);
  EXPECT_EQ(1u, replay.reference->off);
  EXPECT_EQ(1u, replay.reference->outside);
  EXPECT_EQ(2u, replay.failures.size());
}

TEST_F(Reference, OfOtherPairsAndTimesIsToldAndNothingToCompareIsAFailure) {
  const std::string others = row(1, "hand,wall", "1") + row(9, "hand,box", "1");
  OfflineReplay replay = held_against(row(1, "hand,box", "0.2") + others);
  EXPECT_TRUE(replay.ok()) << replay.text();
  EXPECT_EQ(1u, replay.reference->other_pairs);
  EXPECT_EQ(1u, replay.reference->other_times);
  EXPECT_THAT(replay.notes, Contains(HasSubstr("does not watch, such as hand - wall")));
  EXPECT_THAT(replay.notes, Contains(HasSubstr("times at which there is no tick")));
  replay = held_against(others);
  ASSERT_EQ(1u, replay.failures.size());
  EXPECT_EQ("no reference value could be compared", replay.failures[0].what);
}

TEST_F(Reference, IsNotMetByADistanceOfAnotherTick) {
  scene.budget = 1;  // the cell has three part pairs
  const OfflineReplay replay =
      held_against(row(1, "hand,tool", "0.9") + row(2, "hand,tool", "0.9"));
  ASSERT_FALSE(replay.ok());
  EXPECT_THAT(replay.text(), HasSubstr("hand - tool: carried"));
}

TEST_F(Reference, ThatCannotBeReadIsAnErrorWithItsLine) {
  EXPECT_THAT(held_against("1,hand,box,near\n").error,
              mistake_at("ref.csv:2", "distance", "'near'"));
  EXPECT_THAT(held_against("5,hand,box,1\n4,hand,box,1\n").error,
              mistake_at("ref.csv:3", "t_ns", "5", "4"));
}

}  // namespace
}  // namespace clearance::test
