// The robot of scara_cell.hpp beside a ball, told how its shoulder stops. Its finger circles about
// the origin at 2 m.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {

inline constexpr double kReaction = 0.041;      // s: 40 ms and a period
inline constexpr double kDeceleration = 4.0;    // rad/s2
inline constexpr double kRadii = 0.05 + 0.1;    // m: of finger and ball
inline constexpr double kStopMargin = 0.05;     // m
inline constexpr double kStopTolerance = 4e-3;  // m: of stop_lower

// Only the finger has a shape.
inline std::string finger_urdf() {
  std::string text = kScaraUrdf;
  for (int i = 0; i < 3; ++i) {
    const std::size_t from = text.find("<collision>"), end = text.find("</collision>");
    text.erase(from, end + std::string("</collision>").size() - from);
  }
  return text;
}

inline const std::string kKept = "path: kept";
inline const std::string kLeft = "path: left";

// A fixed ball on the finger's circle. `more`: keys of it, `rest`: objects, zones, contacts.
struct StoppingScara {
  std::string path = kKept;
  std::string shoulder = "deceleration: 4";
  double at = 0.3;  // rad: the direction of the ball
  std::string ball = "fixed: true, ";
  std::string objects = "", pairs = "", rest = "";
  double margin = kStopMargin;
};

inline Scene scene_of_scara(const StoppingScara& of) {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", finger_urdf());
  const std::string place = ", pose: {xyz: [" + std::to_string(2.0 * std::cos(of.at)) + ", " +
                            std::to_string(2.0 * std::sin(of.at)) + ", 0]}";
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrate_hz: 1000\nrobots:\n"
      "  - {name: arm, urdf: scara.urdf, joints: {elbow: {velocity: 2}}, stopping: {reaction_ms: "
      "40, " +
          of.path + ", time_ms: 100, joints: {shoulder: {" + of.shoulder +
          "}}}}\nobjects:\n  - {name: ball, " + of.ball + "sphere: {radius: 0.1}" +
          (of.ball.starts_with("fixed") ? place : "") + "}\n" + of.objects +
          "pairs:\n  - {between: [arm, ball]}\n" + of.pairs +
          "zones:\n  - {name: stops, between: [arm, "
          "ball], stops: {margin: " +
          std::to_string(of.margin) + "}}\n" + of.rest,
      folder / "cell.yaml");
}

// Where the finger is this near to the ball: the shoulder's angle before it.
inline double angle_before(double distance) { return 2.0 * std::asin(0.25 * (distance + kRadii)); }
inline double distance_before(double angle) { return 4.0 * std::sin(0.5 * angle) - kRadii; }

// Ticks of a cell.
class StoppingTicks {
 public:
  explicit StoppingTicks(const Scene& of) : scene(of), monitor(scene) {}

  // All joints say their velocity; the shoulder this one.
  const Report& tick(double shoulder, double velocity, std::vector<PoseSample> poses = {}) {
    now += kTick;
    auto said = joints(shoulder, 0.0, 0.0, now);
    for (JointSample& joint : said) joint.has_velocity = true;
    said[0].velocity = velocity;
    return monitor.tick(poses, said, now);
  }

  Scene scene;
  Monitor monitor;
  std::int64_t now = kStart;
};

}  // namespace clearance::test
