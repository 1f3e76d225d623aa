// Lists of bodies in a bag make persons of the replay come and go, as in the daemon.
//
// Oracle: the table of what the tracker says in each test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/urdf/person.hpp"
#include "monitor/pairs/pair_bounds.hpp"
#include "monitor/recording/log_recording.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/replay/report_recorder.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

constexpr std::int64_t kWalkBegin = 1'700'000'000'000'000'000, kTenMs = 10'000'000;

// The post stands 3 m before the world's origin. `state` is what the cell says of the person.
std::string people_cell(const std::string& state) {
  return "name: people\nunits: {length: m, angle: rad}\nrate_hz: 100\n"
         "ros2: {world_frame: map, tracked_bodies: true}\nrobots:\n"
         "  - {name: one, person: {stature: 1.75, error: 0.1}, groups: [people], "
         "age_limit_ms: 200" +
         state +
         "}\nobjects:\n"
         "  - {name: post, fixed: true, pose: {xyz: [3, 0, 1]}, sphere: {radius: 0.1}}\n"
         "  - {name: cart, frame: cart, sphere: {radius: 0.1}, max_speed: 1}\n"
         "pairs: [{between: [people, post], publish: true}, {between: [cart, post]}]\n"
         "zones: [{name: near, between: [people, post], enter_below: 0.2, leave_above: 0.3}]\n";
}

// What is recorded at one time: the list, if there is one, and the bodies that tell where they are.
struct Said {
  std::optional<std::vector<std::string>> listed;
  std::vector<std::string> told = {};
  double x = 0.0;  // of these bodies, m
};

const std::vector<std::string> kNone;

class PeopleInABag : public testing::Test {
 protected:
  // One message of each kind every 10 ms.
  void record(int times, const std::function<Said(int)>& said_at) {
    std::vector<RosMessage> messages;
    for (int i = 0; i < times; ++i) {
      const std::int64_t t = kWalkBegin + i * kTenMs;
      const Said said = said_at(i);
      if (said.listed) messages.push_back(list(t, *said.listed));
      std::vector<FrameText> frames = {{"map", "cart", {9, 9, 0}}};
      for (const std::string& id : said.told)
        frames.push_back({"map", "body_" + id, {said.x, 0, 1}});
      messages.push_back(transforms(t, t, frames));
      for (const std::string& id : said.told) messages.push_back(angles(t, id));
    }
    write_mcap_bag(folder / "run.mcap", messages);
  }
  OfflineReplay replay(const OfflineReplayOptions& options = {}) {
    ReportRecorder out(folder / "out.mcap", cell);
    statuses.clear();
    const OfflineReplay done =
        replay_offline(cell, folder / "run.mcap", options, [&](const ReplayedTick& tick) {
          statuses.push_back(PairStatus::kAbsent);
          for (const PairReport& pair : tick.report.pairs) {
            const ObjectPair& of = tick.cell.scene.pairs[pair.pair];
            const auto& objects = tick.cell.scene.objects;
            const bool is_of_cart =
                objects[of.first].name == "cart" || objects[of.second].name == "cart";
            const bool is_decided =
                pair.status == PairStatus::kAbsent || statuses.back() == PairStatus::kUnknown;
            if (!is_of_cart && !is_decided) statuses.back() = pair.status;
          }
          out.add(tick);
        });
    EXPECT_TRUE(out.close());
    return done;
  }
  // Of the person's pairs, in the tick at this time.
  PairStatus at(int ms) const { return statuses.at(static_cast<std::size_t>(ms / 10)); }

  static RosMessage list(std::int64_t t, const std::vector<std::string>& ids) {
    RosCdr cdr;
    cdr.header(t, "").number(static_cast<std::uint32_t>(ids.size()));
    for (const std::string& id : ids) cdr.text(id);
    return {"/humans/bodies/tracked", "hri_msgs/msg/IdsList", t, cdr.bytes()};
  }
  static RosMessage angles(std::int64_t t, const std::string& id) {
    JointStateText state;
    for (const UrdfJoint& joint : skeleton_of(1.75).joints) {
      if (!joint.axis) continue;
      state.name.push_back(joint.name + "_" + id);
      state.position.push_back(0.0);
    }
    return joint_state(t, t, state, "/humans/bodies/" + id + "/joint_states");
  }

  ScratchFolder folder;
  Cell cell = read_good(people_cell(", absent: true"), folder / "cell.yaml");
  std::vector<PairStatus> statuses;  // by tick
};

TEST_F(PeopleInABag, AreUnknownOnceTheListIsSilentThoughOtherTopicsGoOn) {
  record(300, [](int i) { return i < 100 ? Said{kNone} : Said{}; });
  const OfflineReplay done = replay({.expect_no_zone = {"near"}});
  EXPECT_EQ(at(1900), PairStatus::kAbsent);
  EXPECT_EQ(at(2200), PairStatus::kUnknown);
  EXPECT_EQ(statuses.back(), PairStatus::kUnknown);
  EXPECT_FALSE(done.ok()) << done.text();
  EXPECT_THAT(done.notes, Contains(HasSubstr("/humans/bodies/tracked is silent")));
}

TEST_F(PeopleInABag, AreUnknownOnceTheListIsSilentThoughNothingElseComes) {
  std::vector<RosMessage> messages = {list(kWalkBegin, {}),
                                      transforms(kWalkBegin, kWalkBegin, {{"map", "cart"}}),
                                      list(kWalkBegin + 300 * kTenMs, {})};
  write_mcap_bag(folder / "run.mcap", messages);
  replay();
  EXPECT_EQ(at(900), PairStatus::kAbsent);
  EXPECT_EQ(at(1200), PairStatus::kUnknown);
  EXPECT_EQ(at(2900), PairStatus::kUnknown);
}

TEST_F(PeopleInABag, AreUnknownWithoutAnyList) {
  record(200, [](int) { return Said{}; });
  EXPECT_FALSE(replay({.expect_no_zone = {"near"}}).ok());
  EXPECT_EQ(at(900), PairStatus::kAbsent);
  EXPECT_EQ(at(1200), PairStatus::kUnknown);
}

// The post is in the body.
TEST_F(PeopleInABag, AreWhereTheBodiesAreWhoseIdsTheListBrings) {
  for (const char* const state : {"", ", absent: true"}) {
    SCOPED_TRACE(state);
    cell = read_good(people_cell(state), folder / "cell.yaml");
    record(200, [](int i) {
      const std::string id = i < 100 ? "b7" : "b8";
      return Said{std::vector{id}, {id}, 3.0};
    });
    const OfflineReplay done = replay({.expect_no_zone = {"near"}});
    ASSERT_EQ(done.failures.size(), 1u) << done.text();
    EXPECT_THAT(done.failures[0].what, HasSubstr("zone 'near' is active"));
    EXPECT_TRUE(is_known(at(500)));
    EXPECT_TRUE(is_known(at(1500))) << "of another id";
    EXPECT_THAT(done.notes, Each(Not(HasSubstr("is not in the cell"))));
  }
}

TEST_F(PeopleInABag, GiveTheSameBytesInTwoReplays) {
  record(400, [](int i) {
    const std::string id = "b" + std::to_string(i / 20);
    return i < 250 ? Said{std::vector{id}, {id}, 1.0} : Said{};
  });
  replay();
  const std::string first = read_text(folder / "out.mcap");
  replay();
  EXPECT_TRUE(first == read_text(folder / "out.mcap"));
}

// The second body has no person of its own, so the last person is unknown and stands for both.
TEST_F(PeopleInABag, WhomAChangeMakesUnknownBreakEveryExpectation) {
  cell = read_good(people_cell(", absent: true"), folder / "cell.yaml");
  for (const int until : {300, 180}) {
    SCOPED_TRACE(until);
    record(until, [](int i) {
      const std::vector<std::string> one = {"b1"}, two = {"b1", "b9"};
      return Said{i < 100 ? one : two, one};
    });
    const OfflineReplay done =
        replay({.expect_min_distance = 0.5, .expect_no_zone = {"near"}, .allow_unknown = 0.2});
    EXPECT_TRUE(is_known(at(900)));
    EXPECT_EQ(statuses.back(), PairStatus::kUnknown);
    EXPECT_EQ(done.failures.size(), 2u) << done.text();
    EXPECT_TRUE(replay({.expect_no_zone = {"near"}, .allow_unknown = 0.8}).ok());
  }
}

TEST_F(PeopleInABag, CannotBeConvertedSinceARecordingOfALogKeepsOneCell) {
  record(100, [](int) { return Said{kNone}; });
  const LogRecordingResult done = record_log(folder / "run.mcap", folder / "new.mcap", cell);
  EXPECT_THAT(done.error, HasSubstr("'tracked_bodies'"));
  EXPECT_FALSE(std::filesystem::exists(folder / "new.mcap"));
}

TEST_F(PeopleInABag, CannotBeReplayedByATableWhichHasNoLists) {
  write_text(folder / "run.mcap", "t_ns,waist_one\n1,0\n2,0\n");
  EXPECT_THAT(replay({.expect_no_zone = {"near"}}).error, HasSubstr("'tracked_bodies'"));
}

}  // namespace
}  // namespace clearance::test
