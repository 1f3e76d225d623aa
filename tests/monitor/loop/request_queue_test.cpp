// A queue of requests is full by their number or by their bytes.
#include "monitor/loop/request_queue.hpp"

#include <gtest/gtest.h>

namespace clearance::request_queue_test {
namespace {

struct Letter {
  std::size_t bytes;
};
std::size_t bytes_of(const Letter& letter) { return letter.bytes; }

// The bytes of the next letter; nothing if none waits.
std::optional<std::size_t> next(RequestQueue<Letter>& queue) {
  const auto letter = queue.next_within(std::chrono::milliseconds(0));
  return letter ? std::optional(letter->bytes) : std::nullopt;
}

TEST(RequestQueue, HasRoomAgainForWhatWasTaken) {
  RequestQueue<Letter> queue(3, 100);
  for (int round = 0; round < 5; ++round) {
    EXPECT_TRUE(queue.put({60}));
    EXPECT_FALSE(queue.put({60})) << "too many bytes";
    EXPECT_TRUE(queue.put({40}));
    EXPECT_EQ(next(queue), 60u);
    EXPECT_TRUE(queue.put({60}));
    EXPECT_EQ(next(queue), 40u);
    EXPECT_EQ(next(queue), 60u);
    EXPECT_FALSE(next(queue));
  }
}

TEST(RequestQueue, TakesOneRequestHoweverLargeAndNoMoreThanItsNumber) {
  RequestQueue<Letter> queue(2, 100);
  EXPECT_TRUE(queue.put({500}));
  EXPECT_FALSE(queue.put({0}));
  EXPECT_EQ(next(queue), 500u);
  EXPECT_TRUE(queue.put({0}));
  EXPECT_TRUE(queue.put({0}));
  EXPECT_FALSE(queue.put({0})) << "a third one";
}

TEST(RequestQueue, GivesAndTakesNothingOnceItIsClosed) {
  RequestQueue<Letter> queue(2, 100);
  EXPECT_TRUE(queue.put({1}));
  queue.close();
  EXPECT_TRUE(queue.is_closed());
  EXPECT_FALSE(queue.next());
  EXPECT_FALSE(queue.put({1}));
}

}  // namespace
}  // namespace clearance::request_queue_test
