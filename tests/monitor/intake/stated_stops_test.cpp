// Robots of ROS 2 that state their stops on a topic of std_msgs/msg/Bool.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "tests/monitor/intake/heard.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance::test {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::uint64_t kPlc = 7, kOtherPlc = 8;

class StatedStopsOfRos : public testing::Test {
 protected:
  // Sent now, by a clock that is ahead.
  bool state(bool is_stopping, std::uint64_t writer = kPlc,
             const std::string& topic = "/left/stopping", std::int64_t ahead_ns = 0) {
    RosCdr cdr;
    cdr.number(static_cast<std::uint8_t>(is_stopping));
    return heard.take({topic, "std_msgs/msg/Bool", now() + ahead_ns, cdr.bytes()}, writer);
  }
  // The statement with each arm's joints, of positions that held `age_ns` ago.
  std::map<std::string, bool> stated(std::int64_t age_ns = 0) {
    EXPECT_TRUE(heard.take(joint_state(
        now(), now() - age_ns,
        {{"left_shoulder", "right_shoulder", "left_elbow"}, {0.1, 0.2, 0.3}, {0.5, 0.5, 0.5}})));
    std::map<std::string, bool> found;
    std::size_t joints = 0;
    for (const PoseBatch& batch : heard.all()) {
      EXPECT_EQ(batch.sequence_number, ++batches_);
      joints += batch.joints.size();
      for (const JointSample& sample : batch.joints) {
        EXPECT_EQ(sample.stopping, batch.joints.front().stopping) << "a batch is of one kind";
        const auto& robot = cell.scene.robots[cell.scene.variables[sample.variable].robot];
        const auto [known, is_new] = found.emplace(robot.name, sample.stopping);
        EXPECT_EQ(known->second, sample.stopping);
      }
    }
    EXPECT_EQ(joints, 3u);
    return found;
  }
  bool left(std::int64_t age_ns = 0) { return stated(age_ns).at("left"); }
  [[nodiscard]] std::int64_t now() const { return heard.now.realtime_ns; }

  Cell cell = two_stopping_arms();
  Heard heard{cell};

 private:
  std::uint64_t batches_ = 0;
};

TEST_F(StatedStopsOfRos, AreThoseOfTheRobotThatNamesTheTopic) {
  EXPECT_FALSE(left()) << "nothing was stated";
  EXPECT_TRUE(state(true));
  heard.pass(kMs);
  EXPECT_EQ(stated(), (std::map<std::string, bool>{{"left", true}, {"right", false}}));
  EXPECT_TRUE(state(true, kPlc, "/right/stopping"));
  EXPECT_EQ(stated(), (std::map<std::string, bool>{{"left", true}, {"right", true}}));
  EXPECT_TRUE(state(false));
  EXPECT_EQ(stated(), (std::map<std::string, bool>{{"left", false}, {"right", true}}));
  EXPECT_FALSE(state(true, kPlc, "/middle/stopping")) << "no robot names it";
}

// The reaction counts again, as if nothing had been stated.
TEST_F(StatedStopsOfRos, EndWithTheMessagesThatStateThem) {
  state(true);
  heard.pass(20 * kMs);
  EXPECT_TRUE(left());
  heard.pass(1);
  EXPECT_FALSE(left()) << "the last message is too old";
  state(true);
  EXPECT_TRUE(left());
  heard.intake.keep({1});
  EXPECT_FALSE(left()) << "its publisher is gone";
}

TEST_F(StatedStopsOfRos, OfAClockThatIsAheadEndAsSoon) {
  state(true, kPlc, "/left/stopping", 500 * kMs);
  EXPECT_TRUE(left());
  heard.pass(20 * kMs + 1);
  EXPECT_FALSE(left());
}

TEST_F(StatedStopsOfRos, DoNotHoldForPositionsFromBeforeTheBrakes) {
  state(true);
  EXPECT_FALSE(left(1));
  heard.pass(5 * kMs);
  state(true);
  EXPECT_TRUE(left(5 * kMs)) << "the first message counts";
  EXPECT_FALSE(left(5 * kMs + 1));
  heard.pass(20 * kMs + 1);
  state(true);
  EXPECT_FALSE(left(1)) << "in the gap, the brakes may have been released";
}

TEST_F(StatedStopsOfRos, CountOnlyIfAllPublishersOfTheTopicAgree) {
  state(true);
  state(false, kOtherPlc);
  EXPECT_FALSE(left());
  state(true, kOtherPlc);
  EXPECT_TRUE(left());
  state(false, kOtherPlc);
  heard.pass(15 * kMs);
  state(true);
  heard.pass(6 * kMs);
  EXPECT_TRUE(left()) << "the other one is silent";
}

// Oracle: the rule, by the whole history. A statement holds for a stamp if each publisher that was
// heard within 20 ms has said true since then, with no gap above 20 ms.
TEST_F(StatedStopsOfRos, OfAllSequencesOfFiveHoldAsTheRuleSays) {
  struct Said {
    std::int64_t at_ns;
    bool is_stopping;
  };
  EveryChoice choice;
  while (choice.next()) {
    Heard each(cell);
    std::map<std::uint64_t, std::vector<Said>> history;
    for (int step = 0; step < 5; ++step) {
      const std::size_t what = choice.of(6);
      if (what < 4) {
        const std::uint64_t writer = what < 2 ? kPlc : kOtherPlc;
        RosCdr cdr;
        cdr.number(static_cast<std::uint8_t>(what % 2));
        each.take({"/left/stopping", "std_msgs/msg/Bool", each.now.realtime_ns, cdr.bytes()},
                  writer);
        history[writer].push_back({each.now.realtime_ns, what % 2 == 1});
      } else {
        each.pass(what == 4 ? 10 * kMs : 20 * kMs + 1);
      }
    }
    for (const std::int64_t age_ns : {0 * kMs, 10 * kMs, 25 * kMs}) {
      const std::int64_t now = each.now.realtime_ns, stamp = now - age_ns;
      bool is_any = false, do_all = true;
      for (const auto& [writer, said] : history) {
        if (now - said.back().at_ns > 20 * kMs) continue;
        is_any = true;
        std::int64_t since = said.back().at_ns;
        for (auto before = said.rbegin(); before != said.rend() && before->is_stopping; ++before) {
          if (since - before->at_ns > 20 * kMs) break;
          since = before->at_ns;
        }
        do_all = do_all && said.back().is_stopping && since <= stamp;
      }
      each.take(joint_state(now, stamp, {{"left_shoulder"}, {0.1}, {0.5}}));
      ASSERT_EQ(each.one().joints.at(0).stopping, is_any && do_all)
          << choice.runs() << ", age " << age_ns;
    }
  }
  EXPECT_EQ(choice.runs(), 7'776u);
}

TEST_F(StatedStopsOfRos, OfDamagedMessagesAreNotUsed) {
  EXPECT_FALSE(heard.take({"/left/stopping", "std_msgs/msg/Bool", now(), {}}, kPlc));
  RosCdr cdr;
  cdr.number(std::uint8_t{7});
  EXPECT_FALSE(heard.take({"/left/stopping", "std_msgs/msg/Bool", now(), cdr.bytes()}, kPlc));
  EXPECT_FALSE(left());
}

}  // namespace
}  // namespace clearance::test
