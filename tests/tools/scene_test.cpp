// clearance-scene itself: its output and its exit status.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/shared/child_process.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::ChildProcess;

class SceneProgram : public testing::Test {
 protected:
  SceneProgram() {
    std::ofstream(directory_ / "robot.urdf") << "<robot name=\"two\">\n"
                                                "<link name=\"a\"><collision><geometry><sphere "
                                                "radius=\"0.1\"/></geometry></collision></link>\n"
                                                "<link name=\"b\"><collision><geometry><box "
                                                "size=\"1 1 1\"/></geometry></collision></link>\n"
                                                "</robot>\n";
  }

  int run(std::vector<std::string> arguments) {
    ChildProcess program(test::places::programs() + "/clearance-scene", std::move(arguments));
    const int status = program.wait();
    output_ = program.output();
    return status;
  }

  std::string file(const std::string& name) const { return (directory_ / name).string(); }

  test::ScratchFolder directory_;
  std::string output_;
};

TEST_F(SceneProgram, WritesACellThatIsGood) {
  EXPECT_EQ(run({"import", file("robot.urdf"), "-o", file("cell.yaml")}), 0) << output_;
  EXPECT_NE(output_.find("two: 2 objects (2 moving, 0 fixed)"), std::string::npos) << output_;
  EXPECT_TRUE(std::filesystem::exists(file("cell.yaml")));
}

// Three balls in a row on two joints.
std::string chain_urdf() {
  std::string urdf = "<robot name=\"chain\">\n";
  for (const char* link : {"a", "b", "c"}) {
    urdf += std::string("<link name=\"") + link +
            "\"><collision><geometry><sphere radius=\"0.1\"/></geometry></collision></link>\n";
  }
  return urdf +
         "<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint>\n"
         "<joint name=\"k\" type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/></joint>\n"
         "</robot>\n";
}

TEST_F(SceneProgram, SaysWhichNeighboursItLeavesOutWithoutAnSrdf) {
  std::ofstream(directory_ / "chain.urdf") << chain_urdf();
  EXPECT_EQ(run({"import", file("chain.urdf"), "-o", file("cell.yaml")}), 0) << output_;
  EXPECT_NE(output_.find("note: no SRDF: these neighbours are not watched: a - b, b - c"),
            std::string::npos)
      << output_;
  EXPECT_NE(output_.find("1 pair"), std::string::npos) << output_;
}

TEST_F(SceneProgram, RefusesTheSrdfOfAnotherRobotAndWritesNothing) {
  std::ofstream(directory_ / "chain.urdf") << chain_urdf();
  std::ofstream(directory_ / "other.srdf")
      << "<robot name=\"other\">\n<disable_collisions link1=\"a\" link2=\"x\"/>\n</robot>\n";
  EXPECT_EQ(
      run({"import", file("chain.urdf"), "--srdf", file("other.srdf"), "-o", file("cell.yaml")}),
      1);
  EXPECT_NE(output_.find("other.srdf:1:1: found the robot 'other'"), std::string::npos) << output_;
  EXPECT_NE(output_.find("other.srdf:2:1: found the link 'x'"), std::string::npos) << output_;
  EXPECT_FALSE(std::filesystem::exists(file("cell.yaml")));
}

TEST_F(SceneProgram, WritesOverAFileOnlyWhenForced) {
  std::ofstream(file("cell.yaml")) << "precious";
  EXPECT_EQ(run({"import", file("robot.urdf"), "-o", file("cell.yaml")}), 1);
  EXPECT_NE(output_.find("exists; --force overwrites it"), std::string::npos) << output_;
  EXPECT_EQ(std::filesystem::file_size(file("cell.yaml")), 8u);
  EXPECT_EQ(run({"import", file("robot.urdf"), "-o", file("cell.yaml"), "--force"}), 0) << output_;
}

TEST_F(SceneProgram, ACellThatIsNoGoodIsWrittenAndExplained) {
  std::ofstream(directory_ / "alone.urdf")
      << "<robot name=\"alone\"><link name=\"a\"><collision><geometry><sphere "
         "radius=\"0.1\"/></geometry>"
         "</collision></link></robot>\n";
  EXPECT_EQ(run({"import", file("alone.urdf"), "-o", file("cell.yaml")}), 3);
  EXPECT_NE(output_.find("cell.yaml:"), std::string::npos) << output_;
}

TEST_F(SceneProgram, WhatCannotBeReadOrWrittenEndsWithOne) {
  std::ofstream(directory_ / "broken.urdf") << "<robot";
  EXPECT_EQ(run({"import", file("broken.urdf"), "-o", file("cell.yaml")}), 1);
  EXPECT_EQ(run({"import", file("robot.urdf"), "-o", file("nowhere/cell.yaml")}), 1);
}

TEST_F(SceneProgram, WritesAWarehouseOfAsManyObjectsAsAskedFor) {
  EXPECT_EQ(run({"warehouse", "61", "-o", file("warehouse.yaml")}), 0) << output_;
  EXPECT_NE(output_.find("warehouse_61: 61 objects (12 moving, 49 fixed)"), std::string::npos)
      << output_;
}

// A cell with a block of two parts, 1 m apart, and a floor.
constexpr const char* kTwoParts = R"(name: two_parts
units: {length: m, angle: rad}
objects:
  - name: block
    parts:
      - box: {size: [1, 1, 1]}
      - {box: {size: [1, 1, 1]}, pose: {xyz: [2, 0, 0]}}
  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: -5}}
pairs: [{between: [block, floor]}]
)";

TEST_F(SceneProgram, ReportsTheModelsOfEachObjectAndTheirErrors) {
  std::ofstream(directory_ / "cell.yaml") << kTwoParts;
  ASSERT_EQ(run({"report", file("cell.yaml"), "--json"}), 0) << output_;
  const auto objects = nlohmann::json::parse(output_);
  ASSERT_EQ(objects.size(), 2u);
  const auto& block = objects[0];
  EXPECT_EQ(block["object"], "block");
  EXPECT_EQ(block["full"]["parts"], 2);
  EXPECT_EQ(block["full"]["facets"], 12);
  EXPECT_EQ(block["hull"]["facets"], 6);
  EXPECT_GE(block["hull"]["error"], 0.5);  // halfway between the two
  EXPECT_LE(block["hull"]["error"], 0.5 / 0.98);
  EXPECT_GE(block["sphere"]["radius"], 1.5);
  EXPECT_FALSE(objects[1].contains("sphere"));
  EXPECT_FALSE(objects[1].contains("hull"));

  ASSERT_EQ(run({"report", file("cell.yaml")}), 0) << output_;
  EXPECT_NE(output_.find("block "), std::string::npos) << output_;
  EXPECT_NE(output_.find("2 objects, 1 with a hull"), std::string::npos) << output_;
}

TEST_F(SceneProgram, ReportsTheErrorsOfACellThatIsNoGood) {
  std::ofstream(directory_ / "cell.yaml") << "name: empty\n";
  EXPECT_EQ(run({"report", file("cell.yaml")}), 3);
  EXPECT_NE(output_.find("cell.yaml:"), std::string::npos) << output_;
}

TEST_F(SceneProgram, WrongUsageEndsWithTwo) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"warehouse", "100"}), 2);
  EXPECT_EQ(run({"warehouse", "10", "-o", file("cell.yaml")}), 2);
  EXPECT_EQ(run({"report", "x.yaml", "warehouse", "100"}), 2);
  EXPECT_EQ(run({"import", file("robot.urdf"), "-o", file("cell.yaml"), "--package", "x"}), 2);
}

TEST_F(SceneProgram, HelpNamesRequiredArgumentsFirst) {
  ASSERT_EQ(run({"import", "--help"}), 0);
  EXPECT_NE(output_.find("Usage: clearance-scene import URDF --output TEXT [OPTIONS]"),
            std::string::npos)
      << output_;
  EXPECT_LT(output_.find("-o,--output"), output_.find("--srdf")) << output_;
  ChildProcess daemon(test::places::programs() + "/clearanced", {"--help"});
  ASSERT_EQ(daemon.wait(), 0);
  EXPECT_NE(daemon.output().find(
                "Usage: clearanced (CELL | --urdf TEXT | --robot-description TEXT) [OPTIONS]"),
            std::string::npos)
      << daemon.output();
}

TEST_F(SceneProgram, HelpNamesSubcommandsAndArgumentsBeforeOptions) {
  ASSERT_EQ(run({"--help"}), 0);
  EXPECT_LT(output_.find("  report "), output_.find("Options:")) << output_;
  ASSERT_EQ(run({"report", "--help"}), 0);
  EXPECT_LT(output_.find("  CELL "), output_.find("Options:")) << output_;
  EXPECT_LT(output_.find("--json"), output_.find("--help")) << output_;
}

// A post, a slide beside it, a tip that the slide moves through the post, and a body far from all
// of them.
std::string crane_urdf() {
  const auto link = [](const std::string& name, const std::string& at, const std::string& radius) {
    return "<link name=\"" + name + "\"><collision><origin xyz=\"" + at +
           "\"/><geometry><sphere radius=\"" + radius + "\"/></geometry></collision></link>\n";
  };
  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& child, const std::string& limits) {
    return "<joint name=\"" + name + "\" type=\"prismatic\"><parent link=\"" + parent +
           "\"/><child link=\"" + child + "\"/><axis xyz=\"1 0 0\"/><limit " + limits +
           " velocity=\"1\"/></joint>\n";
  };
  return "<robot name=\"crane\">\n" + link("post", "0 0 0", "0.5") + link("slide", "0 3 0", "0.1") +
         link("tip", "0 0 0", "0.1") + link("far", "0 9 0", "0.1") +
         joint("a", "post", "slide", "lower=\"0\" upper=\"0.1\"") +
         joint("b", "slide", "tip", "lower=\"-2\" upper=\"2\"") +
         joint("c", "tip", "far", "lower=\"0\" upper=\"1\"") + "</robot>\n";
}

TEST_F(SceneProgram, ProposesPairsThatMayTouchBySampling) {
  std::ofstream(directory_ / "crane.urdf") << crane_urdf();
  const std::vector<std::string> arguments = {"allow", file("crane.urdf"), "--samples", "2000"};
  ASSERT_EQ(run(arguments), 0) << output_;
  const std::string proposed = output_;
  for (const char* pair : {"link1=\"post\" link2=\"slide\" reason=\"Adjacent\"",
                           "link1=\"slide\" link2=\"tip\" reason=\"Adjacent\"",
                           "link1=\"tip\" link2=\"far\" reason=\"Adjacent\"",
                           "link1=\"post\" link2=\"tip\" reason=\"Default\"",
                           "link1=\"post\" link2=\"far\" reason=\"Never\"",
                           "link1=\"slide\" link2=\"far\" reason=\"Never\""}) {
    EXPECT_NE(proposed.find(pair), std::string::npos) << pair << " in\n" << proposed;
  }
  // The tip's joint is within 0.6 m of the post for 0.3 of its range.
  const std::size_t at =
      proposed.find("in contact in", proposed.find("link2=\"tip\" reason=\"Def"));
  EXPECT_NEAR(std::stod(proposed.substr(at + 14)), 600.0, 60.0) << proposed;
  ASSERT_EQ(run(arguments), 0);
  EXPECT_EQ(output_, proposed);  // the same seed
}

// The far body passes the post at 0.03 m.
TEST_F(SceneProgram, AllowsNoPairAsNeverInContactThatCameNear) {
  std::string urdf = crane_urdf();
  urdf.replace(urdf.find("0 9 0"), 5, "0 0.63 0");
  std::ofstream(directory_ / "crane.urdf") << urdf;
  std::vector<std::string> arguments = {"allow", file("crane.urdf"), "--samples", "2000"};
  const std::string never = "link1=\"post\" link2=\"far\" reason=\"Never\"";
  ASSERT_EQ(run(arguments), 0) << output_;
  EXPECT_EQ(output_.find(never), std::string::npos) << output_;
  EXPECT_NE(output_.find("near misses, which stay watched: "), std::string::npos) << output_;
  EXPECT_NE(output_.find("(--samples 2000), but the least distance is within --never-margin 0.05"),
            std::string::npos)
      << output_;
  const std::string miss = "\n  post - far: ";
  ASSERT_NE(output_.find(miss), std::string::npos) << output_;
  EXPECT_NEAR(std::stod(output_.substr(output_.find(miss) + miss.size())), 0.03, 0.001);
  arguments.insert(arguments.end(), {"--never-margin", "0.02"});
  ASSERT_EQ(run(arguments), 0) << output_;
  EXPECT_NE(output_.find(never), std::string::npos) << output_;
  EXPECT_EQ(output_.find("near misses"), std::string::npos) << output_;
  arguments.back() = "-1";
  EXPECT_EQ(run(arguments), 2);
}

TEST_F(SceneProgram, ComparesItsProposalWithAnSrdfAndWritesItForACell) {
  std::ofstream(directory_ / "crane.urdf") << crane_urdf();
  std::ofstream(directory_ / "crane.srdf")
      << "<robot name=\"crane\">\n"
         "<disable_collisions link1=\"post\" link2=\"slide\" reason=\"Adjacent\"/>\n"
         "<disable_collisions link1=\"slide\" link2=\"tip\" reason=\"Adjacent\"/>\n"
         "<disable_collisions link1=\"tip\" link2=\"far\" reason=\"Adjacent\"/>\n"
         "<disable_collisions link1=\"post\" link2=\"far\" reason=\"Never\"/>\n"
         "<disable_collisions link1=\"slide\" link2=\"far\" reason=\"Never\"/>\n</robot>\n";
  ASSERT_EQ(run({"allow", file("crane.urdf"), "--srdf", file("crane.srdf"), "--as", "cell",
                 "--samples", "500", "-o", file("allowed.yaml")}),
            0)
      << output_;
  EXPECT_NE(output_.find("5 of 6 pairs as in the SRDF: 5 left out by both, 0 watched by both"),
            std::string::npos)
      << output_;
  EXPECT_NE(output_.find("post - tip: watched by the SRDF, Default here; in contact in "),
            std::string::npos)
      << output_;
  std::ifstream written(directory_ / "allowed.yaml");
  const std::string text((std::istreambuf_iterator<char>(written)), {});
  EXPECT_NE(text.find("- {between: [\"post\", \"far\"], reason: \"Never: in contact in 0 of 500 "),
            std::string::npos)
      << text;
}

// A cell of the chain, whose joints are uncertain, and a post.
std::string uncertain_chain(const std::string& joints) {
  return "name: chain\nunits: {length: m, angle: rad}\nrobots: [{name: chain, urdf: chain.urdf}]\n"
         "objects: [{name: post, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2, 0, 0]}}]\n"
         "pairs: [{between: [chain, post]}]\nerrors: {joints: {position: " +
         joints + ", translation: 0.001}}\n";
}

TEST_F(SceneProgram, ListsWhatEachJointAddsToThePairsBounds) {
  std::ofstream(directory_ / "chain.urdf") << chain_urdf();
  std::ofstream(directory_ / "cell.yaml") << uncertain_chain("0.01");
  EXPECT_EQ(run({"errors", file("cell.yaml"), "--joint", "j=0.5"}), 0) << output_;
  EXPECT_NE(output_.find("post - c"), std::string::npos) << output_;
  EXPECT_NE(output_.find("1.00 the joint 'k'"), std::string::npos) << output_;
  EXPECT_EQ(run({"errors", file("cell.yaml"), "--joint", "jj=0.5"}), 1);
  EXPECT_NE(output_.find("jj"), std::string::npos) << output_;
}

TEST_F(SceneProgram, FailsWhereStatedErrorsDoNotExplainMeasuredPlaces) {
  std::ofstream(directory_ / "chain.urdf") << chain_urdf();
  std::ofstream(directory_ / "cell.yaml") << uncertain_chain("0.01");
  std::ofstream(directory_ / "near.csv") << "j,k,x,y,z\n0.1,0.2,0.0015,0,0\n0.2,0,0,-0.0005,0\n";
  std::ofstream(directory_ / "far.csv") << "j,k,x,y,z\n0.1,0.2,0.0025,0,0\n";
  const std::string cell = file("cell.yaml");
  EXPECT_EQ(run({"errors", cell, "--measured", file("near.csv"), "--link", "c"}), 0) << output_;
  EXPECT_NE(output_.find("2 places"), std::string::npos) << output_;
  EXPECT_EQ(run({"errors", cell, "--measured", file("far.csv"), "--link", "c"}), 1) << output_;
  EXPECT_NE(output_.find("1.25 times"), std::string::npos) << output_;
  EXPECT_EQ(run({"errors", cell, "--measured", file("far.csv"), "--link", "d"}), 1) << output_;
  EXPECT_EQ(run({"errors", cell, "--measured", file("far.csv")}), 2) << output_;
}

// The chain with a stop of each joint, beside a post.
std::string stopping_chain(const std::string& stopping) {
  return "name: chain\nunits: {length: m, angle: deg}\nrobots: [{name: chain, urdf: chain.urdf, "
         "joints: {j: {velocity: 2}, k: {velocity: 4}}" +
         stopping +
         "}]\nobjects: [{name: post, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2, 0, 0]}}]\n"
         "pairs: [{between: [chain, post]}]\n";
}

TEST_F(SceneProgram, PrintsAndPlotsHowFarEachJointGoesOn) {
  std::ofstream(directory_ / "chain.urdf") << chain_urdf();
  std::ofstream(directory_ / "stops.csv")
      << "joint,speed_percent,time_ms,angle_deg\n1,50,300,8\n1,100,280,16\n";
  std::ofstream(directory_ / "cell.yaml") << stopping_chain(
      ", stopping: {reaction_ms: 40, path: kept, table: stops.csv, joints: {k: "
      "{time_ms: 200, acceleration: 500}}}");
  EXPECT_EQ(run({"stops", file("cell.yaml")}), 0) << output_;
  EXPECT_EQ(output_,
            "chain: category 1, brakes act after 40 ms, the path is kept\n"
            "  joint                     from, per s    goes on for    in, ms\n"
            "  j                           57.30 deg      8.000 deg       300\n"
            "  j                          114.59 deg     16.000 deg       300\n"
            "  k                           75.63 deg     15.126 deg       200\n"
            "  k                          151.26 deg     30.252 deg       200\n"
            "  k                          229.18 deg     45.837 deg       200\n"
            "  k                      gains at most 500.00 deg per s each second\n");
  EXPECT_EQ(run({"stops", file("cell.yaml"), "--plot", file("stops.svg")}), 0) << output_;
  std::ifstream plot(file("stops.svg"));
  const std::string svg((std::istreambuf_iterator<char>(plot)), {});
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("percent of the full speed"), std::string::npos);
  EXPECT_NE(svg.find("j, deg"), std::string::npos);
}

TEST_F(SceneProgram, PrintsWhichLoadCountsForTheStops) {
  std::ofstream(directory_ / "chain.urdf") << chain_urdf();
  std::ofstream(directory_ / "stops.csv") << "joint,load_percent,speed_percent,time_ms,angle_deg\n"
                                             "1,50,100,200,8\n1,100,100,300,16\n";
  const auto printed = [&](const std::string& mass) {
    std::string cell = stopping_chain(
        ", stopping: {reaction_ms: 40, table: stops.csv, time_ms: 200, load: {full: 4, tool: "
        "0.5}}");
    cell.insert(cell.find("}]\npairs"),
                "}, {name: part, sphere: {radius: 0.01}, attached: {to: c}" + mass);
    std::ofstream(directory_ / "cell.yaml") << cell;
    EXPECT_EQ(run({"stops", file("cell.yaml")}), 0) << output_;
    return output_;
  };
  EXPECT_NE(printed(", mass: 1").find("rows up to 50 % of the load, for 1.5 kg of 4 kg\n"),
            std::string::npos)
      << output_;
  EXPECT_NE(printed("").find("rows up to 100 % of the load, since not all that it carries has"),
            std::string::npos)
      << output_;
}

TEST_F(SceneProgram, SaysThatACellStatesNoStopsOrWhyItsTableIsRefused) {
  std::ofstream(directory_ / "chain.urdf") << chain_urdf();
  std::ofstream(directory_ / "cell.yaml") << stopping_chain("");
  EXPECT_EQ(run({"stops", file("cell.yaml")}), 1);
  EXPECT_NE(output_.find("the cell states no stops; expected `stopping` of a robot"),
            std::string::npos)
      << output_;
  std::ofstream(directory_ / "stops.csv")
      << "joint,speed_percent,time_ms,angle_deg\n1,50,300,8\n1,100,280,0.28\n";
  std::ofstream(directory_ / "cell.yaml")
      << stopping_chain(", stopping: {reaction_ms: 40, table: stops.csv, time_ms: 200}");
  EXPECT_EQ(run({"stops", file("cell.yaml")}), 3);
  EXPECT_NE(output_.find("stops.csv:3: found that 'j' stands"), std::string::npos) << output_;
}

}  // namespace
}  // namespace clearance
