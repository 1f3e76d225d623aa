// Persons of a running daemon come and go as a tracker of ROS4HRI says, over real DDS.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "monitor/examples/arm/bvh.hpp"
#include "monitor/examples/arm/made_motion.hpp"
#include "monitor/examples/arm/person_fit.hpp"
#include "tests/tools/watched_daemon.hpp"
#include "tools/robot/ros_tracker.hpp"

namespace clearance::test {
namespace {

const std::string kPeopleCell =
    "name: people\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
    "ros2: {world_frame: map, tracked_bodies: /hall/people}\nrobots:\n"
    "  - {name: one, person: {stature: 1.75, error: 0.1}, groups: [people], age_limit_ms: 500}\n"
    "  - {name: two, person: {stature: 1.75, error: 0.1}, groups: [people], age_limit_ms: 500}\n"
    "objects:\n  - {name: post, fixed: true, pose: {xyz: [3, 0, 1]}, sphere: {radius: 0.1}}\n"
    "pairs: [{between: [people, post], publish: true}]\n"
    "zones: [{name: near, between: [people, post], enter_below: 0.2, leave_above: 0.3}]\n"
    "simulation: {movers: [{frame: body_one, centre: {xyz: [1, 0, 0.93]}}]}\n";

class DaemonPeople : public WatchedDaemon {
 protected:
  DaemonPeople() {
    const people::Bvh motion = people::read_bvh(people::walking_and_reaching(1, 1));
    skeleton_ = people::PersonFit().fit(people::keypoints_of(motion, 0, 0.01));
  }
  void SetUp() override {
    watch(kPeopleCell);
    tracker_.emplace(connection_, "map", "/hall/people");
  }
  // Sends the list, and where each of `told` is, until both persons have these states.
  bool become(const std::vector<std::string>& listed, const std::vector<std::string>& told,
              PairStatus one, PairStatus two) {
    const auto step = [&] {
      const std::int64_t now_ns = client::now_ns();
      tracker_->list(listed, now_ns);
      for (const std::string& id : told) tracker_->tell(id, skeleton_, now_ns);
    };
    return step_until(20, step, [&] { return is("torso_one", one) && is("torso_two", two); });
  }

  static constexpr PairStatus kKnown = PairStatus::kConverged, kUnknown = PairStatus::kUnknown,
                              kAbsent = PairStatus::kAbsent;
  client::Connection connection_{dds};
  std::optional<people::RosTracker> tracker_;
  people::Skeleton skeleton_;
};

TEST_F(DaemonPeople, ComeAndGoByTheListOfBodies) {
  EXPECT_TRUE(step_until(
      5, [] {}, [&] { return is("torso_one", kUnknown) && is("torso_two", kUnknown); }))
      << "no tracker has said that no person is there";
  EXPECT_TRUE(become({}, {}, kAbsent, kAbsent)) << daemon->output();
  EXPECT_TRUE(become({"b1"}, {"b1"}, kKnown, kAbsent)) << daemon->output();
  // The shoulders are 3 m before the post, at a height of 1.46 m or so.
  EXPECT_NEAR(pair("torso_one").distance, 3.0 - 0.1 - 0.16, 0.2);
  EXPECT_LT(pair("torso_one").lower, pair("torso_one").distance - 0.09) << "by the stated error";
  EXPECT_TRUE(become({"b2"}, {"b2"}, kKnown, kAbsent)) << "another body, and another topic";
  EXPECT_TRUE(become({}, {}, kAbsent, kAbsent));
}

TEST_F(DaemonPeople, OfWhomThereAreTooManyMakeTheLastUnknown) {
  EXPECT_TRUE(become({"b1", "b2", "b3"}, {"b1"}, kKnown, kUnknown)) << daemon->output();
  EXPECT_TRUE(step_until(
      5, [] {}, told("too-many-bodies", {"3"}), 5))
      << daemon->output();
  EXPECT_TRUE(become({"b1"}, {"b1"}, kKnown, kAbsent));
}

TEST_F(DaemonPeople, AreUnknownWhileTheirSkeletonOrTheListIsSilent) {
  EXPECT_TRUE(become({"b1"}, {"b1"}, kKnown, kAbsent)) << daemon->output();
  EXPECT_TRUE(become({"b1"}, {}, kUnknown, kAbsent)) << "no joints and no frame";
  EXPECT_TRUE(become({"b1"}, {"b1"}, kKnown, kAbsent));
  EXPECT_TRUE(step_until(
      20, [] {}, [&] { return is("torso_one", kUnknown) && is("torso_two", kUnknown); }))
      << daemon->output();
  EXPECT_TRUE(daemon->tells("bodies-silent"));
  EXPECT_TRUE(become({"b1"}, {"b1"}, kKnown, kAbsent));
}

// The shoulders are at 0.818 of the stature, the hips at 0.530: 0.43 m above the post.
TEST_F(DaemonPeople, OfASimulationStandWhereItHasTheirFrames) {
  const ChildProcess robot(kRobot, with({cell}, dds_arguments(dds)));
  EXPECT_TRUE(step_until(
      20, [] {}, [&] { return is("torso_one", kKnown) && is("torso_two", kAbsent); }))
      << daemon->output() << robot.output();
  EXPECT_NEAR(pair("torso_one").distance, std::hypot(2.0, 0.43) - 0.1 - 0.16, 0.03);
  EXPECT_FALSE(daemon->told("refused")) << daemon->output();
  EXPECT_TRUE(robot.wrote("source 'robot' sends 1 person at ")) << robot.output();
  EXPECT_TRUE(robot.wrote("nothing is sent of 'two'")) << robot.output();
}

// The daemon of the first share applies the lists of bodies for all. Without it, nothing says in
// the other share that no person is there, whatever the tracker goes on to say.
TEST(PeopleInShares, AreUnknownWhileNoDaemonOfTheFirstShareIsThere) {
  const CellFile cell(
      "name: people in shares\nunits: {length: m, angle: rad}\nrate_hz: 100\n"
      "ros2: {world_frame: map, tracked_bodies: /hall/people}\nrobots:\n"
      "  - {name: one, person: {stature: 1.75, error: 0.1}, groups: [people], absent: true}\n"
      "objects:\n  - {name: here, fixed: true, sphere: {radius: 0.1}}\n"
      "  - {name: there, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [10, 0, 1]}}\n"
      "pairs: [{between: [people, here]}, {between: [people, there]}]\n"
      "zones: [{name: near, between: [people, there], enter_below: 1, leave_above: 1.1}]\n"
      "shares: [{name: first, pairs: [{between: [people, here]}]}, {name: second, pairs: "
      "[{between: [people, there]}]}]\n");
  const DdsOptions dds = own_dds();
  const auto share = [&](const std::string& name) {
    return std::make_unique<ChildProcess>(kDaemon,
                                          with({cell.path(), "--share", name}, dds_arguments(dds)));
  };
  auto first = share("first"), second = share("second");
  client::Connection connection(dds);
  people::RosTracker tracker(connection, "map", "/hall/people");
  // The last line of these codes, while the tracker lists no body.
  const auto last_is = [&](const std::string& code) {
    return eventually([&] {
      tracker.list({}, client::now_ns());
      std::string last;
      std::istringstream lines(second->output());
      for (std::string line; std::getline(lines, line);)
        for (const char* each : {"topic-heard", "zone-unknown", "zone-left"})
          if (line.ends_with("[" + std::string(each) + "]")) last = each;
      return last == code;
    });
  };
  ASSERT_TRUE(last_is("topic-heard")) << second->output();
  first->signal(SIGKILL);
  first->wait();
  EXPECT_TRUE(last_is("zone-unknown")) << second->output();
  EXPECT_TRUE(second->tells("share-alone", {"'first'"})) << second->output();
  first = share("first");
  EXPECT_TRUE(last_is("zone-left")) << first->output() << second->output();
}

// The output of the demo, as far as it does not depend on the machine.
TEST(ArmBesidePeople, FindsNoFalseBoundAgainstTheTrueBody) {
  const std::string cell = test::places::sources() + "/config/cells/people.yaml";
  const DdsOptions dds = own_dds();
  ChildProcess daemon(kDaemon, with({cell}, dds_arguments(dds)));
  ChildProcess arm(
      test::places::programs() + "/example_arm",
      with({"people", cell, "--seconds", "9", "--metres", "0.01"}, dds_arguments(dds)));
  ASSERT_EQ(arm.wait(std::chrono::seconds(120)), 0) << arm.output();
  std::istringstream lines(arm.output());
  std::string figures;
  while (std::getline(lines, figures) && figures.find("bodies") == std::string::npos) {
  }
  long reports = 0, missed = 0, bodies = 0, compared = 0, wrong = -1;
  lines >> reports >> missed >> bodies >> compared >> wrong;
  EXPECT_EQ(bodies, 2) << arm.output();
  EXPECT_EQ(wrong, 0) << arm.output();
  EXPECT_GT(compared, 100) << arm.output();
}

TEST(ArmBesidePeople, NeedsACellWithPersonsAndAMotionThatCanBeRead) {
  const DdsOptions dds = own_dds();
  ChildProcess without(
      test::places::programs() + "/example_arm",
      with({"people", test::places::sources() + "/config/cells/avoid.yaml"}, dds_arguments(dds)));
  EXPECT_EQ(without.wait(), 1);
  EXPECT_TRUE(without.wrote("persons")) << without.output();
  const std::string cell = test::places::sources() + "/config/cells/people.yaml";
  ChildProcess no_motion(test::places::programs() + "/example_arm",
                         with({"people", cell, "--motion", cell}, dds_arguments(dds)));
  EXPECT_EQ(no_motion.wait(), 1);
  EXPECT_TRUE(no_motion.wrote("BVH")) << no_motion.output();
}

}  // namespace
}  // namespace clearance::test
