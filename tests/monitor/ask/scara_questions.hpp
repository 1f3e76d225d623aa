// Questions about the robot of three joints, beside a post whose distance has a closed form.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "monitor/ask/asker.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::test {

// `object` has the keys of the post, `more` further sections of the cell.
inline Scene scara_beside(const std::string& object, const std::string& more = "") {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\n"
      "robots: [{name: arm, urdf: scara.urdf}]\nobjects:\n  - {name: post, " +
          object + "}\npairs: [{between: [arm, post]}, {between: [arm, arm]}]\n" + more,
      folder / "cell.yaml");
}

// The finger is a sphere of 0.05 m that circles at 2 m around the origin.
inline constexpr const char* kPin = "fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.3, 0, 0]}";

// The shoulder rotates in two seconds.
inline Question swing(double from, double to) {
  Question question;
  question.motion = {
      .joints = {"shoulder"}, .times = {0.0, 2.0}, .positions = {from, to}, .velocities = {}};
  question.held = {{"elbow", 0.0}, {"push", 0.0}};
  return question;
}

inline Answer answered(const Scene& scene, const Question& question) {
  const std::variant<Answer, std::string> answer = ask(scene, question);
  EXPECT_TRUE(std::holds_alternative<Answer>(answer)) << std::get<std::string>(answer);
  return std::get<Answer>(answer);
}

}  // namespace clearance::test
