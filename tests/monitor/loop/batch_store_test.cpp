// The batches of several sources: a tick takes those that a notice names.
#include "monitor/loop/batch_store.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/monitor/loop/listed_ports.hpp"

namespace clearance {
namespace {

class Batches : public testing::Test {
 protected:
  // A batch has come. The input is what a notice says of it.
  TickInput come(const char* source, std::uint64_t number) {
    poses.add(source, number, 1);
    poses.last().samples[0].stamp_ns += static_cast<std::int64_t>(number);
    return {SourceName(source), number, content_of(poses.last())};
  }
  // The numbers of the batches that wait.
  std::vector<std::uint64_t> left() {
    std::vector<std::uint64_t> numbers;
    store.choose_all(true);
    while (const PoseBatch* batch = store.next()) numbers.push_back(batch->sequence_number);
    return numbers;
  }

  test::ListedPoses poses;
  BatchStore store{poses, {.samples = 1}};
};

TEST_F(Batches, ThatEarlierTicksHaveUsedAreForgottenWithThoseBeforeThem) {
  (void)come("robot", 1);
  (void)come("camera", 2);
  const TickInput robot = come("robot", 3), camera = come("camera", 4);
  (void)come("robot", 5);
  store.take_in();
  store.begin_again();
  store.forget(std::vector{robot, camera});
  EXPECT_EQ(left(), std::vector<std::uint64_t>{5});
}

// A daemon that joins has hundreds of notices, and as many batches: it must not search for all.
TEST_F(Batches, OfASourceAreLookedForInTheNewestNoticeOnly) {
  const TickInput first = come("robot", 1), later = come("robot", 2);
  const TickInput camera = come("camera", 3);
  store.take_in();
  store.begin_again();
  store.forget(std::vector{first});
  store.forget(std::vector{later, camera});
  EXPECT_EQ(left(), std::vector<std::uint64_t>{2});
  store.begin_again();
  store.forget(std::vector{later});
  EXPECT_EQ(left(), std::vector<std::uint64_t>{});
}

TEST_F(Batches, ThatHaveNotComeLeaveThoseOfEarlierNoticesToBeForgotten) {
  const TickInput first = come("robot", 1);
  (void)come("robot", 2);
  store.take_in();
  const TickInput missing{SourceName("robot"), 7, 12345};
  store.begin_again();
  store.forget(std::vector{missing});
  store.forget(std::vector{first});
  EXPECT_EQ(left(), std::vector<std::uint64_t>{2});
}

}  // namespace
}  // namespace clearance
