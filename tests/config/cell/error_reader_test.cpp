#include "config/cell/error_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "config/scene/stated_errors.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

// A robot on a table, a cart, and a vice that is attached to the table.
std::string uncertain_cell(const std::string& errors) {
  return "name: test\nunits: {length: mm, angle: deg}\nrobots: [{name: arm, urdf: scara.urdf, "
         "base: "
         "{on: table}}]\n"
         "objects:\n"
         "  - {name: table, fixed: true, box: {size: [900, 900, 50]}}\n"
         "  - {name: vice, box: {size: [90, 90, 50]}, attached: {to: table, pose: {xyz: [0, 300, "
         "50]}}}\n"
         "  - {name: cart, max_speed: 1, sphere: {radius: 90}}\n"
         "pairs: [{between: [arm, cart]}, {between: [cart, vice]}, {between: [arm, arm]}, "
         "{between: [cart, table]}]\n" +
         errors;
}

template <class Read>
auto with_scara(const std::string& errors, Read&& read) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  return read(uncertain_cell(errors), folder / "cell.yaml");
}
Scene uncertain_scene(const std::string& errors) {
  return with_scara(errors,
                    [](const auto& text, const auto& file) { return scene_of(text, file); });
}
std::string mistakes_in(const std::string& errors) {
  return with_scara(errors,
                    [](const auto& text, const auto& file) { return errors_of(text, file); });
}

const Object& object(const Scene& scene, const std::string& name) {
  for (const Object& each : scene.objects)
    if (each.name == name) return each;
  ADD_FAILURE() << name;
  return scene.objects.front();
}

std::uint32_t number_of(const Scene& scene, const std::string& name) {
  return static_cast<std::uint32_t>(&object(scene, name) - scene.objects.data());
}

TEST(StatedErrorKeys, AreDefaultsByKindAndExceptionsByName) {
  const Scene scene = uncertain_scene(
      "errors:\n  joints: {position: 0.1, slide: 0.2, translation: 0.3, rotation: 0.4}\n"
      "  bases: {translation: 1}\n  fixed: {translation: 2}\n  poses: {translation: 3, rotation: "
      "1}\n"
      "  attached: {translation: 4}\n  shapes: 0.5\n"
      "  except: [{joint: elbow, position: 0.7}, {object: cart, translation: 5, shape: 0}]\n");
  const Robot& arm = scene.robots.front();
  EXPECT_DOUBLE_EQ(arm.joints[0].error.position, 0.1 * kDegree);
  EXPECT_DOUBLE_EQ(arm.joints[1].error.position, 0.7 * kDegree);
  EXPECT_DOUBLE_EQ(arm.joints[1].error.frame.translation, 0.3e-3);
  EXPECT_DOUBLE_EQ(arm.joints[2].error.slide, 0.2e-3);
  EXPECT_DOUBLE_EQ(arm.base_error.translation, 1e-3);
  EXPECT_DOUBLE_EQ(object(scene, "table").place_error.translation, 2e-3);
  EXPECT_DOUBLE_EQ(object(scene, "vice").place_error.translation, 4e-3);
  EXPECT_DOUBLE_EQ(object(scene, "cart").place_error.translation, 5e-3);
  EXPECT_DOUBLE_EQ(object(scene, "cart").place_error.rotation, kDegree);
  EXPECT_EQ(object(scene, "cart").shape_error, 0.0);
  EXPECT_DOUBLE_EQ(object(scene, "upper").shape_error, 0.5e-3);
}

TEST(StatedErrorKeys, AreRefusedWithTheirPlaceAndAHint) {
  EXPECT_THAT(mistakes_in("errors: {joint: {position: 1}}\n"), HasSubstr("unknown key 'joint'"));
  EXPECT_THAT(mistakes_in("errors: {joints: {position: -1}}\n"), HasSubstr("from 0 on"));
  EXPECT_THAT(mistakes_in("errors: {fixed: {translation: -1}}\n"),
              HasSubstr("expected the largest error of a place"));
  EXPECT_THAT(mistakes_in("errors: {except: [{joint: elbo, position: 1}]}\n"),
              HasSubstr("did you mean 'elbow'"));
  EXPECT_THAT(mistakes_in("errors: {except: [{object: upper, translation: 1}]}\n"),
              HasSubstr("the joint that carries the link"));
  EXPECT_THAT(mistakes_in("errors: {except: [{base: arm, object: cart}]}\n"), HasSubstr("several"));
  EXPECT_THAT(mistakes_in("errors: {joints: {position: 9}}\n"), HasSubstr("add up to"));
}

TEST(StatedErrorKeys, OneLineNamesTheKindsThatAreLeftAtZero) {
  EXPECT_EQ(unstated_errors(uncertain_scene("")), "");
  const std::string left = unstated_errors(uncertain_scene("errors: {joints: {position: 0.1}}\n"));
  for (const char* kind : {"frames of joints", "bases", "fixed objects", "poses", "attached"})
    EXPECT_THAT(left, HasSubstr(kind));
  EXPECT_THAT(left, testing::Not(HasSubstr("positions of joints")));
  EXPECT_THAT(left, testing::Not(HasSubstr("mounts"))) << "there is no sensor";
}

// A finger that mimics another joint by a factor, and slides.
TEST(StatedErrorKeys, OfAMimicAreThoseOfItsMasterTimesTheFactor) {
  const test::ScratchFolder folder;
  test::write_text(
      folder / "scara.urdf",
      "<robot name=\"m\"><link name=\"a\"/><link name=\"b\"><collision><geometry><sphere "
      "radius=\"0.1\"/></geometry></collision></link><link name=\"c\"><collision><geometry><sphere "
      "radius=\"0.1\"/></geometry></collision></link><joint name=\"m\" type=\"revolute\"><parent "
      "link=\"a\"/><child link=\"b\"/><limit lower=\"-1\" upper=\"1\" velocity=\"1\"/></joint>"
      "<joint name=\"f\" type=\"prismatic\"><parent link=\"a\"/><child link=\"c\"/><limit "
      "lower=\"-1\" upper=\"1\" velocity=\"1\"/><mimic joint=\"m\" multiplier=\"0.1\"/></joint>"
      "</robot>");
  const auto text = [](const std::string& errors) {
    return "name: t\nunits: {length: m, angle: rad}\nrobots: [{name: m, urdf: scara.urdf}]\n"
           "objects: [{name: wall, fixed: true, half_space: {normal: [0, 0, 1], offset: -1}}]\n"
           "pairs: [{between: [m, wall]}]\n" +
           errors;
  };
  const Scene scene =
      scene_of(text("errors: {joints: {position: 0.001}, except: [{joint: m, position: 0.05}]}\n"),
               folder / "cell.yaml");
  const StatedErrors errors(scene);
  EXPECT_NEAR(errors.largest(number_of(scene, "c"), number_of(scene, "wall")), 0.005, 1e-9);
  EXPECT_THAT(
      errors_of(text("errors: {except: [{joint: f, slide: 0.01}]}\n"), folder / "cell.yaml"),
      HasSubstr("expected it of 'm'"));
}

TEST(StatedErrors, WhatCarriesBothBodiesDoesNotCount) {
  const Scene scene =
      uncertain_scene("errors: {fixed: {translation: 7}, attached: {translation: 4}}\n");
  const StatedErrors errors(scene);
  const auto largest = [&](const char* a, const char* b) {
    return errors.largest(number_of(scene, a), number_of(scene, b));
  };
  EXPECT_NEAR(largest("upper", "cart"), 7e-3, 1e-9) << "the table carries the arm";
  EXPECT_EQ(largest("upper", "table"), 0.0);
  EXPECT_EQ(largest("upper", "lower"), 0.0);
  EXPECT_NEAR(largest("vice", "table"), 4e-3, 1e-9);
  EXPECT_NEAR(largest("vice", "cart"), 11e-3, 1e-9);
  EXPECT_NEAR(largest("vice", "upper"), 4e-3, 1e-9) << "both stand on the table";
}

TEST(StatedErrors, OfAJointReachAsFarAsTheLinksBehindIt) {
  const Scene scene = uncertain_scene("errors: {joints: {position: 0.1}}\n");
  const StatedErrors errors(scene);
  const double angle = 0.1 * kDegree;
  const double elbow = errors.largest(number_of(scene, "upper"), number_of(scene, "lower"));
  // The lower link's box reaches 0.9 m and half its width.
  EXPECT_GT(elbow, angle * 0.9);
  EXPECT_LT(elbow, angle * 1.01);
  const double both = errors.largest(number_of(scene, "cart"), number_of(scene, "lower"));
  EXPECT_GT(both, angle * (1.9 + 0.9));
  EXPECT_LT(both, angle * (1.9 + 1.01) * 1.01);
}

}  // namespace
}  // namespace clearance
