// Tasks that wait: in order, and never too many.
#include <gtest/gtest.h>

#include <thread>

#include "monitor/requests/scene_task.hpp"

namespace clearance {
namespace {

GivenCommand numbered(std::uint64_t request) {
  return {.command = {.client = "planner", .request = request}};
}

TEST(SceneQueue, HandsCommandsOutInTheOrderInWhichTheyCame) {
  SceneQueue queue;
  for (std::uint64_t i = 1; i <= 3; ++i) EXPECT_TRUE(queue.put(numbered(i)));
  for (std::uint64_t i = 1; i <= 3; ++i)
    EXPECT_EQ(std::get<GivenCommand>(*queue.next()).command.request, i);
}

TEST(SceneQueue, TakesNoMoreThanItsCapacity) {
  SceneQueue queue;
  for (std::size_t i = 0; i < SceneQueue::kMost; ++i) EXPECT_TRUE(queue.put(numbered(i)));
  EXPECT_FALSE(queue.put(numbered(1000)));
  (void)queue.next();
  EXPECT_TRUE(queue.put(numbered(1001)));
  EXPECT_FALSE(queue.put(numbered(1002)));
}

TEST(SceneQueue, TakesALargeCommandAloneAndNoOtherBesideIt) {
  SceneQueue queue;
  GivenCommand large = numbered(1);
  large.command.changes = {ReplaceCell{std::string(SceneQueue::kMostBytes, 'x')}};
  EXPECT_TRUE(queue.put(large));
  GivenCommand small = numbered(2);
  small.command.changes = {AddObject{"{name: a}"}};
  EXPECT_FALSE(queue.put(small));
  (void)queue.next();
  EXPECT_TRUE(queue.put(small));
}

TEST(SceneQueue, EndsAThreadThatWaitsAndTakesNothingAfterwards) {
  SceneQueue queue;
  std::optional<SceneTask> got = numbered(1);
  std::thread waiting([&] { got = queue.next(); });
  queue.close();
  waiting.join();
  EXPECT_FALSE(got);
  EXPECT_FALSE(queue.put(numbered(2)));
  EXPECT_FALSE(queue.next());
}

}  // namespace
}  // namespace clearance
