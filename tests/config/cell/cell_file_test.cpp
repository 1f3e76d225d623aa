#include "config/cell/cell_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/places.hpp"

namespace clearance {
namespace {

using test::mistake_at;

TEST(CellFile, DefaultsAreThoseOfTheReference) {
  const Cell cell = read_good("name: test\nunits: {length: m, angle: deg}\n" + kBoxes);
  const Scene& scene = cell.scene;
  EXPECT_EQ(scene.name, "test");
  EXPECT_EQ(scene.rate_hz, 1000.0);
  EXPECT_EQ(scene.budget, 2000u);
  EXPECT_EQ(scene.future_limit_ns, 5'000'000);
  EXPECT_EQ(cell.domain, std::nullopt);
  EXPECT_EQ(cell.partition, "");
  EXPECT_EQ(cell.topics.distances, "clearance/distances");
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[0].margin, 0.0);
  EXPECT_EQ(scene.objects[0].max_speed, kInfinity);
  EXPECT_EQ(scene.objects[0].age_limit_ns, 20'000'000);
  EXPECT_FALSE(scene.objects[0].fixed);
  EXPECT_TRUE(scene.objects[2].fixed);
  EXPECT_EQ(scene.objects[2].max_speed, 0.0) << "it is at rest";
  EXPECT_FALSE(scene.objects[2].parts[0].shape.bounded());
}

TEST(CellFile, EverySettingArrives) {
  const Cell cell = read_good(
      "name: test\nunits: {length: mm, angle: deg}\nrate_hz: 250\nbudget: 77\nrefresh_s: 3\n"
      "future_limit_ms: 2.5\nresponse_limit_ms: 40.5\n"
      "dds: {domain: 42, partition: cell_7, topics: {poses: a/poses, zones: b_zones}}\n"
      "defaults: {margin: 4, max_speed: 1500, age_limit_ms: 12, source: arm}\n"
      "objects:\n"
      "  - {name: left, box: {size: [100, 200, 300]}}\n"
      "  - {name: right, margin: 7, max_speed: 900, age_limit_ms: 1, frozen_limit_ms: 400, "
      "may_jump: true, source: "
      "tracker, sphere: {radius: 50, centre: [1, 2, 3]}}\n"
      "  - name: table\n"
      "    fixed: true\n"
      "    pose: {xyz: [1000, 0, -500], rpy: [0, 0, 90]}\n"
      "    parts: [{name: top, box: {size: [1, 1, 1]}, pose: {xyz: [300, 0, 0]}}]\n"
      "pairs: [{between: [left, right], publish: false}, {between: [left, table]}]\n"
      "zones: [{name: slow, between: [left, table], enter_below: 120, leave_above: 150}]\n");
  const Scene& scene = cell.scene;
  EXPECT_EQ(scene.rate_hz, 250.0);
  EXPECT_EQ(scene.budget, 77u);
  EXPECT_EQ(scene.refresh_s, 3.0);
  EXPECT_EQ(scene.response_limit_ns, 40'500'000);
  EXPECT_EQ(scene.future_limit_ns, 2'500'000);
  EXPECT_EQ(cell.domain, 42u);
  EXPECT_EQ(cell.partition, "cell_7");
  EXPECT_EQ(cell.topics.poses, "a/poses");
  EXPECT_EQ(cell.topics.zones, "b_zones");
  EXPECT_EQ(cell.topics.health, "clearance/health");
  EXPECT_EQ(scene.objects[0].margin, 0.004);
  EXPECT_EQ(scene.objects[0].max_speed, 1.5);
  EXPECT_EQ(scene.objects[1].margin, 0.007);
  EXPECT_EQ(scene.objects[1].max_speed, 0.9);
  EXPECT_EQ(scene.objects[1].age_limit_ns, 1'000'000);
  EXPECT_EQ(scene.objects[0].frozen_limit_ns, 0);
  EXPECT_EQ(scene.objects[1].frozen_limit_ns, 400'000'000);
  EXPECT_FALSE(scene.objects[0].may_jump);
  EXPECT_TRUE(scene.objects[1].may_jump);
  EXPECT_EQ(scene.objects[0].source, "arm");
  EXPECT_EQ(scene.objects[1].source, "tracker");
  EXPECT_EQ(scene.objects[1].parts[0].shape.radius, 0.05);
  EXPECT_EQ(scene.objects[2].world_from_object.position, Vec3(1.0, 0.0, -0.5));
  EXPECT_EQ(scene.objects[2].parts[0].object_from_part.position, Vec3(0.3, 0.0, 0.0));
  EXPECT_EQ(scene.objects[2].parts[0].name, "top");
  ASSERT_EQ(scene.pairs.size(), 2u);
  EXPECT_FALSE(scene.pairs[0].publish);
  EXPECT_TRUE(scene.pairs[1].publish);
  ASSERT_EQ(scene.zones.size(), 1u);
  EXPECT_EQ(scene.zones[0].enter_below, 0.12);
  EXPECT_EQ(scene.zones[0].leave_above, 0.15);
  EXPECT_EQ(scene.zones[0].pairs, std::vector<std::uint32_t>{1});
}

// kBoxes in mm, with a zone for people over 'right' and a robot, 'left'.
std::string with_separation(const std::string& terms) {
  return "name: test\nunits: {length: mm, angle: deg}\n" + kBoxes +
         "  - {between: [left, right], publish: false}\n"
         "zones:\n"
         "  - {name: people, between: [left, right], enter_below: 1, leave_above: 1,\n"
         "     separation: {human: right, " +
         terms + "}}\n";
}

TEST(CellFile, EveryTermOfASeparationArrives) {
  const Scene scene = scene_of(
      with_separation("human_speed: 2000, human_speed_measured: true, human_acceleration: 3000,\n"
                      "robot_speed: 250, robot_acceleration: 4000, reaction_time_ms: 100, "
                      "stopping_time_ms: 250.5,\n"
                      "stopping_distance: 125, stopping_speed: 1000, intrusion_distance: 850,\n"
                      "human_uncertainty: 40, robot_uncertainty: 5"));
  ASSERT_TRUE(scene.zones.at(0).separation);
  const Separation& terms = *scene.zones[0].separation;
  EXPECT_EQ(terms.human_speed, 2.0);
  EXPECT_TRUE(terms.human_speed_is_measured);
  EXPECT_EQ(terms.human_acceleration, 3.0);
  EXPECT_EQ(terms.robot_speed, 0.25);
  EXPECT_EQ(terms.robot_acceleration, 4.0);
  EXPECT_EQ(terms.reaction_time_ns, 100'000'000);
  EXPECT_EQ(terms.stopping_time_ns, 250'500'000);
  EXPECT_EQ(terms.stopping_distance, 0.125);
  EXPECT_EQ(terms.stopping_speed, 1.0);
  EXPECT_EQ(terms.intrusion_distance, 0.85);
  EXPECT_EQ(terms.human_uncertainty, 0.04);
  EXPECT_EQ(terms.robot_uncertainty, 0.005);
  EXPECT_EQ(terms.human_is_first, std::vector<std::uint8_t>{0});
}

TEST(CellFile, OfTheReactionOfASeparationTheDaemonsPartMayBeMeasured) {
  const Scene scene = scene_of(
      with_separation("controller_time_ms: 60, stopping_time_ms: 250, stopping_distance: 125, "
                      "intrusion_distance: 0"));
  EXPECT_TRUE(scene.zones.at(0).separation->reaction_is_measured);
  EXPECT_EQ(scene.zones[0].separation->reaction_time_ns, 60'000'000);
}

TEST(CellFile, ASeparationHasDefaultsOfTheStandardAndItsPairsArePublished) {
  const Scene scene = scene_of(
      with_separation("reaction_time_ms: 100, stopping_time_ms: 250, stopping_distance: 125, "
                      "intrusion_distance: 0"));
  const Separation& terms = *scene.zones.at(0).separation;
  EXPECT_FALSE(terms.human_speed);
  for (const Object& object : scene.objects) EXPECT_EQ(object.approach_speed, 1.6);
  EXPECT_FALSE(terms.human_speed_is_measured);
  EXPECT_FALSE(terms.reaction_is_measured);
  EXPECT_EQ(scene.response_limit_ns, Scene::kNoLimit);
  EXPECT_EQ(terms.robot_speed, kInfinity);
  EXPECT_EQ(terms.stopping_speed, 0.0);
  EXPECT_EQ(terms.human_uncertainty + terms.robot_uncertainty + terms.robot_acceleration, 0.0);
  for (const std::uint32_t pair : scene.zones[0].pairs) EXPECT_TRUE(scene.pairs[pair].publish);
}

TEST(CellFile, CurvedAndRoundedShapesAreWhatTheNumbersSay) {
  const Scene scene = scene_of(
      cell_text("objects:\n"
                "  - name: a\n"
                "    parts:\n"
                "      - ellipsoid: {semi_axes: [1, 2, 3], rounding: 0.25}\n"
                "      - cylinder: {radius: 0.5, length: 3}\n"
                "      - cone: {radius: 2, length: 1}\n"
                "      - truncated_cone: {lower_radius: 0, upper_radius: 1, length: 4}\n"
                "      - box: {size: [1, 1, 1], rounding: 0.125}\n"
                "      - prism: {base: [[0, 0], [1, 0], [0, 1]], z: [0, 1], rounding: 0.5}\n"
                "      - polyhedron: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],\n"
                "                     rounding: 0.75}\n"
                "  - {name: b, sphere: {radius: 1}}\n"
                "pairs: [{between: [a, b]}]\n"));
  ASSERT_EQ(scene.objects.size(), 2u);
  const std::vector<Part>& parts = scene.objects[0].parts;
  EXPECT_EQ(parts[0].shape.curved.semi_axes, Vec3(1, 2, 3));
  EXPECT_EQ(parts[0].shape.radius, 0.25);
  EXPECT_EQ(parts[1].shape.curved.discs, (std::array{Disc{-1.5, 0.5}, Disc{1.5, 0.5}}));
  EXPECT_EQ(parts[2].shape.curved.discs, (std::array{Disc{-0.5, 2}, Disc{0.5, 0}}));
  EXPECT_EQ(parts[3].shape.curved.discs, (std::array{Disc{-2, 0}, Disc{2, 1}}));
  EXPECT_EQ(parts[3].name, "truncated_cone3");
  EXPECT_EQ(parts[4].shape.radius, 0.125);
  EXPECT_EQ(parts[5].shape.radius, 0.5);
  EXPECT_EQ(parts[6].shape.radius, 0.75);
}

TEST(CellFile, RightAnglesInDegreesAreExact) {
  const Scene scene = scene_of(
      cell_text("objects:\n"
                "  - {name: a, fixed: true, pose: {rpy: [90, 0, -90]}, box: {size: [1, 1, 1]}}\n"
                "  - {name: b, fixed: true, pose: {rpy: [0, 450, 180]}, box: {size: [1, 1, 1]}}\n"
                "  - {name: c, box: {size: [1, 1, 1]}}\n"
                "pairs: [{between: [a, c]}, {between: [b, c]}]\n"));
  const RelativePose turned = relative_pose(Pose{}, scene.objects[0].world_from_object);
  EXPECT_EQ(turned.rotation_error, 0.0);
  // Roll is applied first: y to z, z to -y. The yaw of -90 degrees follows: x to -y, y to x.
  EXPECT_EQ(turned.rotation * Vec3::UnitX(), -Vec3::UnitY());
  EXPECT_EQ(turned.rotation * Vec3::UnitY(), Vec3::UnitZ());
  // Two components are exactly half of a square's diagonal, and the zeros are exact.
  const Eigen::Quaterniond half = scene.objects[1].world_from_object.orientation;
  EXPECT_EQ(std::abs(half.x()), std::abs(half.z()));
  EXPECT_EQ(half.y(), 0.0);
  EXPECT_EQ(half.w(), 0.0);
}

TEST(CellFile, RpyIsTheConventionOfUrdf) {
  const Scene scene = scene_of(
      cell_text("objects:\n"
                "  - {name: a, fixed: true, pose: {rpy: [10, 20, 30]}, box: {size: [1, 1, 1]}}\n"
                "  - {name: b, box: {size: [1, 1, 1]}}\n"
                "pairs: [{between: [a, b]}]\n"));
  const double deg = 3.14159265358979323846 / 180.0;
  const Mat3 expected =
      (Eigen::AngleAxisd(30.0 * deg, Vec3::UnitZ()) * Eigen::AngleAxisd(20.0 * deg, Vec3::UnitY()) *
       Eigen::AngleAxisd(10.0 * deg, Vec3::UnitX()))
          .toRotationMatrix();
  EXPECT_LT((scene.objects[0].world_from_object.orientation.toRotationMatrix() - expected).norm(),
            1e-15);
}

TEST(CellFile, QuaternionsAreXyzw) {
  const Scene scene = scene_of(cell_text(
      "objects:\n"
      "  - {name: a, fixed: true, pose: {quaternion: [0.6, 0, 0, 0.8]}, box: {size: [1, 1, 1]}}\n"
      "  - {name: b, box: {size: [1, 1, 1]}}\n"
      "pairs: [{between: [a, b]}]\n"));
  EXPECT_NEAR(scene.objects[0].world_from_object.orientation.x(), 0.6, 1e-15);
  EXPECT_NEAR(scene.objects[0].world_from_object.orientation.w(), 0.8, 1e-15);
}

TEST(CellFile, RevisionFollowsEveryByteAndIsNeverZero) {
  const Cell read = read_good(cell_text(kBoxes));
  const Scene& one = read.scene;
  const Scene same = scene_of(cell_text(kBoxes));
  const Scene other = scene_of(cell_text(kBoxes + "# a comment\n"));
  EXPECT_EQ(one.revision, same.revision);
  EXPECT_NE(one.revision, other.revision);
  EXPECT_NE(one.revision, 0u);
  EXPECT_EQ(read.yaml, cell_text(kBoxes));
}

TEST(CellFile, EveryErrorIsFoundInOnePass) {
  const std::string errors = errors_of(
      "name: test\n"
      "units: {length: inch, angle: deg}\n"
      "rate_hz: fast\n"
      "objects:\n"
      "  - {name: a, box: {size: [1, 1]}}\n"
      "  - {name: b, sphere: {radius: -1}}\n"
      "  - {name: b, capsule: {from: [0, 0, 0], to: [0, 0, 1]}}\n"
      "pairs: [{between: [a, c]}]\n"
      "colour: red\n");
  EXPECT_THAT(errors, mistake_at("cell.yaml:2:17", "inch"));
  EXPECT_THAT(errors, mistake_at("cell.yaml:3:10", "fast"));
  EXPECT_THAT(errors, mistake_at("cell.yaml:5:27", "2"));
  EXPECT_THAT(errors, mistake_at("cell.yaml:6:32", "-1", "radius"));
  EXPECT_THAT(errors, mistake_at("cell.yaml:7:12", "'b'"));
  EXPECT_THAT(errors, mistake_at("cell.yaml:7:24", "'radius'", "capsule"));
  EXPECT_THAT(errors, mistake_at("cell.yaml:8:23", "'c'"));
  EXPECT_THAT(errors, mistake_at("cell.yaml:9:1", "'colour'"));
}

TEST(CellFile, ErrorsComeInTheOrderOfTheFile) {
  const CellResult result = parse_cell("zzz: 1\nname: 7\nunits: 3\n", "cell.yaml");
  const auto* errors = std::get_if<std::vector<CellError>>(&result);
  ASSERT_NE(errors, nullptr);
  int last = 0;
  for (const CellError& error : *errors) {
    const int line = std::stoi(error.text.substr(10));
    EXPECT_LE(last, line) << error.text;
    last = line;
  }
}

TEST(CellFile, AnErrorIsOneLineWhateverWasFound) {
  const std::string errors =
      errors_of("name: test\nunits: {length: m, angle: deg}\nrate_hz: |\n  one\n  two " +
                std::string(500, 'x') + "\n" + kBoxes);
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  EXPECT_LT(errors.size(), 200u);
}

TEST(CellFile, AMistakeBehindAnAnchorIsReportedOnce) {
  const std::string errors =
      errors_of(cell_text("objects:\n"
                          "  - {name: a, box: &box {size: [1, 1, none]}}\n"
                          "  - {name: b, box: *box}\n"
                          "pairs: [{between: [a, b]}]\n"));
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
}

TEST(CellFile, AMissingFileIsAnError) {
  const CellResult result = read_cell("/nowhere/at/all.yaml");
  const auto* errors = std::get_if<std::vector<CellError>>(&result);
  ASSERT_NE(errors, nullptr);
  EXPECT_THAT(errors->front().text, mistake_at("/nowhere/at/all.yaml:1:1"));
}

TEST(CellFile, ADirectoryIsNoCell) {
  EXPECT_TRUE(std::holds_alternative<std::vector<CellError>>(read_cell("/")));
}

TEST(CellFile, TheExampleOfTheReadmeIsAGoodCell) {
  std::ifstream stream(test::places::sources() + "/config/README.md");
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const std::string fence = "```yaml\n";
  const std::size_t start = text.find(fence) + fence.size();
  const Scene scene = scene_of(text.substr(start, text.find("```", start) - start));
  EXPECT_EQ(scene.name, "drill");
  EXPECT_EQ(scene.zones.size(), 1u);
}

TEST(CellFile, ASummaryCountsEverything) {
  EXPECT_EQ(
      summary(scene_of(cell_text(kBoxes))),
      "test: 3 objects (2 moving, 1 fixed), 3 parts, 13 facets, 2 pairs (2 published), 0 zones");
}

}  // namespace
}  // namespace clearance
