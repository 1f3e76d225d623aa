// Persons of a cell appear and leave as ROS4HRI's lists of bodies say.
//
// Oracle: CDR by its rules, and the table of states in each test.
#include "monitor/intake/tracked_bodies.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/edit/cell_editor.hpp"
#include "monitor/intake/tracked_persons.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/intake/heard.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance {
namespace {

using testing::ElementsAre;

const std::string kCell =
    "name: test\nunits: {length: m, angle: rad}\n"
    "ros2: {world_frame: map, tracked_bodies: true}\nrobots:\n"
    "  - {name: one, person: {stature: 1.7, error: 0.06}, groups: [people]}\n"
    "  - {name: two, person: {stature: 1.7, error: 0.06}, groups: [people]}\n"
    "objects:\n  - {name: post, fixed: true, sphere: {radius: 0.1}}\n"
    "pairs: [{between: [people, post]}]\n";

// A cell whose text follows lists of bodies.
class TrackedPersons : public testing::Test {
 protected:
  // Returns what each person is then: its body, "absent", or "unknown".
  std::vector<std::string> after(const std::optional<std::vector<std::string>>& bodies) {
    std::vector<std::string> states = after_once(bodies);
    EXPECT_TRUE(changes_by_bodies(bodies, cell_.scene).empty()) << "the same list changes nothing";
    return states;
  }
  std::vector<std::string> after_once(const std::optional<std::vector<std::string>>& bodies) {
    const std::vector<CellChange> changes = changes_by_bodies(bodies, cell_.scene);
    if (!changes.empty()) {
      auto result = editor_.edit(changes);
      if (const auto* refusal = std::get_if<EditRefusal>(&result)) ADD_FAILURE() << refusal->reason;
      cell_ = std::get<Cell>(std::move(result));
    }
    std::vector<std::string> states;
    for (const Robot& robot : cell_.scene.robots) {
      const bool is_absent = cell_.scene
                                 .objects[robot.links.back().object == RobotLink::kNoObject
                                              ? robot.links[1].object
                                              : robot.links.back().object]
                                 .absent;
      const std::string& id = robot.person->id;
      states.push_back(is_absent ? "absent" : id.empty() ? "unknown" : id);
    }
    return states;
  }

  CellEditor editor_ = std::get<CellEditor>(CellEditor::open(kCell, "cell.yaml"));
  Cell cell_ = read_good(kCell, "cell.yaml");
};

TEST_F(TrackedPersons, ComeAndGoWithTheirBodiesAndKeepThem) {
  EXPECT_THAT(after(std::vector<std::string>{}), ElementsAre("absent", "absent"));
  EXPECT_THAT(after({{"b1"}}), ElementsAre("b1", "absent"));
  EXPECT_THAT(after({{"b2", "b1"}}), ElementsAre("b1", "b2"));
  EXPECT_THAT(after({{"b2"}}), ElementsAre("absent", "b2"));
  EXPECT_THAT(after({{"b3", "b2"}}), ElementsAre("b3", "b2"));
  EXPECT_THAT(after({{"b4"}}), ElementsAre("b4", "absent")) << "another body: it is found anew";
}

// A person who has no place in the cell would be unseen: the pairs of the last one are unknown.
TEST_F(TrackedPersons, OfWhomThereAreTooManyMakeTheLastOneUnknown) {
  EXPECT_THAT(after({{"b1", "b2", "b3"}}), ElementsAre("b1", "unknown"));
  EXPECT_THAT(after({{"b1", "b3"}}), ElementsAre("b1", "b3"));
  EXPECT_THAT(after({{"b1", "b3", "b3"}}), ElementsAre("b1", "unknown")) << "one id for two";
  EXPECT_THAT(after({{"b1", "not an id"}}), ElementsAre("b1", "unknown"));
  EXPECT_THAT(after({{"one"}}), ElementsAre("absent", "unknown")) << "the name of a robot";
  EXPECT_THAT(after({{"b5", "b5"}}), ElementsAre("b5", "unknown")) << "a place is free for each";
}

// Whatever the order: an id has a person of its own, or the last person is unknown and may be it. A
// body that loses the last person to that gets another one with the next list.
TEST_F(TrackedPersons, OfAllListsOfFourStandForEveryBody) {
  const std::vector<std::string> ids = {"b1", "b2", "no id", "one"};
  test::EveryChoice choice;
  while (choice.next()) {
    std::vector<std::string> bodies(choice.of(5));
    for (std::string& body : bodies) body = ids[choice.of(ids.size())];
    for (const std::vector<std::string>& states : {after_once(bodies), after(bodies)}) {
      std::vector<std::string> without = bodies;
      for (const std::string& state : states) {
        const auto found = std::ranges::find(without, state);
        if (found != without.end()) without.erase(found);
      }
      ASSERT_EQ(states.back() == "unknown", !without.empty())
          << testing::PrintToString(bodies) << " " << testing::PrintToString(states);
      ASSERT_NE(states.front(), "unknown");
    }
  }
  EXPECT_EQ(choice.runs(), 1u + 4u + 16u + 64u + 256u);
}

TEST_F(TrackedPersons, AreUnknownWhileNothingSaysWhichAreThere) {
  EXPECT_THAT(after({{"b1"}}), ElementsAre("b1", "absent"));
  EXPECT_THAT(after(std::nullopt), ElementsAre("unknown", "unknown"));
  EXPECT_THAT(after(std::vector<std::string>{}), ElementsAre("absent", "absent"));
}

class TrackedBodiesOfIntake : public testing::Test {
 protected:
  bool send(const std::vector<std::string>& ids, std::uint64_t writer = 1,
            const std::string& type = "hri_msgs/msg/IdsList") {
    return heard_.take(list(heard_, ids, type), writer);
  }
  // Sent now.
  static test::RosMessage list(const test::Heard& heard, const std::vector<std::string>& ids,
                               const std::string& type = "hri_msgs/msg/IdsList") {
    test::RosCdr cdr;
    for (const std::int32_t stamp : {7, 8}) cdr.number(stamp);
    cdr.text("camera");
    cdr.number(static_cast<std::uint32_t>(ids.size()));
    for (const std::string& id : ids) cdr.text(id);
    return {"/humans/bodies/tracked", type, heard.now.realtime_ns, cdr.bytes()};
  }
  // The only body that the list has; empty: none.
  std::string states(const moveit::RawScene& raw) const {
    std::string body;
    for (const CellChange& change : changes_by_bodies(raw.cdr, raw.bytes, cell_.scene)) {
      const auto& of = std::get<SetAbsent>(change);
      if (!of.absent) body += of.id.value_or("?");
    }
    return body;
  }
  // What the last message says.
  std::vector<CellChange> said() {
    EXPECT_FALSE(came_.empty());
    return changes_by_bodies(came_.back().cdr, came_.back().bytes, cell_.scene);
  }

  const Cell cell_ = read_good(kCell, "cell.yaml");
  std::vector<moveit::RawScene> came_;
  test::Heard heard_{cell_, {.use_scene = [this](moveit::RawScene raw) { came_.push_back(raw); }}};
};

TEST_F(TrackedBodiesOfIntake, AreHandedOnWhenTheListChanges) {
  EXPECT_TRUE(heard_.intake.hears_ros());
  EXPECT_FALSE(send({}, 1, "std_msgs/msg/String"));
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(send({"b1"}));
  ASSERT_EQ(came_.size(), 1u);
  const std::vector<CellChange> changes = said();
  ASSERT_EQ(changes.size(), 2u);
  const auto& first = std::get<SetAbsent>(changes[0]);
  EXPECT_EQ(first.object, "one");
  EXPECT_FALSE(first.absent);
  EXPECT_EQ(first.id, "b1");
  EXPECT_TRUE(std::get<SetAbsent>(changes[1]).absent);
  EXPECT_TRUE(send({"b1", "b2"}));
  EXPECT_EQ(came_.size(), 2u);
  heard_.pass(TrackedBodies::kSilentNs);
  EXPECT_TRUE(send({"b1", "b2"}));
  EXPECT_EQ(came_.size(), 3u) << "the change may have been refused";
}

TEST_F(TrackedBodiesOfIntake, AreToldWhenThereAreMoreThanTheCellHasPersons) {
  EXPECT_TRUE(send({"b1", "b2"}));
  EXPECT_EQ(heard_.told(lines::kTooManyBodies.code), 0u);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(send({"b1", "b2", "b3"}));
  EXPECT_EQ(heard_.told(lines::kTooManyBodies.code), 1u);
}

TEST_F(TrackedBodiesOfIntake, AreToldOnceWhileListsWithTooManyAlternateWithOthers) {
  const auto alternate = [this] {
    for (int ms = 0; ms < 3000; ++ms) {
      EXPECT_TRUE(ms % 2 == 0 ? send({"b1"}) : send({"b1", "b2", "b3"}));
      heard_.pass(1'000'000);
    }
  };
  alternate();
  EXPECT_EQ(heard_.told(lines::kTooManyBodies.code), 1u);
  for (int s = 0; s < 10; ++s) {
    EXPECT_TRUE(send({"b1"}));
    heard_.pass(1'000'000'000);
  }
  alternate();
  EXPECT_EQ(heard_.told(lines::kTooManyBodies.code), 2u) << "there were not too many for 10 s";
}

// A tracker that was never heard is silent, too: nothing says then that no person is there.
TEST_F(TrackedBodiesOfIntake, AreUnknownAfterASecondWithoutAList) {
  heard_.settle();
  heard_.pass(TrackedBodies::kSilentNs - 1);
  heard_.settle();
  EXPECT_TRUE(came_.empty());
  for (int i = 0; i < 3; ++i) {
    heard_.pass(1);
    heard_.settle();
  }
  ASSERT_EQ(came_.size(), 1u);
  ASSERT_EQ(said().size(), 2u);
  for (const CellChange& change : said()) {
    EXPECT_FALSE(std::get<SetAbsent>(change).absent);
    EXPECT_EQ(std::get<SetAbsent>(change).id, "") << "a body by the name of the robot says nothing";
  }
  heard_.pass(TrackedBodies::kSilentNs);
  heard_.settle();
  EXPECT_EQ(came_.size(), 2u) << "the change may have been refused";
  EXPECT_EQ(heard_.told(lines::kBodiesSilent.code), 1u);
  EXPECT_TRUE(send({}));
  ASSERT_EQ(came_.size(), 3u);
  EXPECT_EQ(said().size(), 2u);
  heard_.pass(TrackedBodies::kSilentNs);
  heard_.settle();
  EXPECT_EQ(came_.size(), 4u);
  EXPECT_EQ(heard_.told(lines::kBodiesSilent.code), 2u);
}

// Two trackers that see different parts of the cell: a person whom one of them sees is there.
TEST_F(TrackedBodiesOfIntake, OfSeveralTrackersAreAllOfThem) {
  const auto seen = [this] {
    std::vector<std::string> ids;
    for (const CellChange& change : said()) {
      if (!std::get<SetAbsent>(change).absent) ids.push_back(*std::get<SetAbsent>(change).id);
    }
    return ids;
  };
  EXPECT_TRUE(send({"b1"}, 1));
  EXPECT_TRUE(send({}, 2));
  EXPECT_THAT(seen(), ElementsAre("b1"));
  EXPECT_TRUE(send({"b2", "b1"}, 2));
  EXPECT_THAT(seen(), ElementsAre("b1", "b2"));
  EXPECT_TRUE(send({}, 1));
  EXPECT_THAT(seen(), ElementsAre("b2", "b1"));
  EXPECT_TRUE(send({"b1"}, 2));
  EXPECT_THAT(seen(), ElementsAre("b1"));
  EXPECT_EQ(heard_.told(lines::kTooManyBodies.code), 0u);
}

// The one that goes on cannot say whom the other one saw.
TEST_F(TrackedBodiesOfIntake, AreUnknownUntilATrackerThatFellSilentHasASuccessor) {
  const auto pass = [this](std::initializer_list<std::uint64_t> senders) {
    for (int i = 0; i < 4; ++i) {
      heard_.pass(TrackedBodies::kSilentNs / 4);
      for (const std::uint64_t sender : senders) EXPECT_TRUE(send({}, sender));
      heard_.settle();
    }
  };
  const auto is_unknown = [this] { return came_.back().cdr.empty(); };
  pass({1, 2});
  EXPECT_FALSE(is_unknown());
  pass({1});
  EXPECT_TRUE(is_unknown());
  heard_.intake.keep({1});
  pass({1});
  EXPECT_TRUE(is_unknown()) << "it may have died, whatever DDS says";
  pass({1, 3});
  EXPECT_FALSE(is_unknown()) << "it has been started again";
  pass({1});
  EXPECT_TRUE(is_unknown());
  pass({1, 3});
  EXPECT_FALSE(is_unknown()) << "it was only held up";
  pass({1, 4});
  EXPECT_FALSE(is_unknown()) << "it was started again at once";
  pass({4});
  EXPECT_TRUE(is_unknown()) << "it stands in for one only";
}

// Oracle: the trackers' last lists. It leaves open who stands in for a silent one. One that was
// silent starts anew.
TEST_F(TrackedBodiesOfIntake, OfAllSequencesOfSixNeverLoseABodyThatATrackerSees) {
  struct Tracker {
    std::int64_t first_ns, last_ns;
    bool has_body;
  };
  test::EveryChoice choice;
  while (choice.next()) {
    std::optional<moveit::RawScene> last;
    test::Heard each(cell_, {.use_scene = [&last](moveit::RawScene raw) { last = raw; }});
    each.settle();
    std::map<std::uint64_t, Tracker> trackers;
    for (int step = 0; step < 6; ++step) {
      const std::size_t what = choice.of(8);
      if (what < 6) {
        const std::uint64_t writer = what / 2;
        const std::int64_t now = each.now.monotonic_ns;
        each.take(
            list(each, what % 2 == 1 ? std::vector<std::string>{"b1"} : std::vector<std::string>{}),
            writer);
        Tracker& tracker = trackers.try_emplace(writer, Tracker{now, now, false}).first->second;
        if (now - tracker.last_ns >= TrackedBodies::kSilentNs) tracker.first_ns = now;
        tracker.last_ns = now;
        tracker.has_body = what % 2 == 1;
      } else {
        each.pass(TrackedBodies::kSilentNs / (what == 6 ? 2 : 1));
      }
      each.settle();
      const std::int64_t alive_ns = each.now.monotonic_ns - TrackedBodies::kSilentNs;
      const auto is_silent = [&](const auto& of) { return of.second.last_ns <= alive_ns; };
      const auto was_replaced = [&](const auto& former) {
        return std::ranges::any_of(
            trackers, [&](const auto& of) { return of.second.first_ns > former.second.last_ns; });
      };
      const bool is_unknown = !last || last->cdr.empty();
      if (std::ranges::none_of(trackers, is_silent) && !trackers.empty()) {
        const bool has_body =
            std::ranges::any_of(trackers, [](const auto& of) { return of.second.has_body; });
        ASSERT_FALSE(is_unknown) << choice.runs() << ", step " << step;
        ASSERT_EQ(states(*last), has_body ? "b1" : "") << choice.runs() << ", step " << step;
      } else if (!is_unknown && states(*last).empty()) {
        ASSERT_FALSE(std::ranges::any_of(
            trackers,
            [&](const auto& of) { return is_silent(of) ? !was_replaced(of) : of.second.has_body; }))
            << choice.runs() << ", step " << step;
      }
    }
  }
  EXPECT_EQ(choice.runs(), 262'144u);
}

TEST_F(TrackedBodiesOfIntake, ThatAreCutOffAreRefused) {
  EXPECT_FALSE(heard_.take({"/humans/bodies/tracked", "hri_msgs/msg/IdsList", 0, {}}));
  EXPECT_TRUE(came_.empty());
}

}  // namespace
}  // namespace clearance
