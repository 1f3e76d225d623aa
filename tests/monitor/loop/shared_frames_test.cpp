// Frames of sensors and two daemons without DDS: both are shown the same frame in the same tick.
//
// Oracle: the checksums of the other daemon's report and state; the distance to the only point.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "monitor/clouds/seen_cloud.hpp"
#include "tests/monitor/loop/side.hpp"

namespace clearance {
namespace {

using test::kTick;
using test::Side;
using enum PartnerStanding;

constexpr std::uint32_t kSeen = 4;  // the object of the sensor
constexpr std::int64_t kJoinPatience = 20'000'000;

// Four moving balls, and a sensor that sees one point.
Scene seen_cell() {
  std::vector<Object> objects;
  for (const char* name : {"a", "b", "c", "d"}) {
    objects.push_back(test::moving(name, {test::ball(0.1)}));
    objects.back().max_speed = 5.0;
  }
  Object seen = test::moving("seen", {test::ball(50.0)});
  seen.sensor = 0;
  seen.age_limit_ns = 100'000'000'000;
  objects.push_back(seen);
  Scene scene = test::cell_of(std::move(objects));
  scene.rate_hz = 1000;
  scene.sensors.resize(1);
  scene.sensors[0].object = kSeen;
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  return scene;
}

class SharedFrames : public testing::Test {
 protected:
  // The daemon has built the frame of this number: of a point at this x.
  void build(Side& side, std::uint64_t number, float x) {
    clouds.push_back(std::make_unique<SeenCloud>(SeenCloud::of_points(1)));
    const std::array<MeasuredPoint, 1> point = {{{x, 0.0F, 0.0F, 0.0F}}};
    ASSERT_EQ(clouds.back()->points()->build(point, {Vec3::Zero(), 100.0}), CloudBuild::kBuilt);
    side.frames.put(0,
                    {.cloud = clouds.back().get(),
                     .stamp_ns = test::kStart + static_cast<std::int64_t>(number),
                     .world_from_sensor = {},
                     .content = number},
                    scene.revision);
  }
  // The number of the frame that its last tick used.
  [[nodiscard]] static std::uint64_t used(const Side& side) {
    return side.state.monitor().frame_in_use(0).content;
  }
  [[nodiscard]] bool is_known(const Side& side) const {
    for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair) {
      const PairReport report = side.state.monitor().pair(pair);
      if (scene.pairs[pair].second == kSeen && report.status == PairStatus::kUnknown) return false;
    }
    return true;
  }
  void tick_both() {
    ++sent;
    left.get(sent);
    right.get(sent);
    left.tick();
    left.tell(right);
    right.tick();
    right.drop_notices();
  }
  void run_until_left_leads() {
    for (int i = 0; i < 30; ++i) {
      left.get(++sent);
      right.get(sent);
      left.tick();
      left.drop_notices();
      right.clock.pass(kTick);
    }
    ASSERT_EQ(left.ticks.standing(), kLeading);
    right.rest_for(0);
    left.ticks.set_partner_present(true);
    right.ticks.set_partner_present(true);
    for (int i = 0; i < 3; ++i) tick_both();
    ASSERT_TRUE(right.ticks.wants_state());
  }
  void join() {
    run_until_left_leads();
    left.give_state(right);
    tick_both();
    ASSERT_EQ(right.ticks.standing(), kFollowing);
  }
  void expect_agreement() {
    EXPECT_EQ(left.tag.lineage, right.tag.lineage);
    EXPECT_EQ(left.checksum, right.checksum);
    EXPECT_EQ(left.rest, right.rest);
    EXPECT_EQ(used(left), used(right));
  }

  Scene scene = seen_cell();
  std::vector<std::unique_ptr<SeenCloud>> clouds;
  Side left{scene, 1}, right{scene, 2};
  std::uint64_t sent = 0;
};

TEST_F(SharedFrames, AreShownToBothInTheFirstTickAfterTheFollowerHasBuiltThem) {
  join();
  for (std::uint64_t number = 1; number < 20; ++number) {
    build(left, number, 2.0F + 0.1F * static_cast<float>(number));
    for (int i = 0; i < 3; ++i) {
      tick_both();
      expect_agreement();
      EXPECT_EQ(used(left), number - 1) << "the follower has not built it";
    }
    build(right, number, 2.0F + 0.1F * static_cast<float>(number));
    left.frames.note_built(0, number);
    tick_both();
    expect_agreement();
    EXPECT_EQ(used(left), number);
    EXPECT_EQ(right.ticks.standing(), kFollowing);
  }
}

TEST_F(SharedFrames, AreShownAtOnceWithoutAPartner) {
  join();
  left.ticks.set_partner_present(false);
  build(left, 1, 2.0F);
  left.get(++sent);
  left.tick();
  EXPECT_EQ(used(left), 1u);
}

TEST_F(SharedFrames, ThatTheFollowerDoesNotBuildAreShownToTheLeaderAllTheSame) {
  join();
  build(left, 1, 2.0F);
  int waited = 0;
  for (; used(left) != 1 && waited < 100; ++waited) tick_both();
  EXPECT_GE(waited * kTick, kJoinPatience);
  EXPECT_LE(waited * kTick, kJoinPatience + 2 * kTick);
  EXPECT_EQ(right.ticks.standing(), kApart) << "it rests on other inputs, and says so";
  EXPECT_NE(left.tag.lineage, right.tag.lineage);
}

// The frames come faster than the partner builds them.
TEST_F(SharedFrames, AreNotHeldUpByNewerOnes) {
  join();
  int ticks = 0;
  for (std::uint64_t number = 1; used(left) == 0 && ticks < 100; ++number) {
    build(left, number, 2.0F);
    for (int i = 0; i < 4; ++i, ++ticks) tick_both();
  }
  EXPECT_LE(ticks * kTick, kJoinPatience + 5 * kTick);
}

// 60 frames a second come, and the partner needs 18 ms for each.
TEST_F(SharedFrames, WaitForAnAnswerThatComesAfterTheNextFrame) {
  join();
  for (int ms = 0; ms < 200; ++ms) {
    if (ms % 16 == 0) build(left, static_cast<std::uint64_t>(ms / 16 + 1), 2.0F);
    if (ms % 16 == 2 && ms > 16) {
      const auto number = static_cast<std::uint64_t>(ms / 16);
      build(right, number, 2.0F);
      left.frames.note_built(0, number);
    }
    tick_both();
    expect_agreement();
    ASSERT_EQ(right.ticks.standing(), kFollowing) << ms << " ms";
  }
  EXPECT_GE(used(left), 11u);
}

// The follower has built a newer frame before the leader's tick names the older one.
TEST_F(SharedFrames, OfTheNameThatTheLeaderSaysAreShownAlthoughANewerOneHasCome) {
  join();
  build(left, 1, 2.0F);
  build(right, 1, 2.0F);
  left.frames.note_built(0, 1);
  left.get(++sent);
  right.get(sent);
  left.tick();
  ASSERT_TRUE(right.frames.has(0, 1)) << "an earlier look of the follower";
  build(right, 2, 3.0F);
  left.tell(right);
  right.tick();
  expect_agreement();
  EXPECT_EQ(used(right), 1u);
  build(left, 2, 3.0F);
  left.frames.note_built(0, 2);
  tick_both();
  expect_agreement();
  EXPECT_EQ(used(right), 2u);
}

TEST_F(SharedFrames, InUseAreTakenOverByTheOneThatJoinsAndStayInUseAtTheLeader) {
  run_until_left_leads();
  build(left, 1, 2.0F);
  build(right, 1, 2.0F);
  left.frames.note_built(0, 1);
  tick_both();
  ASSERT_EQ(used(left), 1u);
  left.give_state(right);
  for (int i = 0; i < 5; ++i) {
    tick_both();
    EXPECT_TRUE(is_known(left)) << "a person in front of the camera is seen in every tick";
    EXPECT_TRUE(is_known(right));
    EXPECT_EQ(used(right), 1u);
    expect_agreement();
  }
}

TEST_F(SharedFrames, ThatAStateRestsOnAreAwaitedBeforeItIsJoined) {
  run_until_left_leads();
  left.ticks.set_partner_present(false);
  build(left, 1, 2.0F);
  tick_both();
  ASSERT_EQ(used(left), 1u);
  left.give_state(right);
  tick_both();
  EXPECT_NE(right.ticks.standing(), kFollowing);
  EXPECT_EQ(used(left), 1u);
  build(right, 1, 2.0F);
  left.give_state(right);
  tick_both();
  EXPECT_EQ(right.ticks.standing(), kFollowing);
  expect_agreement();
}

// The leader's successor takes its time, and the camera goes on.
TEST_F(SharedFrames, InUseStayInUseAtTheOneThatIsToJoin) {
  run_until_left_leads();
  for (Side* side : {&left, &right}) build(*side, 1, 2.0F);
  left.frames.note_built(0, 1);
  for (int i = 0; i < 3; ++i) tick_both();
  ASSERT_EQ(used(left), 1u);
  ASSERT_EQ(used(right), 1u) << "although it is apart";
  left.begin_successor();
  for (std::uint64_t number = 2; number < 5; ++number) {
    for (Side* side : {&left, &right}) build(*side, number, 3.0F);
    left.frames.note_built(0, number);
    for (int i = 0; i < 33; ++i) tick_both();
    EXPECT_EQ(used(left), 1u);
    EXPECT_EQ(used(right), 1u);
  }
  left.state.give_up();
  tick_both();
  EXPECT_EQ(used(left), 4u);
}

// The successor ticks in another thread with the frames in use.
TEST_F(SharedFrames, InUseStayWhileASuccessorCatchesUp) {
  join();
  build(left, 1, 2.0F);
  build(right, 1, 2.0F);
  left.frames.note_built(0, 1);
  left.begin_successor();
  for (int i = 0; i < 50; ++i) tick_both();
  EXPECT_EQ(used(left), 0u);
  left.state.give_up();
  tick_both();
  EXPECT_EQ(used(left), 1u);
  expect_agreement();
}

}  // namespace
}  // namespace clearance
