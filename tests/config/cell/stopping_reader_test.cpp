// The key `stopping` of a robot.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "tests/config/cell/stopping_cell.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::HasSubstr;

constexpr double kOneDegree = std::numbers::pi / 180.0;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

using Stopping = StoppingCells;

TEST_F(Stopping, NothingIsStatedWithoutTheKey) {
  const Scene arm = scene(cell(""));
  EXPECT_FALSE(arm.robots[0].stopping.is_stated());
  EXPECT_TRUE(arm.robots[0].stopping.max_accelerations.empty());
}

TEST_F(Stopping, HasOneTimeForAllJointsThatMove) {
  const Scene arm = scene(cell("{reaction_ms: 40.5, time_ms: 300}"));
  const RobotStops& stops = arm.robots[0].stopping;
  EXPECT_EQ(stops.category, 1);
  EXPECT_DOUBLE_EQ(stops.reaction, 0.0405);
  EXPECT_FALSE(stops.keeps_path);
  ASSERT_EQ(stops.joints.size(), arm.robots[0].joints.size());
  ASSERT_EQ(stops.max_accelerations.size(), stops.joints.size());
  for (const char* name : {"shoulder", "elbow", "reach", "grip", "finger"}) {
    EXPECT_DOUBLE_EQ(stop(arm, name).time(1.0), 0.3) << name;
    EXPECT_NEAR(stop(arm, name).distance(2.0), 0.6, 1e-12) << name;
    EXPECT_EQ(stops.max_accelerations[joint(arm, name)], kNoLimit) << name;
  }
  EXPECT_EQ(stop(arm, "bolt").time(1.0), 0.0) << "it is fixed";
}

TEST_F(Stopping, StatesTheCategoryAndThePath) {
  const RobotStops stops =
      scene(cell("{reaction_ms: 0, category: 2, path: kept, time_ms: 300}")).robots[0].stopping;
  EXPECT_EQ(stops.category, 2);
  EXPECT_TRUE(stops.keeps_path);
  EXPECT_EQ(stops.reaction, 0.0);
  EXPECT_THAT(errors(cell("{reaction_ms: 0, category: 0, path: kept, time_ms: 300}")),
              mistake_at("cell.yaml:5", "found path: kept of category 0", "'left'"));
  EXPECT_THAT(errors(cell("{reaction_ms: 0, path: straight, time_ms: 300}")),
              mistake_at("cell.yaml:5", "'straight'", "'kept' or 'left'"));
  EXPECT_THAT(errors(cell("{reaction_ms: 0, category: 3, time_ms: 300}")),
              mistake_at("cell.yaml:5", "3", "stop category of IEC 60204-1"));
}

TEST_F(Stopping, InProgressIsStatedOnATopicOfRos2) {
  const RobotStops stops =
      scene(cell("{reaction_ms: 0, time_ms: 300, stated_on: /arm/stopping}")).robots[0].stopping;
  EXPECT_EQ(stops.stated_on, "/arm/stopping");
  EXPECT_THAT(errors(cell("{reaction_ms: 0, time_ms: 300, stated_on: /joint_states}")),
              testing::HasSubstr("'/joint_states', whose messages are no std_msgs/Bool"));
  EXPECT_THAT(errors(cell("{reaction_ms: 0, time_ms: 300, stated_on: arm/stopping}")),
              mistake_at("cell.yaml:5", "'arm/stopping'", "topic of ROS 2 with its namespace"));
}

TEST_F(Stopping, OfOneJointReplacesWhatIsSaidOfAll) {
  const Scene arm =
      scene(cell("{reaction_ms: 10, time_ms: 300, joints: {elbow: {deceleration: 573}, reach: "
                 "{deceleration: 2}, shoulder: {points: [[50, 10, 300], [100, 40, 500]]}, grip: "
                 "{time_ms: 50}}}"));
  EXPECT_NEAR(stop(arm, "elbow").time(1.0), 1.0 / (573 * kOneDegree), 1e-9);
  EXPECT_NEAR(stop(arm, "reach").distance(0.5), 0.0625, 1e-9);
  EXPECT_NEAR(stop(arm, "shoulder").distance(1.5), 10 * kOneDegree, 1e-12) << "half of 3 rad/s";
  EXPECT_NEAR(stop(arm, "shoulder").distance(3.0), 40 * kOneDegree, 1e-12);
  EXPECT_NEAR(stop(arm, "shoulder").time(3.0), 0.5, 1e-12);
  EXPECT_NEAR(stop(arm, "finger").time(0.1), 0.05, 1e-12) << "it mimics the grip";
}

TEST_F(Stopping, NamesJointsWithoutThePrefix) {
  const std::string stopping = "{reaction_ms: 10, time_ms: 300, joints: {elbow: {time_ms: 100}}}";
  const Scene arm = scene(cell(stopping, "", "", ", prefix: left_"));
  EXPECT_NEAR(stop(arm, "left_elbow").time(1.0), 0.1, 1e-12);
  EXPECT_NEAR(stop(arm, "left_shoulder").time(1.0), 0.3, 1e-12);
  EXPECT_THAT(errors(cell("{reaction_ms: 10, time_ms: 300, joints: {left_elbow: {time_ms: 100}}}",
                          "", "", ", prefix: left_")),
              mistake_at("cell.yaml:5", "found the joint 'left_elbow'", "'shoulder', 'elbow'"));
}

TEST_F(Stopping, OfEveryJointHasToBeKnown) {
  EXPECT_THAT(
      errors(cell("{reaction_ms: 10, joints: {elbow: {time_ms: 100}, grip: {time_ms: 100}}}")),
      mistake_at("cell.yaml:5:16", "found no stop of 'shoulder', 'reach'; expected rows in"));
  EXPECT_THAT(errors(cell("{time_ms: 100}")),
              mistake_at("cell.yaml:5", "found no key 'reaction_ms'"));
  EXPECT_THAT(errors(cell("{reaction_ms: 10, time_ms: 100, joints: {elbw: {time_ms: 100}}}")),
              mistake_at("cell.yaml:5", "'elbw'", "did you mean 'elbow'?"));
  EXPECT_THAT(errors(cell("{reaction_ms: 10, time_ms: 100, joints: {finger: {time_ms: 100}}}")),
              mistake_at("cell.yaml:5", "'finger'", "does not mimic another"));
  EXPECT_THAT(errors(cell("{reaction_ms: 10, stop_ms: 100}")),
              mistake_at("cell.yaml:5", "unknown key 'stop_ms'", "'time_ms'"));
}

TEST_F(Stopping, OfOneJointIsOneOfThree) {
  const auto with = [&](const std::string& elbow) {
    return errors(cell("{reaction_ms: 10, time_ms: 300, joints: {elbow: " + elbow + "}}"));
  };
  EXPECT_THAT(with("{time_ms: 100, deceleration: 500}"),
              mistake_at("cell.yaml:5", "found 2 stops of 'elbow'"));
  EXPECT_THAT(
      errors(cell("{reaction_ms: 1, time_ms: 9999, joints: {elbow: {time_ms: 99}, elbow: {time_ms: "
                  "300}}}")),
      mistake_at("cell.yaml:5", "found the joint 'elbow' again"));
  EXPECT_THAT(with("{}"), mistake_at("cell.yaml:5", "found 0 stops of 'elbow'"));
  EXPECT_THAT(with("{points: []}"), mistake_at("cell.yaml:5", "found an empty list"));
  EXPECT_THAT(with("{points: [[100, 20]]}"),
              mistake_at("cell.yaml:5", "a list of 2", "[percent of the full speed of 'elbow'"));
  EXPECT_THAT(errors(cell("{reaction_ms: 10, time_ms: 300, deceleration: urdf}")),
              mistake_at("cell.yaml:5", "found deceleration beside time_ms"));
}

// In a cell in deg, each number is one that would be right in another unit.
TEST_F(Stopping, WithAWrongUnitIsRefusedWithTheJointAndTheValue) {
  const auto with = [&](const std::string& joint, const std::string& stated) {
    return errors(
        cell("{reaction_ms: 10, time_ms: 300, joints: {" + joint + ": {" + stated + "}}}"));
  };
  EXPECT_THAT(with("elbow", "points: [[100, 0.7, 400]]"),
              mistake_at("cell.yaml:5", "found that 'elbow' stands 0.01222 rad", "unit wrong"));
  EXPECT_THAT(with("reach", "points: [[100, 80, 400]]"),
              mistake_at("cell.yaml:5", "found that 'reach' stands 80 m and 0.4 s", "after 0.5 m/s",
                         "expected 0.01 to 0.21 m"));
  EXPECT_THAT(with("elbow", "points: [[100, 40, 0.4]]"),
              mistake_at("cell.yaml:5", "0.4", "the time until the joint stands in ms, from 1"));
  EXPECT_THAT(with("elbow", "points: [[0.5, 20, 400]]"),
              mistake_at("cell.yaml:5", "0.5", "percent of the full speed, from 1"));
  EXPECT_THAT(with("elbow", "deceleration: 8"),
              mistake_at("cell.yaml:5", "a deceleration of 0.1396 rad/s2 of 'elbow'", "unit"));
  EXPECT_THAT(with("reach", "deceleration: 2000"),
              mistake_at("cell.yaml:5", "a deceleration of 2000 m/s2 of 'reach'", "0.00025 s"));
  EXPECT_THAT(with("elbow", "deceleration: 0"), mistake_at("cell.yaml:5", "found 0; expected"));
  EXPECT_THAT(with("elbow", "deceleration: -500"), mistake_at("cell.yaml:5", "found -500"));
  EXPECT_THAT(with("elbow", "time_ms: 0.3"),
              mistake_at("cell.yaml:5", "0.3", "the time until 'elbow' stands in ms, from 10"));
  EXPECT_THAT(with("elbow", "acceleration: 5"),
              mistake_at("cell.yaml:5", "an acceleration of 0.08727 rad/s2 of 'elbow'", "unit"));
}

TEST_F(Stopping, StatesHowFastJointsGainSpeed) {
  const Scene arm =
      scene(cell("{reaction_ms: 10, time_ms: 300, joints: {elbow: {acceleration: 573}, reach: "
                 "{acceleration: 4, time_ms: 100}, grip: {acceleration: 1}}}"));
  const std::vector<double>& found = arm.robots[0].stopping.max_accelerations;
  EXPECT_EQ(found[joint(arm, "shoulder")], kNoLimit);
  EXPECT_NEAR(found[joint(arm, "elbow")], 573 * kOneDegree, 1e-12);
  EXPECT_EQ(found[joint(arm, "reach")], 4.0);
  EXPECT_EQ(found[joint(arm, "finger")], 1.0) << "the grip's, in its unit";
  EXPECT_NEAR(stop(arm, "elbow").time(1.0), 0.3, 1e-12);
}

TEST_F(Stopping, OfAllJointsHasOneRateOnlyIfTheyAreOfOneKind) {
  for (const char* key : {"deceleration", "acceleration"}) {
    EXPECT_THAT(errors(cell(fmt::format("{{reaction_ms: 10, {}: 500, joints: {{}}}}", key))),
                mistake_at("cell.yaml:5", fmt::format("found one {} for 'shoulder'", key),
                           "'reach', which slides", "'urdf'"));
  }
  const Scene mixed =
      scene(cell("{reaction_ms: 10, deceleration: 200, joints: {reach: {deceleration: 2}, grip: "
                 "{time_ms: 50}}}"));
  EXPECT_NEAR(stop(mixed, "elbow").time(1.0), 1.0 / (200 * kOneDegree), 1e-9) << "of all others";
  EXPECT_NEAR(stop(mixed, "reach").time(0.5), 0.25, 1e-12);
  std::string urdf = kArmUrdf;
  for (std::size_t at = 0; (at = urdf.find("prismatic", at)) != std::string::npos;)
    urdf.replace(at, 9, "revolute");
  test::write_text(folder_ / "arm.urdf", urdf);
  const Scene arm = scene(
      cell("{reaction_ms: 10, deceleration: 100, acceleration: 200, joints: {elbow: {deceleration: "
           "200}, reach: {acceleration: 90}}}"));
  const std::vector<double>& found = arm.robots[0].stopping.max_accelerations;
  EXPECT_NEAR(stop(arm, "shoulder").time(1.0), 1.0 / (100 * kOneDegree), 1e-9);
  EXPECT_NEAR(stop(arm, "elbow").time(1.0), 1.0 / (200 * kOneDegree), 1e-9);
  EXPECT_NEAR(found[joint(arm, "elbow")], 200 * kOneDegree, 1e-12);
  EXPECT_NEAR(found[joint(arm, "reach")], 90 * kOneDegree, 1e-12);
}

TEST_F(Stopping, ByTheUrdfIsWhatItsLimitsStateAndWhereTheyDo) {
  const std::string others =
      "joints: {shoulder: {time_ms: 300, acceleration: 500}, reach: {time_ms: 300, acceleration: "
      "4}, grip: {time_ms: 300, acceleration: 4}}";
  const Scene arm =
      scene(cell("{reaction_ms: 10, deceleration: urdf, acceleration: urdf, " + others + "}"));
  EXPECT_NEAR(stop(arm, "elbow").time(4.0), 0.5, 1e-12);
  EXPECT_EQ(arm.robots[0].stopping.max_accelerations[joint(arm, "elbow")], 12.0);
  EXPECT_THAT(errors(cell("{reaction_ms: 10, deceleration: urdf}")),
              mistake_at("cell.yaml:5", "found no stop of 'shoulder', 'reach', 'grip'"));
  EXPECT_THAT(errors(cell("{reaction_ms: 10, time_ms: 300, acceleration: urdf}")),
              mistake_at("cell.yaml:5", "found no acceleration of 'shoulder' in the URDF"));
  EXPECT_THAT(errors(cell("{reaction_ms: 10, " + others + "}")),
              mistake_at("cell.yaml:5", "found no stop of 'elbow'"))
      << "the URDF's limits count only where the cell says so";
}

const std::string kStopsCsv =
    "joint,load_percent,extension_percent,speed_percent,time_ms,angle_deg,distance_mm\n"
    "1,50,100,50,300,13,\n1,50,100,100,280,24,\n1,100,100,50,400,17,\n1,100,100,100,390,33,\n"
    "elbow,50,100,100,200,20,\nelbow,100,100,100,250,28,\n"
    "3,100,100,100,300,,75\n";

TEST_F(Stopping, ByATableCountsSharesOfEachJointsFullSpeed) {
  test::write_text(folder_ / "stops.csv", kStopsCsv);
  const Scene arm =
      scene(cell("{reaction_ms: 10, table: stops.csv, joints: {grip: {time_ms: 60}}}"));
  EXPECT_NEAR(stop(arm, "shoulder").distance(1.5), 17 * kOneDegree, 1e-12);
  EXPECT_NEAR(stop(arm, "shoulder").time(3.0), 0.4, 1e-12) << "never below that of half the speed";
  EXPECT_NEAR(stop(arm, "elbow").distance(4.0), 28 * kOneDegree, 1e-12);
  EXPECT_NEAR(stop(arm, "reach").distance(0.5), 0.075, 1e-12);
  EXPECT_NEAR(stop(arm, "grip").time(0.2), 0.06, 1e-12);
  const Scene faster =
      scene(cell("{reaction_ms: 10, table: stops.csv, joints: {grip: {time_ms: 60}}}", "", "",
                 ", joints: {shoulder: {velocity: 2.5}}"));
  EXPECT_NEAR(stop(faster, "shoulder").distance(2.5), 33 * kOneDegree, 1e-12)
      << "the full speed is the stated one";
}

TEST_F(Stopping, ByATableHasTheStatedLoadOrTheWorst) {
  test::write_text(folder_ / "stops.csv", kStopsCsv);
  const auto with = [&](const std::string& load) {
    return scene(cell("{reaction_ms: 10, table: stops.csv, load: " + load +
                      ", extension: worst, joints: {grip: {time_ms: 60}}}"));
  };
  EXPECT_NEAR(stop(with("worst"), "shoulder").distance(3.0), 33 * kOneDegree, 1e-12);
  EXPECT_NEAR(stop(with("50"), "shoulder").distance(3.0), 24 * kOneDegree, 1e-12);
  EXPECT_NEAR(stop(with("50"), "reach").distance(0.5), 0.075, 1e-12) << "its next step is 100 %";
  EXPECT_NEAR(stop(with("51"), "shoulder").distance(3.0), 33 * kOneDegree, 1e-12);
  const auto refused = [&](const std::string& load) {
    return errors(cell("{reaction_ms: 10, table: stops.csv, load: " + load +
                       ", joints: {grip: {time_ms: 60}}}"));
  };
  EXPECT_THAT(refused("0.5"), mistake_at("cell.yaml:5", "0.5", "the load in percent"));
  EXPECT_THAT(refused("most"), mistake_at("cell.yaml:5", "'most'", "'worst'"));
  EXPECT_THAT(refused("120"), mistake_at("cell.yaml:5", "stops.csv:2: found no row of the joint",
                                         "from 120 % load on"));
  EXPECT_THAT(errors(cell("{reaction_ms: 10, time_ms: 300, extension: 50}")),
              mistake_at("cell.yaml:5", "found 'extension' without 'table'"));
}

TEST_F(Stopping, ByATableIsRefusedWithItsLine) {
  const auto with = [&](const std::string& rows, const std::string& category = "1") {
    test::write_text(folder_ / "stops.csv",
                     "joint,category,speed_percent,time_ms,angle_deg,distance_mm\n" + rows);
    return errors(
        cell("{reaction_ms: 10, category: " + category + ", table: stops.csv, time_ms: 100}"));
  };
  EXPECT_EQ(with("1,1,100,300,30,\n"), "");
  const std::string place = "cell.yaml:5";
  EXPECT_THAT(with("1,1,100,300,30,\n9,1,100,300,30,\n"),
              mistake_at(place, "stops.csv:3: found the joint '9'", "its number from 1 to 4"));
  EXPECT_THAT(with("0,1,100,300,30,\n"), mistake_at(place, "stops.csv:2: found the joint '0'"));
  EXPECT_THAT(with("finger,1,100,300,,30\n"), mistake_at(place, "found the joint 'finger'"));
  EXPECT_THAT(with("3,1,100,300,30,\n"),
              mistake_at(place, "found angle_deg of the joint '3'; expected distance_mm"));
  EXPECT_THAT(with("1,1,100,300,,30\n"), mistake_at(place, "found distance_mm of the joint '1'"));
  EXPECT_THAT(with("1,1,100,300,0.5,\n"),
              mistake_at(place, "stops.csv:2: found that 'shoulder' stands 0.008727 rad"));
  EXPECT_THAT(with("1,1,100,300,300,\n"), mistake_at(place, "is a unit wrong"));
  EXPECT_THAT(with("1,1,100,300,30,\n", "0"),
              mistake_at(place, "stops.csv:2: found no row of category 0"));
  EXPECT_THAT(errors(cell("{reaction_ms: 10, table: none.csv, time_ms: 100}")),
              mistake_at(place, "none.csv", "relative to the cell file"));
}

TEST_F(Stopping, ByATableNeedsTheSpeedOfWhichItHasShares) {
  std::string urdf = kArmUrdf;
  urdf.replace(urdf.find(" velocity=\"3\""), 13, "");
  test::write_text(folder_ / "arm.urdf", urdf);
  test::write_text(folder_ / "stops.csv", "joint,speed_percent,time_ms,angle_deg\n1,100,300,30\n");
  EXPECT_THAT(errors(cell("{reaction_ms: 10, table: stops.csv, time_ms: 100}")),
              mistake_at("cell.yaml:5", "stops.csv:2: found a stop of 'shoulder'", "velocity"));
}

TEST_F(Stopping, ByAnInlineTableIsAsByAFile) {
  test::write_text(folder_ / "stops.csv", kStopsCsv);
  std::string rows;
  for (const char* row :
       {"joint: 1, load_percent: 50, speed_percent: 50, time_ms: 300, angle_deg: 13",
        "joint: 1, load_percent: 50, speed_percent: 100, time_ms: 280, angle_deg: 24",
        "joint: 1, load_percent: 100, speed_percent: 50, time_ms: 400, angle_deg: 17",
        "joint: 1, load_percent: 100, speed_percent: 100, time_ms: 390, angle_deg: 33",
        "joint: elbow, load_percent: 50, speed_percent: 100, time_ms: 200, angle_deg: 20",
        "joint: elbow, load_percent: 100, speed_percent: 100, time_ms: 250, angle_deg: 28",
        "joint: reach, speed_percent: 100, time_ms: 300, distance_mm: 75"})
    rows += fmt::format("{}{{{}}}", rows.empty() ? "" : ", ", row);
  for (const char* load : {"50", "worst"}) {
    const std::string rest = fmt::format(", load: {}, joints: {{grip: {{time_ms: 60}}}}}}", load);
    const Scene file = scene(cell("{reaction_ms: 10, table: stops.csv" + rest)),
                list = scene(cell("{reaction_ms: 10, table: [" + rows + "]" + rest));
    for (const char* name : {"shoulder", "elbow", "reach", "grip"}) {
      for (const double speed : {0.1, 1.0, 2.0, 5.0}) {
        EXPECT_EQ(stop(file, name).distance(speed), stop(list, name).distance(speed)) << name;
        EXPECT_EQ(stop(file, name).time(speed), stop(list, name).time(speed)) << name;
      }
    }
  }
}

TEST_F(Stopping, ByAnInlineTableIsRefusedAtItsRow) {
  const auto with = [&](const std::string& row) {
    return errors(cell("{reaction_ms: 10, time_ms: 100, table: [\n" + row + "]}"));
  };
  EXPECT_EQ(with("{joint: 1, speed_percent: 100, time_ms: 300, angle_deg: 30}"), "");
  EXPECT_THAT(with("{joint: 1, speed_percent: 100, time_ms: 0.3, angle_deg: 30}"),
              mistake_at("cell.yaml:6:1", "found time_ms '0.3' of the joint '1'"));
  EXPECT_THAT(with("{joint: 1, speed_percent: 100, time_ms: 300, angle: 30}"),
              mistake_at("cell.yaml:6", "unknown key 'angle'", "'angle_deg'"));
  EXPECT_THAT(with("{joint: 1, speed_percent: 100, time_ms: 300, angle_deg: 0.3}"),
              mistake_at("cell.yaml:6:1", "found that 'shoulder' stands", "is a unit wrong"));
  EXPECT_THAT(with("{joint: 1, speed_percent: [], time_ms: 300, angle_deg: 30}"),
              mistake_at("cell.yaml:6", "found an empty list"));
  EXPECT_THAT(with("3"), mistake_at("cell.yaml:6:1", "the number 3", "a row of a stopping table"));
  EXPECT_THAT(with(""), mistake_at("cell.yaml:5", "found an empty list"));
}

TEST_F(Stopping, TheTableIsPartOfTheScenesRevision) {
  const std::string text =
      cell("{reaction_ms: 10, table: stops.csv, joints: {grip: {time_ms: 60}}}");
  test::write_text(folder_ / "stops.csv", kStopsCsv);
  const Scene before = scene(text);
  test::write_text(folder_ / "stops.csv", kStopsCsv + "\n");
  EXPECT_NE(scene(text).revision, before.revision);
  const auto cell = read_good(text, folder_ / "cell.yaml");
  EXPECT_THAT(cell.files, testing::Contains((folder_ / "stops.csv").lexically_normal()));
}

TEST_F(Stopping, OfAJointWithSeveralPositionsIsRefused) {
  std::string urdf = kArmUrdf;
  urdf.replace(urdf.find("<joint name=\"bolt\" type=\"fixed\">"), 32,
               "<joint name=\"bolt\" type=\"floating\">");
  test::write_text(folder_ / "arm.urdf", urdf);
  EXPECT_THAT(errors(cell("{reaction_ms: 10, time_ms: 100}")),
              mistake_at("cell.yaml:5", "'bolt', which has several positions"));
}

// Oracle: each row of the table by itself.
TEST_F(Stopping, ByRandomTablesIsNeverBelowARowOfTheLoadExtensionAndSpeed) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    struct Row {
      int load_below, extension_below;  // the next lower step
      double speed, time, angle;
    };
    std::vector<Row> rows;
    std::string csv = "speed_percent,joint,load_percent,extension_percent,angle_deg,time_ms\n";
    const int loads = random.integer(1, 3), extensions = random.integer(1, 3),
              speeds = random.integer(1, 4);
    for (int load = 1; load <= loads; ++load) {
      for (int extension = 1; extension <= extensions; ++extension) {
        for (int speed = 1; speed <= speeds; ++speed) {
          const int percent = 100 * speed / speeds, time = random.integer(100, 700);
          const double unbraked = 0.01 * percent * 3.0 / kOneDegree * 1e-3 * time;
          const double angle = std::round(100 * random.uniform(0.2, 0.6) * unbraked) / 100;
          rows.push_back({100 * (load - 1) / loads, 100 * (extension - 1) / extensions,
                          0.01 * percent * 3.0, 1e-3 * time, angle * kOneDegree});
          csv += fmt::format("{},1,{},{},{:.2f},{}\n", percent, 100 * load / loads,
                             100 * extension / extensions, angle, time);
        }
      }
    }
    test::write_text(folder_ / "stops.csv", csv);
    const int load = random.integer(2, 100), extension = random.integer(2, 100);
    const Scene arm = scene(cell(
        fmt::format("{{reaction_ms: 10, table: stops.csv, load: {}, extension: {}, time_ms: 100}}",
                    load, extension)));
    const JointStop& found = stop(arm, "shoulder");
    for (int i = 0; i <= 60; ++i) {
      const double speed = 3.0 * i / 60;
      for (const Row& row : rows) {
        if (row.load_below >= load || row.extension_below >= extension || row.speed > speed)
          continue;
        ASSERT_GE(found.distance(speed), row.angle - 1e-12) << speed;
        ASSERT_GE(found.time(speed), row.time - 1e-12) << speed;
      }
    }
  }
}

}  // namespace
}  // namespace clearance
