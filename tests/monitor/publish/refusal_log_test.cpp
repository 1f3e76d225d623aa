#include "monitor/publish/refusal_log.hpp"

#include <gtest/gtest.h>

#include "tests/shared/logged.hpp"

namespace clearance::test {
namespace {

// A robot's joints and two objects, whose refusals are counted as the daemon counts them.
class RefusalLogTest : public testing::Test {
 protected:
  void refuse(const std::string& input, const std::string& cause, std::uint64_t more,
              const std::string& value = "") {
    counts[{input, cause}] += more;
    values[{input, cause}] = value;
  }
  // One second passes. Returns how many lines were due.
  std::size_t second(std::size_t most = 5) {
    std::vector<clearance_msg_RejectCount> entries;
    for (auto& [key, count] : counts) {
      entries.push_back({const_cast<char*>(key.first.c_str()),
                         const_cast<char*>(key.second.c_str()), count,
                         const_cast<char*>(values[key].c_str())});
    }
    clearance_msg_Health health{};
    health.rejected._buffer = entries.data();
    health.rejected._length = static_cast<std::uint32_t>(entries.size());
    return refusals.update(health, most);
  }
  [[nodiscard]] std::size_t lines() const { return logged->count("[refused]"); }

  std::map<std::pair<std::string, std::string>, std::uint64_t> counts;
  std::map<std::pair<std::string, std::string>, std::string> values;
  RefusalLog refusals;
  std::shared_ptr<Logged> logged = std::make_shared<Logged>();
  LoggedTo log{logged};
};

// Two publishers of seven joints contradict each other for a minute.
TEST_F(RefusalLogTest, HasOneLineForAllJointsAndRepeatsItMoreAndMoreSeldom) {
  for (int s = 0; s < 60; ++s) {
    for (int joint = 1; joint <= 7; ++joint)
      refuse("joint j" + std::to_string(joint), "another source contradicts it", 500);
    EXPECT_LE(second(), 1u);
  }
  EXPECT_EQ(lines(), 3u) << logged->text();
  EXPECT_TRUE(
      logged->has("3500 positions of joint j1, joint j2, joint j3 and 4 more refused in the "
                  "last second: another source contradicts it (3500 since the start)"))
      << logged->text();
  EXPECT_TRUE(
      logged->has("35000 positions of joint j1, joint j2, joint j3 and 4 more refused in "
                  "the last 10 s: another source contradicts it (38500 since the start)"))
      << logged->text();
}

TEST_F(RefusalLogTest, TellsTheValueThatWasRefusedLast) {
  refuse("box", "faster than it moves", 1, "(1, 2, 3) m");
  refuse("cart", "faster than it moves", 2, "(4, 5, 6) m at 7 m/s");
  refuse("arm", "stamp in the future", 1);
  EXPECT_EQ(second(), 2u);
  EXPECT_TRUE(logged->has("(4, 5, 6) m at 7 m/s")) << logged->text();
}

TEST_F(RefusalLogTest, NamesAnotherInputAndAnotherCauseAtOnce) {
  refuse("box", "stamp in the future", 1);
  EXPECT_EQ(second(), 1u);
  refuse("box", "stamp in the future", 1);
  EXPECT_EQ(second(), 0u) << "the same again";
  refuse("cart", "stamp in the future", 1);
  EXPECT_EQ(second(), 1u);
  EXPECT_TRUE(logged->has("2 poses of box, cart refused in the last 2 s")) << logged->text();
  refuse("box", "not finite", 1);
  EXPECT_EQ(second(), 1u);
}

// Joints that move pass through what the other publisher sends, and each second others differ.
TEST_F(RefusalLogTest, IsNotNewWhereOtherInputsTakeTurns) {
  for (int s = 0; s < 60; ++s) {
    refuse("joint j" + std::to_string(s % 7), "another source contradicts it", 500);
    refuse("joint j" + std::to_string((s + 3) % 7), "another source sends it", 500);
    (void)second();
  }
  EXPECT_LE(lines(), 18u) << logged->text();
  for (int s = 60; s < 120; ++s) {
    refuse("joint j" + std::to_string(s % 7), "another source contradicts it", 500);
    refuse("joint j" + std::to_string((s + 3) % 7), "another source sends it", 500);
    (void)second();
  }
  EXPECT_LE(lines(), 24u) << "a minute later";
}

TEST_F(RefusalLogTest, TellsLaterWhatWasRefusedDuringThePauseAndThenIsSilent) {
  for (int s = 0; s < 3; ++s) {
    refuse("box", "not finite", 1);
    (void)second();
  }
  for (int s = 0; s < 30; ++s) (void)second();
  EXPECT_EQ(lines(), 2u) << logged->text();
  EXPECT_TRUE(logged->has("(3 since the start)")) << logged->text();
}

TEST_F(RefusalLogTest, KeepsLinesThatHadNoPlace) {
  refuse("a", "not finite", 1);
  refuse("b", "unknown object", 1);
  EXPECT_EQ(second(1), 2u);
  EXPECT_EQ(lines(), 1u);
  EXPECT_EQ(second(1), 1u);
  EXPECT_EQ(lines(), 2u);
}

TEST_F(RefusalLogTest, GoesOnAfterAChangeOfTheSceneThatBeginsCountsAnew) {
  for (int s = 0; s < 5; ++s) {
    refuse("cup", "too fast", 10);
    second();
  }
  EXPECT_EQ(lines(), 1u);
  counts.clear();
  refusals.begin_counts_anew();
  for (int s = 0; s < 8; ++s) {
    refuse("cup", "too fast", 10);
    second();
  }
  EXPECT_EQ(lines(), 2u) << logged->text();
  EXPECT_TRUE(logged->has("110")) << "refusals since the start: " << logged->text();
}

}  // namespace
}  // namespace clearance::test
