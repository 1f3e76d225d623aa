// What passes from one tick to the next, whoever ticks it.
//
// Oracles: a second state that gets the same samples; the distances of balls.
#include "monitor/tick/tick_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "monitor/wire/report_checksum.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;
using State = Successor::State;

// Balls that move, all pairs published, and a zone that they enter and leave.
Scene bodies_of(const std::vector<std::string>& names, std::uint64_t revision) {
  std::vector<Object> objects;
  for (const std::string& name : names) {
    objects.push_back(test::moving(name, {test::ball(0.1), test::capsule(0.3, 0.05)}));
    objects.back().max_speed = 5.0;
  }
  Scene scene = test::cell_of(std::move(objects));
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
  scene.budget = 4;
  scene.revision = revision;
  return scene;
}

class TickStates : public testing::Test {
 protected:
  // The batch of a tick, for the objects of the first scene.
  PoseBatch batch(int tick) const {
    PoseBatch made;
    made.source = SourceName("arm");
    made.sequence_number = static_cast<std::uint64_t>(tick) + 1;
    made.scene_revision = first.revision;
    const double t = 0.001 * tick;
    for (std::uint32_t i = 0; i < first.objects.size(); ++i) {
      const Pose place = test::at(0.5 * i + 0.3 * std::sin(7 * t + i), 0.2 * t, 0);
      made.samples.push_back(test::sample(i, place, now(tick)));
    }
    return made;
  }
  static std::int64_t now(int tick) { return kStart + tick * kTick; }
  const Report& tick(TickState& state, int number) const {
    EXPECT_TRUE(state.use(batch(number)));
    const Report& report = state.tick(now(number));
    state.clear();
    return report;
  }
  std::pair<std::uint64_t, std::uint64_t> bits(TickState& state, int number) const {
    const Report& report = tick(state, number);
    return {checksum_of(report), checksum_of_rest(report, state.monitor().checksum())};
  }

  const Scene first = bodies_of({"a", "b", "c", "d"}, 7),
              second = bodies_of({"d", "b", "new", "a"}, 8);
  TickRecords records, no_records{TickRecords::kNoRoom};
};

TEST_F(TickStates, GiveTheSameBitsWhetherASuccessorRunsAtOnceOrFromRecords) {
  TickState live(first), replayed(first);
  for (int i = 0; i < 20; ++i) {
    tick(live, i);
    tick(replayed, i);
  }
  Successor beside(live, second, records), at_once(replayed, second, no_records);
  ASSERT_TRUE(live.begin(beside));
  ASSERT_TRUE(replayed.begin(at_once));
  for (int i = 20; i < 40; ++i) ASSERT_EQ(bits(live, i), bits(replayed, i)) << i;
  EXPECT_EQ(at_once.catch_up(), 0u);
  EXPECT_EQ(beside.catch_up(), 20u);
  EXPECT_TRUE(beside.has_caught_up(40));
  EXPECT_TRUE(at_once.has_caught_up(40));
  live.succeed();
  replayed.succeed();
  EXPECT_EQ(at_once.in_force().began_after, 20u);
  EXPECT_EQ(at_once.in_force().from, 41u);
  for (int i = 40; i < 90; ++i) ASSERT_EQ(bits(live, i), bits(replayed, i)) << i;
  EXPECT_EQ(live.scene().revision, 8u);
  EXPECT_EQ(live.monitor().rejected(0), (std::array<std::uint64_t, kRejects>{}));
}

TEST_F(TickStates, GoOnAsBeforeWhenASuccessorIsGivenUp) {
  TickState state(first), other(first);
  for (int i = 0; i < 10; ++i) {
    tick(state, i);
    tick(other, i);
  }
  Successor given_up(state, second, no_records);
  ASSERT_TRUE(state.begin(given_up));
  tick(state, 10);
  tick(other, 10);
  state.give_up();
  EXPECT_EQ(state.successor(), nullptr);
  for (int i = 11; i < 30; ++i) ASSERT_EQ(bits(state, i), bits(other, i)) << i;
  Successor next(state, second, no_records);
  EXPECT_TRUE(state.begin(next));
}

TEST_F(TickStates, UseBatchesOfTheScenesBeforeAndOfNoOther) {
  TickState state(first);
  tick(state, 0);
  Successor next(state, second, no_records);
  ASSERT_TRUE(state.begin(next));
  tick(state, 1);
  state.succeed();
  PoseBatch of_other = batch(2);
  of_other.scene_revision = 6;
  EXPECT_FALSE(state.use(of_other));
  EXPECT_TRUE(state.samples().empty());
  EXPECT_TRUE(state.use(batch(2)));
  ASSERT_EQ(state.samples().size(), 3u) << "c is not in the second scene";
  EXPECT_EQ(state.samples()[0].object, 3u) << "a";
  EXPECT_EQ(state.samples()[2].object, 0u) << "d";
}

TEST_F(TickStates, JoinNoStateWhileASuccessorIsBeingMadeOrOfAnotherScene) {
  TickState leader(first), state(first);
  for (int i = 0; i < 10; ++i) tick(leader, i);
  Successor saved(leader, first, no_records);
  ASSERT_TRUE(leader.begin(saved));
  std::vector<std::byte> bytes;
  saved.save(leader.ids(), bytes);
  leader.succeed();
  JoinedState joined(first);
  ASSERT_TRUE(joined.restore(bytes, 5));
  {
    Successor next(state, second, no_records);
    ASSERT_TRUE(state.begin(next));
    EXPECT_FALSE(state.may_join(joined));
    state.succeed();
    EXPECT_FALSE(state.may_join(joined)) << "the scene has changed";
  }
  TickState joining(first);
  ASSERT_TRUE(joining.may_join(joined));
  joining.join(joined);
  EXPECT_TRUE(joined.has_joined());
  EXPECT_EQ(joining.cycle(), leader.cycle());
  for (int i = 10; i < 60; ++i) ASSERT_EQ(bits(joining, i), bits(leader, i)) << i;
}

TEST_F(TickStates, AllocateNothingWithinTheirRoom) {
  TickState state(first, {.room = 16});
  for (int i = 0; i < 5; ++i) tick(state, i);
  Successor next(state, second, records);
  const std::vector<PoseBatch> batches = {batch(5), batch(6), batch(7)};
  const std::uint64_t before = allocations();
  static_cast<void>(state.begin(next));
  for (int i = 0; i < 2; ++i) {
    static_cast<void>(state.use(batches[i]));
    state.tick(now(5 + i));
    state.clear();
  }
  EXPECT_EQ(allocations(), before);
  next.catch_up();
  const std::uint64_t caught_up = allocations();
  state.succeed();
  static_cast<void>(state.use(batches[2]));
  state.tick(now(7));
  state.clear();
  EXPECT_EQ(allocations(), caught_up);
}

}  // namespace
}  // namespace clearance
