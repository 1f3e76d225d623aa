// Meshes and robots in the programs: references of true meshes, and cells that were imported. The
// oracle of the distances is the closed form of a ball above two walls.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"
#include "tools/cases/drawn_meshes.hpp"

namespace clearance::test {
namespace {

constexpr int kTicks = 20;

double height(int tick) { return 0.4 - 0.008 * tick; }

class TrueMeshes : public RunsPrograms {
 protected:
  // Two walls stand 100 mm apart. Their only part is the hull, whose top is up to 50 mm from them.
  TrueMeshes() {
    TriangleMesh walls;
    drawn::add_box({-0.1, -0.1, -0.1}, {-0.05, 0.1, 0.1}, walls);
    drawn::add_box({0.05, -0.1, -0.1}, {0.1, 0.1, 0.1}, walls);
    write_text(folder / "walls.obj", drawn::obj_of(walls));
    write_text(folder / "cell.yaml",
               "name: walls\nunits: {length: m, angle: deg}\n"
               "defaults: {age_limit_ms: 50, may_jump: true}\nobjects:\n"
               "  - {name: ball, sphere: {radius: 0.05}}\n"
               "  - {name: walls, fixed: true, mesh: {file: walls.obj, max_parts: 1}}\n"
               "pairs: [{between: [ball, walls]}]\n");
    std::string log = "t_ns,object,px,py,pz,qw,qx,qy,qz\n";
    for (int tick = 0; tick < kTicks; ++tick) {
      log +=
          std::to_string(tick * kTick) + ",ball,0,0," + std::to_string(height(tick)) + ",1,0,0,0\n";
    }
    write_text(folder / "log.csv", log);
    EXPECT_EQ(0, run(kRecord, {"--from-csv", path("log.csv"), "-o", path("run.mcap"), "--cell",
                               path("cell.yaml")}))
        << output;
  }

  // Replays against a table of the distances from the walls, plus `more`.
  int held_against_walls(const std::vector<std::string>& arguments, double more = 0.0) {
    std::string reference = "t_ns,object_a,object_b,distance\n";
    for (int tick = 0; tick < kTicks; ++tick) {
      const double distance = std::hypot(height(tick) - 0.1, 0.05) - 0.05 + more;
      reference += std::to_string(tick * kTick) + ",ball,walls," + std::to_string(distance) + "\n";
    }
    write_text(folder / "reference.csv", reference);
    return run(kReplay, with({"check", "--cell", path("cell.yaml"), path("run.mcap"), "--reference",
                              path("reference.csv")},
                             arguments));
  }
};

TEST_F(TrueMeshes, MayBeFartherAwayThanTheirPartsByTheStatedError) {
  EXPECT_EQ(1, held_against_walls({}));
  EXPECT_EQ(0, held_against_walls({"--true-meshes"})) << output;
  EXPECT_THAT(output, testing::HasSubstr("20 reference distances compared"));
}

TEST_F(TrueMeshes, AreNeitherNearerThanTheirPartsNorFartherThanTheError) {
  EXPECT_EQ(1, held_against_walls({"--true-meshes"}, -0.02));
  EXPECT_EQ(1, held_against_walls({"--true-meshes"}, 0.06));
}

class ImportedJoints : public RunsPrograms {};

// The joints of the shipped arm move, and both runs write the distances of their pairs in every
// tick. The cell leaves out pairs that never meet.
TEST_F(ImportedJoints, GiveTheDistancesOfTheUrdfAlone) {
  std::filesystem::copy(test::places::sources() + "/config/cells/seven_joint_arm", folder / "arm");
  std::string log = "t_ns,joint1,joint2,joint3,joint4,joint5,joint6,joint7,finger\n";
  for (int tick = 0; tick < kTicks; ++tick) {
    log += std::to_string(tick * kTick) + ",0.1,0." + std::to_string(10 + tick) +
           ",-0.3,0.5,0.2,0.4,0.1,0.02\n";
  }
  write_text(folder / "joints.csv", log);
  ASSERT_EQ(0, run(test::places::programs() + "/clearance-scene",
                   {"new", "--robots", path("arm/arm.urdf"), "-o", path("cell.yaml")}))
      << output;
  // The distances by tick and pair.
  const auto table = [&](const char* option, const char* file, const char* csv) {
    EXPECT_EQ(0, run(kReplay, {"check", path("joints.csv"), option, path(file), "--evaluate-all",
                               "--csv", path(csv)}))
        << output;
    std::map<std::string, double> distances;
    std::istringstream rows(read_text(folder / csv));
    std::smatch found;
    for (std::string row; std::getline(rows, row);) {
      if (std::regex_search(row, found, std::regex("^([0-9]+,[0-9]+,[^,]+,[^,]+),[^,]+,([^,]+)")))
        distances[found[1]] = std::stod(found[2]);
    }
    return distances;
  };
  const auto of_urdf = table("--urdf", "arm/arm.urdf", "urdf.csv"),
             of_cell = table("--cell", "cell.yaml", "cell.csv");
  EXPECT_GT(of_cell.size(), 20u * kTicks);
  for (const auto& [pair, distance] : of_cell) {
    ASSERT_TRUE(of_urdf.contains(pair)) << pair;
    EXPECT_NEAR(distance, of_urdf.at(pair), 1e-9) << pair;
  }
}

}  // namespace
}  // namespace clearance::test
