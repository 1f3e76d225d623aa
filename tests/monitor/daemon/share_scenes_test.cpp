// The daemons of a cell in shares take over scenes of each other: whose, and when.
#include "monitor/daemon/share_scenes.hpp"

#include <gtest/gtest.h>

namespace clearance {
namespace {

constexpr std::int64_t kMs = 1'000'000, kS = 1'000 * kMs;
constexpr std::uint64_t kFile = 10, kNext = 11, kOther = 12;  // revisions
constexpr std::uint64_t kFirst = 100, kAgain = 101;           // daemons of the first share
using Share = std::optional<std::size_t>;
constexpr Share kNoShare = std::nullopt;

class AShare : public testing::Test {
 protected:
  SceneToFollow scenes{1, 3, 0};
};

TEST_F(AShare, TakesTheSceneOfTheFirstOneAtOnceWhenThatHasChanged) {
  EXPECT_EQ(scenes.find(kFile, false, 0), kNoShare) << "it hears nothing";
  scenes.hear(0, {kFirst, kFile, false});
  EXPECT_EQ(scenes.find(kFile, false, kMs), kNoShare);
  scenes.hear(0, {kFirst, kNext, true});
  EXPECT_EQ(scenes.find(kFile, false, 2 * kMs), Share(0));
  EXPECT_EQ(scenes.find(kFile, false, 3 * kMs), kNoShare) << "once";
  scenes.hear(0, {kFirst, kOther, true});
  EXPECT_EQ(scenes.find(kFile, false, 4 * kMs), Share(0)) << "each of them";
  EXPECT_EQ(scenes.find(kOther, true, 5 * kMs), kNoShare);
  EXPECT_EQ(scenes.find(kOther, true, 5 * kS), kNoShare) << "it has it";
}

TEST_F(AShare, TriesAgainEverySecondWhileTheScenesDiffer) {
  scenes.hear(0, {kFirst, kNext, true});
  EXPECT_EQ(scenes.find(kFile, false, 0), Share(0)) << "it begins";
  EXPECT_EQ(scenes.find(kFile, false, 999 * kMs), kNoShare);
  EXPECT_EQ(scenes.find(kFile, false, kS), Share(0));
  EXPECT_EQ(scenes.find(kFile, false, 2 * kS), Share(0));
}

// A command comes to all at once, and one of them is the first to have done it.
TEST_F(AShare, LeavesTheFirstOneASecondToMakeAChangeThatItHasMadeItself) {
  scenes.hear(0, {kFirst, kFile, false});
  EXPECT_EQ(scenes.find(kFile, false, 0), kNoShare);
  EXPECT_EQ(scenes.find(kNext, true, kMs), kNoShare);
  EXPECT_EQ(scenes.find(kNext, true, kS), kNoShare);
  scenes.hear(0, {kFirst, kNext, true});
  EXPECT_EQ(scenes.find(kNext, true, kS + kMs), kNoShare);
  EXPECT_EQ(scenes.find(kOther, true, 2 * kS), kNoShare);
  EXPECT_EQ(scenes.find(kOther, true, 3 * kS), Share(0)) << "the first one has not made it";
}

// The restarted one has only the cell file.
TEST_F(AShare, DoesNotFollowARestartedFirstOneThatHasLostTheScene) {
  scenes.hear(0, {kFirst, kNext, true});
  EXPECT_EQ(scenes.find(kNext, true, 0), kNoShare) << "they agree";
  scenes.hear(0, {kAgain, kFile, false});
  EXPECT_EQ(scenes.find(kNext, true, kS), kNoShare);
  EXPECT_EQ(scenes.find(kNext, true, 10 * kS), kNoShare);
  scenes.hear(0, {kAgain, kOther, true});
  EXPECT_EQ(scenes.find(kNext, true, 11 * kS), kNoShare) << "nor where it changes that";
  scenes.hear(0, {kAgain, kNext, true});
  EXPECT_EQ(scenes.find(kNext, true, 12 * kS), kNoShare) << "they agree again";
  scenes.hear(0, {kAgain, kOther, true});
  EXPECT_EQ(scenes.find(kNext, true, 13 * kS), Share(0));
}

class TheFirstShare : public testing::Test {
 protected:
  SceneToFollow scenes{0, 4, 0};
};

TEST_F(TheFirstShare, TakesTheSceneToWhichMostOthersHaveChangedBeforeItsStart) {
  scenes.hear(1, {1, kOther, true});
  scenes.hear(2, {2, kNext, true});
  scenes.hear(3, {3, kNext, true});
  EXPECT_EQ(scenes.find(kFile, false, 0), kNoShare);
  EXPECT_FALSE(scenes.is_settled());
  EXPECT_EQ(scenes.find(kFile, false, 200 * kMs), Share(2));
  EXPECT_FALSE(scenes.is_settled());
  EXPECT_EQ(scenes.find(kNext, true, 210 * kMs), kNoShare) << "one more has another scene";
  EXPECT_TRUE(scenes.is_settled());
}

TEST_F(TheFirstShare, TakesNoSceneOnceItHasChangedItsOwn) {
  for (const std::size_t share : {1, 2, 3}) scenes.hear(share, {share, kNext, true});
  EXPECT_EQ(scenes.find(kOther, true, 0), kNoShare);
  EXPECT_EQ(scenes.find(kOther, true, 10 * kS), kNoShare);
}

// A cell file that differs is no scene that others have changed to: they take that of the first.
TEST_F(TheFirstShare, TakesNoSceneOfOneThatHasOnlyAnotherCellFile) {
  for (const std::size_t share : {1, 2, 3}) scenes.hear(share, {share, kNext, false});
  EXPECT_EQ(scenes.find(kFile, false, 0), kNoShare);
  EXPECT_EQ(scenes.find(kFile, false, 10 * kS), kNoShare);
}

TEST_F(TheFirstShare, DoesNoMessagesBeforeItHasHeardAllOthersOrForASecond) {
  scenes.hear(1, {1, kFile, false});
  EXPECT_EQ(scenes.find(kFile, false, kS), kNoShare);
  EXPECT_FALSE(scenes.is_settled());
  SceneToFollow heard = scenes;
  for (const std::size_t share : {2, 3}) heard.hear(share, {share, kFile, false});
  EXPECT_EQ(heard.find(kFile, false, kS), kNoShare);
  EXPECT_TRUE(heard.is_settled());
  EXPECT_EQ(scenes.find(kFile, false, kS + kMs), kNoShare);
  EXPECT_TRUE(scenes.is_settled());
}

// Files of the scene lack here: this daemon would never get it.
TEST_F(TheFirstShare, DoesMessagesAfterThreeSecondsThoughItDoesNotGetTheScene) {
  scenes.hear(1, {1, kNext, true});
  for (std::int64_t now = 0; now <= 3 * kS; now += 100 * kMs) {
    static_cast<void>(scenes.find(kFile, false, now));
    EXPECT_FALSE(scenes.is_settled());
  }
  static_cast<void>(scenes.find(kFile, false, 3 * kS + kMs));
  EXPECT_TRUE(scenes.is_settled());
}

}  // namespace
}  // namespace clearance
