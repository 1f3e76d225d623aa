// MoveIt's messages that two partners hear: which of them are still to be done here.
#include "monitor/daemon/scene_turns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace clearance {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class SceneTurnsTest : public testing::Test {
 protected:
  // The number of a message is its identity.
  void add(std::uint64_t number, std::size_t bytes = 1) {
    turns.add(std::make_shared<const moveit::RawScene>(
                  moveit::RawScene{.cdr = std::vector<std::byte>(bytes)}),
              number);
  }
  std::vector<std::uint64_t> to_queue() {
    std::vector<std::uint64_t> numbers;
    std::uint64_t number = 0;
    while (turns.to_queue(number)) numbers.push_back(number);
    return numbers;
  }

  SceneTurns turns;
};

TEST_F(SceneTurnsTest, GoIntoTheQueueOnceAndInOrder) {
  add(1);
  add(2);
  EXPECT_THAT(to_queue(), ElementsAre(1, 2));
  EXPECT_THAT(to_queue(), IsEmpty());
  EXPECT_TRUE(turns.begins(1));
  turns.end(1);
  add(3);
  EXPECT_THAT(to_queue(), ElementsAre(3));
  EXPECT_EQ(turns.waiting(), 2u);
}

TEST_F(SceneTurnsTest, NoneBeginsBeforeOneThatCameEarlier) {
  for (const std::uint64_t number : {1, 2, 3}) add(number);
  EXPECT_THAT(to_queue(), ElementsAre(1, 2, 3));
  turns.put_back(1);
  EXPECT_FALSE(turns.begins(2));
  EXPECT_FALSE(turns.begins(3));
  EXPECT_THAT(to_queue(), ElementsAre(1, 2, 3));
}

TEST_F(SceneTurnsTest, EndWhereTheSceneThatTheLeaderMadeOfThemIsInForce) {
  for (const std::uint64_t number : {1, 2, 3, 4}) add(number);
  const std::vector<DoneSceneChange> changes = {{0, 10}, {1, 11}, {0, 12}, {2, 13}, {3, 14}};
  turns.drop_done(changes, 9);
  EXPECT_EQ(turns.waiting(), 4u) << "that scene is none of the leader's";
  turns.drop_done(changes, 10);
  EXPECT_EQ(turns.waiting(), 4u);
  turns.drop_done(changes, 12);
  EXPECT_THAT(to_queue(), ElementsAre(2, 3, 4));
  turns.drop_done(changes, 14);
  EXPECT_FALSE(turns.begins(3));
  EXPECT_TRUE(turns.begins(4));
}

// The second message took back what the first one had changed.
TEST_F(SceneTurnsTest, EndUpToTheLastChangeThatLedToThatScene) {
  for (const std::uint64_t number : {1, 2, 3}) add(number);
  turns.drop_done(std::vector<DoneSceneChange>{{0, 10}, {1, 11}, {2, 10}, {3, 12}}, 10);
  EXPECT_THAT(to_queue(), ElementsAre(3));
}

TEST_F(SceneTurnsTest, ThatCameBeforeADoneOneAreNotDoneLater) {
  for (const std::uint64_t number : {1, 2, 3}) add(number);
  turns.drop_done(std::vector<DoneSceneChange>{{2, 10}}, 10);
  EXPECT_THAT(to_queue(), ElementsAre(3)) << "the leader did not hear the first one";
}

// Done here, and then another leader's cell came in force.
TEST_F(SceneTurnsTest, ThatWereLostWithTheCellBeforeAreDoneAgainInTheirOrder) {
  for (const std::uint64_t number : {1, 2, 3}) add(number);
  EXPECT_THAT(to_queue(), ElementsAre(1, 2, 3));
  for (const std::uint64_t number : {1, 2}) turns.end(number, true);
  EXPECT_TRUE(turns.begins(3));
  EXPECT_EQ(turns.waiting(), 1u);
  turns.go_on_from(std::vector<DoneSceneChange>{{1, 10}});
  EXPECT_FALSE(turns.begins(3)) << "the second one comes before it";
  EXPECT_THAT(to_queue(), ElementsAre(2, 3));
  turns.end(2, true);
  turns.forget_done();
  turns.go_on_from({});
  EXPECT_EQ(turns.waiting(), 1u) << "the second one was known to both";
}

TEST_F(SceneTurnsTest, ThatAreDoneGoFirstWhereTooManyWaitAndAreNotLost) {
  for (std::uint64_t number = 1; number <= SceneTurns::kMost; ++number) add(number);
  turns.end(1, true);
  EXPECT_EQ(turns.add(std::make_shared<const moveit::RawScene>(), 1000), 0u);
  EXPECT_EQ(turns.add(std::make_shared<const moveit::RawScene>(), 1001), 1u);
}

// Two messages of one content have one identity.
TEST_F(SceneTurnsTest, ThatAreAlikeAreEachDone) {
  for (int i = 0; i < 2; ++i) add(7);
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(turns.begins(7));
    turns.end(7, true);
  }
  EXPECT_EQ(turns.waiting(), 0u);
}

TEST_F(SceneTurnsTest, TheOldestGoWhereTooManyWait) {
  for (std::uint64_t number = 1; number <= SceneTurns::kMost + 2; ++number) add(number);
  EXPECT_EQ(turns.waiting(), SceneTurns::kMost);
  EXPECT_FALSE(turns.begins(2));
  EXPECT_TRUE(turns.begins(3));
}

TEST_F(SceneTurnsTest, TheFilesOfEachAreKeptOnce) {
  add(1);
  add(2);
  EXPECT_EQ(turns.to_keep().size(), 2u);
  EXPECT_FALSE(turns.has_to_keep());
  add(3);
  EXPECT_TRUE(turns.has_to_keep());
  EXPECT_EQ(turns.to_keep().size(), 1u);
}

}  // namespace
}  // namespace clearance
