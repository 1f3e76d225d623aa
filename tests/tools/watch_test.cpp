// clearance-watch and clearance-robot as a user starts them.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/shared/take_next.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

TEST(Watch, ShowsADaemonThatComesLaterAndSumsUpAtTheEnd) {
  std::string text = small_cell("small");
  const std::string zone = "enter_below: 0.3, leave_above: 0.35";
  text.replace(text.find(zone), zone.size(), "enter_below: 3, leave_above: 3.5");
  const CellFile cell(text + "dds: {topics: {distances: plant/distances, zones: plant/zones}}\n");
  const auto dds = dds_arguments(own_dds());
  ChildProcess watch(kWatch, with({cell.path(), "--plain"}, dds));
  ASSERT_TRUE(eventually([&] { return watch.wrote("waiting for clearanced"); })) << watch.output();
  ChildProcess daemon(kDaemon, with({cell.path()}, dds));
  ChildProcess robot(kRobot, with({cell.path(), "--rate", "200"}, dds));
  ASSERT_TRUE(eventually([&] {
    return watch.wrote("zone near (left - right)") && watch.wrote("tick p50");
  })) << watch.output();
  EXPECT_TRUE(eventually([&] {
    return watch.wrote("oldest input left ") || watch.wrote("oldest input right ");
  })) << watch.output();
  watch.signal(SIGINT);
  EXPECT_EQ(watch.wait(), 0);
  EXPECT_TRUE(watch.wrote(" reports in ")) << watch.output();
  EXPECT_TRUE(watch.wrote(" 0 restarts")) << watch.output();
  robot.signal(SIGTERM);
  EXPECT_EQ(robot.wait(), 0);
  EXPECT_TRUE(robot.wrote("batches of 2 poses sent, 0 failed")) << robot.output();
}

TEST(Watch, SaysThatNobodyKnowsHowFastThingsCloseYet) {
  const CellFile cell(small_cell("small"));
  const Cell read = cell.cell();
  const DdsOptions dds = own_dds();
  Participant client(dds);
  Poses poses(client, read);
  ChildProcess daemon(kDaemon, with({cell.path()}, dds_arguments(dds)));
  ChildProcess watch(kWatch, with({"--plain"}, dds_arguments(dds)));
  ASSERT_TRUE(eventually([&] { return matched_readers(poses.writer()) == 1; }));
  ASSERT_TRUE(meets_writers_of(client, daemon)) << daemon.output();
  poses.send(0.0, false);
  ASSERT_TRUE(eventually([&] { return watch.wrote("closing at an unknown speed"); }))
      << watch.output();
  poses.send(0.0, false);
  ASSERT_TRUE(eventually([&] { return watch.wrote("closing +0.000 m/s  contact in"); }))
      << watch.output();
}

TEST(Watch, FollowsADaemonThatStartsAgainWithAnotherCell) {
  const CellFile first(small_cell("first"));
  std::string text = small_cell("second");
  for (std::size_t at = 0; (at = text.find("left", at)) != std::string::npos; at += 4) {
    text.replace(at, 4, "port");  // the same ids under other names
  }
  const CellFile second(text);
  const auto dds = dds_arguments(own_dds());
  ChildProcess watch(kWatch, with({"--plain"}, dds));
  for (const auto& [cell, pair] : {std::pair{&first, "left - right"}, {&second, "port - right"}}) {
    ChildProcess daemon(kDaemon, with({cell->path()}, dds));
    ChildProcess robot(kRobot, with({cell->path(), "--rate", "200"}, dds));
    ASSERT_TRUE(eventually([&] { return watch.wrote(pair); })) << watch.output();
  }
  ASSERT_TRUE(eventually([&] { return watch.wrote("clearanced is silent"); })) << watch.output();
  watch.signal(SIGTERM);
  EXPECT_EQ(watch.wait(), 0);
  EXPECT_TRUE(watch.wrote(", 1 restart")) << watch.output();
}

TEST(Watch, KeepsTheLastStateAndItsNamesWhenTheDaemonEndsFirst) {
  const CellFile cell(small_cell("small"));
  const auto dds = dds_arguments(own_dds());
  ChildProcess watch(kWatch, with({"--plain"}, dds));
  ChildProcess daemon(kDaemon, with({cell.path()}, dds));
  ChildProcess robot(kRobot, with({cell.path(), "--rate", "200"}, dds));
  ASSERT_TRUE(eventually([&] { return watch.wrote("  minimum "); })) << watch.output();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
  ASSERT_TRUE(eventually([&] { return watch.wrote("clearanced has ended "); })) << watch.output();
  watch.signal(SIGTERM);
  EXPECT_EQ(watch.wait(), 0);
  const std::string output = watch.output();
  const std::string summary = output.substr(output.find(" reports in "));
  EXPECT_NE(summary.find("clearanced has ended "), std::string::npos) << summary;
  EXPECT_NE(summary.find("left - right, at cycle "), std::string::npos) << summary;
}

// The program runs in a terminal, which `script` simulates: without one the screen is not printed.
TEST(Watch, SaysThatAMinimumWasOneWhenTheDaemonHasEnded) {
  const CellFile cell(small_cell("small"));
  const auto dds = dds_arguments(own_dds());
  std::string command = kWatch;
  for (const std::string& word : dds) command += " " + word;
  ChildProcess watch("/usr/bin/env", {"TERM=xterm", "script", "-qfec", command, "/dev/null"});
  ChildProcess daemon(kDaemon, with({cell.path()}, dds));
  ChildProcess robot(kRobot, with({cell.path(), "--rate", "200"}, dds));
  ASSERT_TRUE(eventually([&] { return watch.wrote(" m  "); })) << watch.output();
  const std::string live = watch.output();
  EXPECT_EQ(live.find("was "), std::string::npos) << live;
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
  ASSERT_TRUE(eventually([&] { return watch.wrote("clearanced has ended "); })) << watch.output();
  // A screen that has said before that the daemon is silent shows the figure so already. The line
  // contains "minimum", "was" and the figure, with colours between them.
  EXPECT_TRUE(eventually([&] {
    const std::string output = watch.output();
    const std::size_t was = output.find("was ");
    const std::size_t minimum = output.rfind("minimum ", was);
    return was != std::string::npos && minimum != std::string::npos &&
           was < output.find(" m  ", minimum);
  })) << watch.output();
}

TEST(Watch, SaysThatReportsAreOldAfterItWasHeldUp) {
  const CellFile cell(small_cell("small"));
  const auto dds = dds_arguments(own_dds());
  ChildProcess daemon(kDaemon, with({cell.path()}, dds));
  ChildProcess watch(kWatch, with({"--plain"}, dds));
  ASSERT_TRUE(eventually([&] { return watch.wrote("cycle "); })) << watch.output();
  watch.signal(SIGSTOP);
  // A report is called old when it is 0.5 s old.
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  watch.signal(SIGCONT);
  // The line of that moment, or the line one second later.
  EXPECT_TRUE(eventually(
      [&] {
        return watch.wrote("(the reports are ") ||
               watch.wrote("were old when they were read, up to ");
      },
      std::chrono::seconds(20)))
      << watch.output();
  watch.signal(SIGTERM);
  EXPECT_EQ(watch.wait(), 0);
  EXPECT_TRUE(watch.wrote("of them were old when they were read, up to ")) << watch.output();
}

TEST(Watch, CallsNoStaleDistanceAMinimumAndSaysWhyAZoneIsActive) {
  const CellFile cell(small_cell("small", 100));
  const Cell read = cell.cell();
  const DdsOptions dds = own_dds();
  Participant client(dds);
  Poses poses(client, read);
  ChildProcess daemon(kDaemon, with({cell.path()}, dds_arguments(dds)));
  ChildProcess watch(kWatch, with({"--plain"}, dds_arguments(dds)));
  ASSERT_TRUE(eventually([&] { return watch.wrote("zone near: no poses of left"); }))
      << watch.output();
  ASSERT_TRUE(eventually([&] { return matched_readers(poses.writer()) == 1; }));
  // Sends poses at 0.8 m until the distance is known, and then falls silent.
  ASSERT_TRUE(eventually([&] {
    poses.send(0.0);
    return daemon.told("zone-left", {"'near'"});
  }));
  EXPECT_TRUE(daemon.tells("zone-late", {"left"})) << daemon.output();
  EXPECT_TRUE(eventually([&] {
    return watch.wrote("no minimum known, poses are late: least upper bound ") &&
           watch.wrote("zone near: poses of left are late");
  })) << watch.output();
}

// A box that stands on the floor, is pressed into it, rises, and comes back.
TEST(Watch, ShowsAContactThatIsAllowedTooDeepEndedAndTooLate) {
  std::string text = small_cell("contact");
  text.replace(text.find("max_speed: 5"), 12, "may_jump: true");
  text = text.substr(0, text.find("simulation:")) +
         "contacts:\n  - {name: stand, between: [left, floor], depth: 0.002, until: {distance: "
         "0.03}, by: planner, reason: it stands there}\n"
         "simulation:\n  movers:\n"
         "    - {object: left, centre: {xyz: [0, 0, 0.1]}, amplitude: [0, 0, 0], frequency_hz: 1}\n"
         "    - {object: right, centre: {xyz: [1, 0, 1]}, amplitude: [0, 0, 0], frequency_hz: 1}\n";
  const CellFile cell(text);
  const Cell read = cell.cell();
  const DdsOptions dds = own_dds();
  Participant client(dds);
  Poses poses(client, read);
  ChildProcess daemon(kDaemon, with({cell.path()}, dds_arguments(dds)));
  ChildProcess watch(kWatch, with({"--plain"}, dds_arguments(dds)));
  ASSERT_TRUE(eventually([&] {
    return watch.wrote("contact 'stand' not known: poses are missing or late, left - floor");
  })) << watch.output();
  ASSERT_TRUE(eventually([&] { return matched_readers(poses.writer()) == 1; }));
  const auto expect_at = [&](double height, const std::string& code,
                             const std::vector<std::string>& texts) {
    poses.move_by(Vec3(0, 0, height));
    EXPECT_TRUE(eventually([&] {
      poses.send(0.0);
      return std::ranges::all_of(texts, [&](const auto& each) { return watch.wrote(each); });
    })) << watch.output();
    EXPECT_TRUE(daemon.tells(code, {"'stand'"})) << daemon.output();
  };
  expect_at(-0.001, "contact-allowed",
            {"contact 'stand' allowed by planner: 1.0 of 2.0 mm deep, since cycle ",
             ", until the distance is 30.0 mm, left - floor"});
  expect_at(-0.003, "contact-too-deep",
            {"contact 'stand' deeper than allowed by planner: 3.0 of 2.0 mm deep, since cycle "});
  expect_at(0.05, "contact-ended", {"contact 'stand' ended by distance at cycle "});
  expect_at(-0.001, "contact-too-late",
            {"contact 'stand' later than allowed by planner: ended by distance at cycle "});
}

TEST(Watch, EndsAfterItsSecondsAndSaysSoWhenNothingCame) {
  ChildProcess watch(kWatch, with({"--seconds", "0.3"}, dds_arguments(own_dds())));
  EXPECT_EQ(watch.wait(), 5);
  EXPECT_TRUE(watch.wrote("no report came")) << watch.output();
}

TEST(Robot, SendsEverythingThatMovesWithTwistsAndNumbersWithoutGaps) {
  const CellFile cell(small_cell("small"));
  const Cell read = cell.cell();
  const DdsOptions dds = own_dds();
  Participant participant(dds);
  const dds_entity_t reader = participant.reader(TopicKind::kPoses, read.topics.poses, 4096);
  ChildProcess robot(
      kRobot, with({cell.path(), "--rate", "100", "--source", "tester"}, dds_arguments(dds)));
  Sample<clearance_msg_PoseBatch> sample;
  std::uint64_t expected = 0;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(eventually([&] { return take_next(reader, sample); })) << robot.output();
    if (expected != 0) {
      EXPECT_EQ(sample->sequence_number, expected);
    }
    expected = sample->sequence_number + 1;
    EXPECT_STREQ(sample->source, "tester");
    EXPECT_EQ(sample->scene_revision, read.scene.revision);
    ASSERT_EQ(sample->poses._length, 2u);
    EXPECT_EQ(sample->poses._buffer[1].object, 1u);
    EXPECT_TRUE(sample->poses._buffer[1].has_twist);
  }
  robot.signal(SIGTERM);
  EXPECT_EQ(robot.wait(), 0);
}

TEST(Robot, MeasuresHowSoonTheAnswerIsBack) {
  const CellFile cell(small_cell("small"));
  const auto dds = dds_arguments(own_dds());
  ChildProcess daemon(kDaemon, with({cell.path()}, dds));
  EXPECT_TRUE(eventually([&] {
    ChildProcess robot(kRobot, with({cell.path(), "--latency", "--seconds", "0.5"}, dds));
    EXPECT_EQ(robot.wait(), 0);
    return robot.wrote("batch sent to report received");
  }));
}

TEST(Robot, SaysThatACellHasNoMotion) {
  const std::string text = small_cell("still");
  const CellFile cell(text.substr(0, text.find("simulation:")));
  ChildProcess robot(kRobot, {cell.path()});
  EXPECT_EQ(robot.wait(), 3);
  EXPECT_TRUE(robot.wrote("simulation")) << robot.output();
}

}  // namespace
}  // namespace clearance::test
