// Recordings of two partners: each replays to the same bits, whatever it took over from the other.
//
// Oracle: the recorded reports, which two daemons made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "monitor/recording/recorded_cell.hpp"
#include "monitor/recording/writer.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/replay/side_feed.hpp"
#include "tests/monitor/loop/side.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::kTick;
using test::Side;
using ::testing::HasSubstr;
using enum PartnerStanding;

Cell recorded_cell_of_partners() {
  Cell cell;
  cell.scene = test::cell_of_partners();
  cell.scene.revision = 41;
  return cell;
}

class JoinedRecordings : public testing::Test {
 protected:
  void SetUp() override {
    left.record(left_recorder, cell);
    right.record(right_recorder, cell);
  }
  void send() {
    ++sent;
    left.get(sent);
    right.get(sent);
  }
  void tick_both(int times) {
    for (int i = 0; i < times; ++i) {
      send();
      Side& leader = right.ticks.standing() == kLeading ? right : left;
      Side& other = &leader == &left ? right : left;
      leader.tick();
      leader.tell(other);
      other.tick();
      other.tell(leader);
    }
  }
  // Ticks one side on its own, which hears nothing.
  void tick_alone(Side& side, int times) {
    for (int i = 0; i < times; ++i) {
      send();
      side.tick();
      side.drop_notices();
    }
  }
  // One of them takes over the state of the other.
  void join() {
    for (Side* side : {&left, &right}) side->ticks.set_partner_present(true);
    for (int i = 0; i < 100 && !left.ticks.wants_state() && !right.ticks.wants_state(); ++i)
      tick_both(1);
    Side& other = left.ticks.wants_state() ? left : right;
    Side& leader = &other == &left ? right : left;
    ASSERT_TRUE(other.ticks.wants_state());
    ASSERT_EQ(leader.ticks.standing(), kLeading);
    leader.give_state(other);
    tick_both(40);
    ASSERT_EQ(other.ticks.standing(), kFollowing);
    ASSERT_EQ(left.checksum, right.checksum);
    ASSERT_EQ(left.tag.lineage, right.tag.lineage);
  }
  void close() {
    EXPECT_TRUE(left_recorder.close()) << left_recorder.error();
    EXPECT_TRUE(right_recorder.close()) << right_recorder.error();
  }
  [[nodiscard]] OfflineReplay replay(const std::string& side,
                                     Comparison compare = Comparison::kBits) const {
    return replay_offline(cell, folder / side, {.compare = compare});
  }
  static std::string failures(const OfflineReplay& replay) {
    std::string text = replay.error;
    for (const auto& failure : replay.failures) text += failure.what + "\n";
    return text;
  }
  // Both files again, to the last bit.
  void expect_the_same_bits() const {
    for (const char* side : {"left.mcap", "right.mcap"}) {
      SCOPED_TRACE(side);
      const OfflineReplay replayed = replay(side);
      EXPECT_TRUE(replayed.ok()) << failures(replayed);
      EXPECT_EQ(replayed.compared, replayed.ticks);
      EXPECT_GT(replayed.compared, 40u);
    }
  }

  const Cell cell = recorded_cell_of_partners();
  test::ScratchFolder folder;
  Recorder left_recorder{folder / "left.mcap", cell, test::kStart};
  Recorder right_recorder{folder / "right.mcap", cell, test::kStart};
  Side left{cell.scene, 1}, right{cell.scene, 2};
  std::uint64_t sent = 0;
};

TEST_F(JoinedRecordings, OfBothReplayToTheSameBits) {
  tick_alone(left, 30);
  right.rest_for(30 * kTick);
  join();
  close();
  expect_the_same_bits();
}

// The one that parts counts lower when it joins again, and has ticked inputs of its own meanwhile.
TEST_F(JoinedRecordings, OfOneThatPartsAndJoinsAgainReplayToTheSameBits) {
  tick_alone(left, 30);
  right.rest_for(30 * kTick);
  join();
  tick_alone(left, 40);
  right.rest_for(10 * kTick);
  tick_alone(right, 25);
  right.rest_for(0);
  join();
  close();
  expect_the_same_bits();
}

// The one that counted higher takes over a state that counts lower.
TEST_F(JoinedRecordings, OfOneThatCountsFewerTicksThanBeforeReplayToTheSameBits) {
  tick_alone(right, 60);
  right.begin_successor();
  right.succeed();
  tick_alone(right, 30);
  tick_alone(left, 30);
  ASSERT_GT(right.cycle, left.cycle);
  right.rest_for(0);
  join();
  close();
  expect_the_same_bits();
}

// The leader ends right after it has sent its state: no report has the lineage of that state.
TEST_F(JoinedRecordings, OfOneThatLeadsInTheTickAfterItJoinedReplayToTheSameBits) {
  tick_alone(left, 30);
  right.rest_for(30 * kTick);
  tick_both(3);
  ASSERT_TRUE(right.ticks.wants_state());
  left.give_state(right);
  tick_alone(right, 60);
  ASSERT_EQ(right.ticks.standing(), kLeading);
  tick_alone(left, 30);
  close();
  expect_the_same_bits();
}

// A state of another build has another layout: its bytes are not looked at.
TEST_F(JoinedRecordings, WithAStateOfAnotherBuildAreComparedByTheirBounds) {
  tick_alone(left, 30);
  right.rest_for(30 * kTick);
  join();
  close();
  StateFeed states({folder / "right.mcap"});
  ASSERT_NE(states.front(), nullptr);
  Sample<clearance_msg_PartnerState> state = states.take();
  EXPECT_EQ(states.front(), nullptr) << "it has joined once";
  dds_free(state->build);
  state->build = dds_string_dup("another build");
  RecordingWriter writer(folder / "other.mcap", cell.topics);
  bool is_written = false;
  for (const test::Kept& message : test::messages_of(folder / "right.mcap")) {
    const bool is_report = message.kind == TopicKind::kDistances;
    if (is_report && !is_written &&
        test::decoded<clearance_msg_Distances>(message)->lineage == state->lineage) {
      is_written = true;
      writer.write(SideTopic::kStates, message.log_ns, 0, CdrEncoder().encode(*state));
    }
    writer.write(message.kind, message.log_ns, message.publish_ns, std::span(message.cdr));
  }
  ASSERT_TRUE(is_written);
  ASSERT_TRUE(writer.close()) << writer.error();
  const OfflineReplay bits = replay("other.mcap"),
                      bounds = replay("other.mcap", Comparison::kBounds);
  ASSERT_FALSE(bits.failures.empty());
  EXPECT_THAT(bits.failures.front().what, HasSubstr("the state of a partner"));
  EXPECT_TRUE(bounds.ok()) << failures(bounds);
  EXPECT_GE(bounds.compared, 1u) << "what stands in front of it is compared";
  EXPECT_LT(bounds.compared, bounds.ticks);
  EXPECT_THAT(bounds.notes, ::testing::Contains(HasSubstr("ticks were not compared")));
}

}  // namespace
}  // namespace clearance
