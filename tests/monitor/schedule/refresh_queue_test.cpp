#include "monitor/schedule/refresh_queue.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kNoIndex = RefreshQueue::kNoIndex;

// Four objects with six pairs: 01 02 03 12 13 23.
class RefreshQueueTest : public testing::Test {
 protected:
  RefreshQueueTest() {
    for (TrackedObject& object : objects) object.input.has_value = true;
  }

  static Scene four_balls() {
    std::vector<Object> balls(4, test::moving("ball", {test::ball(0.1)}));
    return test::cell_of(std::move(balls));
  }
  void lose(std::uint32_t object) { objects[object].may_have_moved = kInfinity; }
  void regain(std::uint32_t object) {
    objects[object].may_have_moved = 0.0;
    queue.regain(object);
    queue.bring_back(by_object, TickView{objects, parts, 0, table});
  }
  void refresh(std::uint32_t pair, std::uint64_t cycle) {
    table.entries[pair].refreshed_cycle = cycle;
    queue.move_to_back(pair);
  }
  void set_aside(std::uint32_t pair, std::uint32_t object) { queue.set_aside(pair, object, table); }
  // Returns the pairs in the order in which they reach the head. Each is refreshed in a separate
  // tick.
  std::vector<std::uint32_t> order() {
    std::vector<std::uint32_t> pairs;
    for (std::uint64_t cycle = 100; table.entries[queue.stalest()].refreshed_cycle < 100; ++cycle) {
      pairs.push_back(queue.stalest());
      refresh(queue.stalest(), cycle);
    }
    return pairs;
  }

  Scene scene = four_balls();
  std::vector<PosedPart> parts = parts_of(scene);
  PairTable table{scene, parts};
  PairsByObject by_object{scene};
  std::vector<TrackedObject> objects = std::vector<TrackedObject>(4);
  RefreshQueue queue{4, 6};
};

using Pairs = std::vector<std::uint32_t>;

TEST_F(RefreshQueueTest, NobodyIsStalestInAnEmptyOne) { EXPECT_EQ(queue.stalest(), kNoIndex); }

TEST_F(RefreshQueueTest, WhoWasRefreshedForAnyReasonGoesToTheBack) {
  for (std::uint32_t pair = 0; pair < 6; ++pair) refresh(pair, pair + 1);
  EXPECT_EQ(queue.oldest(table), 1u);
  refresh(0, 7);
  refresh(3, 8);
  EXPECT_EQ(queue.oldest(table), 2u);
  EXPECT_EQ(order(), (Pairs{1, 2, 4, 5, 0, 3}));
}

TEST_F(RefreshQueueTest, WhoNeverWasComesFirst) {
  refresh(0, 1);
  queue.enter(5, table);
  queue.enter(5, table);
  EXPECT_EQ(queue.oldest(table), 0u);
  EXPECT_EQ(order(), (Pairs{5, 0}));
}

TEST_F(RefreshQueueTest, PairsThatComeBackIntoSightComeFirst) {
  for (std::uint32_t pair = 0; pair < 6; ++pair) refresh(pair, pair + 1);
  lose(0);
  set_aside(0, 0);
  set_aside(1, 0);
  EXPECT_EQ(queue.oldest(table), 3u);
  refresh(2, 9);
  regain(0);
  EXPECT_EQ(queue.oldest(table), 1u);
  EXPECT_EQ(order(), (Pairs{0, 1, 3, 4, 5, 2}));
}

TEST_F(RefreshQueueTest, APairComesBackWhenBothOfItsObjectsHave) {
  for (std::uint32_t pair = 0; pair < 6; ++pair) refresh(pair, pair + 1);
  lose(0);
  lose(1);
  set_aside(0, 0);
  regain(0);
  EXPECT_EQ(queue.stalest(), 1u) << "object 1 is still out of sight";
  EXPECT_EQ(queue.oldest(table), 2u);
  regain(1);
  EXPECT_EQ(queue.stalest(), 0u);
  EXPECT_EQ(queue.oldest(table), 1u);
}

// More pairs of one ball than one tick brings back, all set aside. The last one is the oldest.
class RefreshQueueOfMany : public testing::Test {
 protected:
  static constexpr std::uint32_t kPairs = 2'100;

  RefreshQueueOfMany() {
    for (TrackedObject& object : objects) object.input.has_value = true;
    for (std::uint32_t i = 0; i < of_ball.size(); ++i) {
      table.entries[of_ball[i]].refreshed_cycle = kPairs - i;
      queue.move_to_back(of_ball[i]);
    }
    for (const std::uint32_t pair : of_ball) queue.set_aside(pair, 0, table);
  }
  static Scene ball_and_posts() {
    std::vector<Object> balls{test::moving("ball", {test::ball(0.1)})};
    balls.resize(kPairs + 1, test::fixed("post", {test::ball(0.1)}, Pose{}));
    return test::cell_of(std::move(balls));
  }
  void bring_back() { queue.bring_back(by_object, TickView{objects, parts, 0, table}); }
  // Empties the queue, and returns how many pairs it had.
  std::uint32_t count() {
    std::uint32_t pairs = 0;
    for (; queue.stalest() != kNoIndex && pairs <= kPairs; ++pairs)
      queue.set_aside(queue.stalest(), 0, table);
    return pairs;
  }

  Scene scene = ball_and_posts();
  std::vector<PosedPart> parts = parts_of(scene);
  PairTable table{scene, parts};
  PairsByObject by_object{scene};
  std::span<const std::uint32_t> of_ball = by_object.pairs_of(0);
  std::vector<TrackedObject> objects = std::vector<TrackedObject>(kPairs + 1);
  RefreshQueue queue{kPairs + 1, kPairs};
};

// Pairs that still wait are the oldest.
TEST_F(RefreshQueueOfMany, RemembersTheAgeOfPairsThatComeBackLater) {
  ASSERT_EQ(of_ball.size(), kPairs);
  EXPECT_EQ(queue.stalest(), kNoIndex);
  queue.regain(0);
  bring_back();
  EXPECT_NE(queue.stalest(), kNoIndex);
  EXPECT_EQ(queue.oldest(table), 1u) << "it still waits";
  bring_back();
  EXPECT_EQ(queue.oldest(table), 1u);
  EXPECT_EQ(count(), kPairs);
}

TEST_F(RefreshQueueOfMany, BringsBackAllPairsOfAnObjectThatIsLostAgainMeanwhile) {
  queue.regain(0);
  bring_back();
  queue.set_aside(of_ball.front(), 0, table);
  queue.regain(0);
  bring_back();
  bring_back();
  EXPECT_EQ(count(), kPairs);
}

}  // namespace
}  // namespace clearance
