// clearance-scene reduce: the parts, and the model that it names as the cheapest. Oracles: the
// closed form of an L's error, a cell made of the printed models, and the cost of every model from
// its figures.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "tests/shared/child_process.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tools/cases/drawn_meshes.hpp"

namespace clearance {
namespace {

using nlohmann::json;

class Reduction : public testing::Test {
 protected:
  // An L of two bars, each 2 m long and 0.5 m wide and high.
  Reduction() {
    std::ofstream(file("l.obj"))
        << "v 0 0 0\nv 2 0 0\nv 2 0.5 0\nv 0.5 0.5 0\nv 0.5 2 0\nv 0 2 0\n"
           "v 0 0 0.5\nv 2 0 0.5\nv 2 0.5 0.5\nv 0.5 0.5 0.5\nv 0.5 2 0.5\nv 0 2 0.5\n"
           "f 1 3 2\nf 1 4 3\nf 1 5 4\nf 1 6 5\n"
           "f 7 8 9\nf 7 9 10\nf 7 10 11\nf 7 11 12\n"
           "f 1 2 8\nf 1 8 7\nf 2 3 9\nf 2 9 8\nf 3 4 10\nf 3 10 9\n"
           "f 4 5 11\nf 4 11 10\nf 5 6 12\nf 5 12 11\nf 6 1 7\nf 6 7 12\n";
  }

  int run(std::vector<std::string> arguments) {
    test::ChildProcess program(test::places::programs() + "/clearance-scene", std::move(arguments));
    const int status = program.wait();
    output_ = program.output();
    return status;
  }
  json reduced(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"reduce", file("l.obj"), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments), 0) << output_;
    return json::parse(output_).at(0);
  }
  static json model(const json& body, const std::string& name) {
    for (const json& one : body["models"]) {
      if (one["model"] == name) return one;
    }
    ADD_FAILURE() << "no " << name;
    return {};
  }
  std::string file(const std::string& name) const { return (directory_ / name).string(); }

  test::ScratchFolder directory_;
  std::string output_;
};

TEST_F(Reduction, AHullIsAsFarFromAnLAsItsHypotenuseAndTwoPartsAreTheL) {
  const json body = reduced({});
  // The midpoint of the hypotenuse is (1.25, 1.25), at a distance of 0.75 from both bars.
  const double error = model(body, "hull")["error"];
  EXPECT_GE(error, 0.75);
  EXPECT_LE(error, 0.75 * 1.02 + 1e-5);
  const json parts = model(body, "2 parts");
  EXPECT_LE(parts["error"].get<double>(), 0.01);
  for (const json& one : body["models"]) {
    if (one["model"].get<std::string>().find("parts") == std::string::npos) {
      EXPECT_GE(one["error"].get<double>(), error) << one["model"];
    }
  }
}

TEST_F(Reduction, AHullAroundTwoBlocksIsHalfAsFarFromThemAsTheyAreApart) {
  std::ofstream(file("two.yaml"))
      << "name: two\nunits: {length: m, angle: rad}\nobjects:\n"
         "  - name: blocks\n    parts:\n      - box: {size: [1, 1, 1]}\n"
         "      - {box: {size: [1, 1, 1]}, pose: {xyz: [2, 0, 0]}}\n"
         "  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], "
         "offset: -5}}\npairs: [{between: [blocks, floor]}]\n";
  ASSERT_EQ(run({"reduce", file("two.yaml"), "--object", "blocks", "--json"}), 0) << output_;
  const json body = json::parse(output_).at(0);
  EXPECT_GE(model(body, "hull")["error"].get<double>(), 0.5);
  EXPECT_LE(model(body, "hull")["error"].get<double>(), 0.5 * 1.02 + 1e-5);
  EXPECT_LE(model(body, "2 parts")["error"].get<double>(), 1e-12);
}

// The hull of a box without a lid is as good as any two parts. Its five walls are exact.
TEST_F(Reduction, TriesMorePartsWhereTwoBringNothing) {
  std::ofstream(file("crate.obj")) << drawn::obj_of(drawn::crate_of_solids());
  ASSERT_EQ(run({"reduce", file("crate.obj"), "--json"}), 0) << output_;
  const json body = json::parse(output_).at(0);
  for (const json& one : body["models"]) EXPECT_NE(one["model"], "2 parts");
  EXPECT_LE(model(body, "5 parts")["error"].get<double>(), 1e-6);
}

TEST_F(Reduction, FailsWhereNoModelIsWithinTheTolerance) {
  EXPECT_EQ(run({"reduce", file("l.obj"), "--tolerance", "0"}), 1);
  EXPECT_NE(output_.find("l: no model is within the tolerance of 0 m"), std::string::npos)
      << output_;
}

TEST_F(Reduction, PartsThatWereChosenMakeACell) {
  const json body = reduced({"--tolerance", "0.05"});
  const json parts = model(body, "2 parts");
  ASSERT_TRUE(parts["chosen"]);
  std::ofstream cell(file("cell.yaml"));
  cell << "name: l\nunits: {length: m, angle: rad}\nobjects:\n  - name: l\n    parts:\n";
  std::istringstream lines(parts["part"].get<std::string>());
  for (std::string line; std::getline(lines, line);) cell << "      " << line << "\n";
  cell << "  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: -5}}\n"
          "pairs: [{between: [l, floor]}]\n";
  cell.close();
  const CellResult read = read_cell(file("cell.yaml"));
  ASSERT_TRUE(std::holds_alternative<Cell>(read));
  EXPECT_EQ(std::get<Cell>(read).scene.objects[0].parts.size(), 2u);
}

// The schedule is described in tools/scene/watching.hpp. Nine ticks of 1 ms are subtracted, and the
// remainder is at least 16 / 4096 m and four ticks.
TEST_F(Reduction, TheCheapestModelIsTheOneThatCostsLeastOfAllThatKeepThePairAway) {
  const double speed = 2.0;
  const json body = reduced({"--distance", "0.1", "1", "30", "--speed", "2"});
  ASSERT_EQ(body["cheapest"].size(), 3u);
  for (const json& asked : body["cheapest"]) {
    ASSERT_TRUE(asked.contains("model")) << asked;
    double least = 1e300;
    for (const json& one : body["models"]) {
      const double left =
          asked["distance"].get<double>() - one["error"].get<double>() - 0.009 * speed;
      if (left < 16.0 / 4096.0 + 0.004 * speed) continue;
      least = std::min(least, one["ns_cold"].get<double>() * speed / left);
    }
    EXPECT_NEAR(asked["ns_per_s"].get<double>(), least, 1e-9 * least);
  }
  EXPECT_NE(body["cheapest"][0]["model"].get<std::string>().find("parts"), std::string::npos);
  EXPECT_EQ(body["cheapest"][2]["model"].get<std::string>().find("parts"), std::string::npos);
}

TEST_F(Reduction, NoModelKeepsAPairAwayThatIsWithinAFewTicks) {
  const json body = reduced({"--distance", "0.01", "--speed", "2"});
  EXPECT_FALSE(body["cheapest"][0].contains("model"));
}

TEST_F(Reduction, DrawsThePictureAndWritesThePageBesideIt) {
  const std::vector<std::string> asked = {"reduce", file("l.obj"), "--distance",
                                          "1",      "--plot",      file("models.svg")};
  ASSERT_EQ(run(asked), 0) << output_;
  std::stringstream page;
  page << std::ifstream(file("models.md")).rdbuf();
  EXPECT_NE(page.str().find("(models.svg)"), std::string::npos);
  EXPECT_NE(page.str().find("| 2 parts |"), std::string::npos) << page.str();
  EXPECT_GT(std::filesystem::file_size(file("models.svg")), 1000u);
  EXPECT_EQ(run(asked), 1) << "they exist by now";
}

TEST_F(Reduction, APictureNeedsADistance) {
  EXPECT_EQ(run({"reduce", file("l.obj"), "--plot", file("models.svg")}), 2);
}

}  // namespace
}  // namespace clearance
