// Residuals of measured places against stated errors. The oracle is the closed form of an arm of
// two links of a metre.
#include "monitor/replay/explained_places.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>

#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;

Scene scara_with(const std::string& errors) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: scara.urdf}]\n" +
          test::kScaraRest + errors,
      folder / "cell.yaml");
}

LinkByName finger(const Scene& scene) {
  return std::get<LinkByName>(link_by_name(scene, "finger"));
}

// Where the finger is if the joints are off by these angles.
Vec3 finger_at(double shoulder, double elbow) {
  return {std::cos(shoulder) + std::cos(shoulder + elbow),
          std::sin(shoulder) + std::sin(shoulder + elbow), 0.0};
}

// Places of an arm whose joints are off by these angles.
ExplainedPlaces places_of(const Scene& scene, double shoulder_off, double elbow_off) {
  ExplainedPlaces places(scene, finger(scene));
  Monitor monitor(scene);
  std::int64_t now = test::kStart;
  for (const double at : {-0.5, 0.0, 0.4, 0.8}) {
    now += 1'000'000'000;
    monitor.tick({}, test::joints(at, 0.5 * at, 0.0, now), now);
    EXPECT_TRUE(places.add(monitor, finger_at(at + shoulder_off, 0.5 * at + elbow_off)));
  }
  return places;
}

TEST(ExplainedPlaces, AreThoseOfAnArmWithinItsErrors) {
  const Scene scene = scara_with("errors: {joints: {position: 0.002, translation: 0.0001}}\n");
  EXPECT_LE(places_of(scene, 0.002, 0.002).factor(), 1.0);
  EXPECT_LT(places_of(scene, 0.001, -0.0005).factor(), 0.7);
  // The reach is 2 m and 1 m; three frames add 0.1 mm each.
  const double factor = places_of(scene, 0.006, 0.006).factor();
  EXPECT_GT(factor, 0.018 / 0.0063);
  EXPECT_LT(factor, 3.1);
}

TEST(ExplainedPlaces, NameTheJointThatWouldDoAlone) {
  const Scene scene = scara_with("errors: {joints: {position: 0.0001, translation: 0.00001}}\n");
  const ExplainedPlaces places = places_of(scene, 0.0, 0.003);
  EXPECT_GT(places.factor(), 1.0);
  EXPECT_THAT(places.text(), HasSubstr("NOT EXPLAINED"));
  EXPECT_THAT(places.text(), HasSubstr("the joint 'elbow'"));
}

TEST(ExplainedPlaces, ALinkThatIsNotThereIsToldWithTheNearestName) {
  const auto found = link_by_name(scara_with(""), "fingr");
  ASSERT_TRUE(std::holds_alternative<std::string>(found));
  EXPECT_THAT(std::get<std::string>(found), HasSubstr("'finger'"));
}

}  // namespace
}  // namespace clearance
