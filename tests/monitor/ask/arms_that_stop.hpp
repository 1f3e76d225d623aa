// The shipped cell of two arms, which state how they stop, and a person beside them.
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/tick/fresh_distance.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

inline constexpr double kPersonSpeed = 1.6;  // m/s

inline Scene arms_that_stop(const std::string& left, const std::string& right,
                            const std::string& zones = "") {
  const std::string file = places::sources() + "/config/cells/seven_joint_arms.yaml";
  std::ifstream in(file);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto after = [&](const std::string& mark, const std::string& more) {
    text.insert(text.find(mark) + mark.size(), more);
  };
  after("prefix: left_\n", "    stopping: " + left + "\n");
  after("prefix: right_\n", "    stopping: " + right + "\n");
  after("objects:\n",
        "  - {name: person, max_speed: 1.6, may_jump: true, capsule: {radius: 0.2, from: [0, 0, "
        "-0.6], to: [0, 0, 0.6]}}\n");
  after("pairs:\n", "  - between: [left, person]\n  - between: [right, person]\n");
  after("zones:\n", zones);
  return scene_of(text, file);
}

// The joint has a stop of its own.
inline bool moves(const Scene& scene, const Robot& robot, std::size_t joint) {
  const RobotJoint& of = robot.joints[joint];
  return variables_of(of.type) == 1 && scene.variables[of.variable].name == of.name;
}

// Random stops of a robot: tables, decelerations and times.
inline RobotStops drawn_stops(const Scene& scene, const Robot& robot, Random& random) {
  RobotStops stops;
  stops.reaction = random.uniform(0.0, 0.1);
  stops.keeps_path = random.uniform(0.0, 1.0) < 0.5;
  const bool may_turn = random.uniform(0.0, 1.0) < 0.4;
  for (const RobotJoint& joint : robot.joints) {
    stops.joints.emplace_back();
    stops.max_accelerations.push_back(kInfinity);
    if (variables_of(joint.type) != 1) continue;
    if (may_turn) stops.max_accelerations.back() = random.uniform(0.0, 3.0);
    const double full = scene.variables[joint.variable].max_speed;
    const double kind = random.uniform(0.0, 3.0);
    if (kind < 1.0) {
      stops.joints.back() = JointStop::by_deceleration(random.uniform(1.0, 20.0) * full);
    } else if (kind < 2.0) {
      stops.joints.back() = JointStop::by_time(random.uniform(0.01, 0.3));
    } else {
      std::vector<StopPoint> points;
      for (const double share : {0.33, 0.66, 1.0}) {
        const double time = random.uniform(0.05, 0.4);
        points.push_back({share * full, share * full * time * random.uniform(0.2, 1.0), time});
      }
      stops.joints.back() = JointStop::by_table(points);
    }
  }
  return stops;
}

// How far a joint has come after a time of its stop from a speed, by some law that fits its table:
// it needs no more than the table says, and often less.
inline double went(const JointStop& stop, double speed, double t, Random& random) {
  const double distance = (random.chance(0.5) ? 1.0 : random.unit()) * stop.distance(speed);
  const double time = stop.time(speed);
  if (!(distance > 0.0)) return 0.0;
  const double steepest = std::max(1.0, speed * time / distance);
  const double power = random.uniform(1.0, steepest);
  return distance * (1.0 - std::pow(1.0 - std::min(1.0, t / time), power));
}

inline const std::string kSomeStops = "{reaction_ms: 50, path: kept, time_ms: 200}";
inline constexpr double kMargin = 0.07;  // m, of the zone between both arms

// The arms stop in drawn manners. The zone between them has a margin.
inline Scene drawn_scene(std::uint64_t seed) {
  Scene scene = arms_that_stop(kSomeStops, kSomeStops);
  Random random(seed);
  for (Robot& robot : scene.robots) robot.stopping = drawn_stops(scene, robot, random);
  scene.zones.front().stop_margin = kMargin;
  return scene;
}

// Fixed links never move, so no stop concerns them.
inline bool is_moved_link(const Scene& scene, const Robot& robot, std::uint32_t object) {
  return !scene.objects[object].fixed &&
         std::ranges::find(robot.links, object, &RobotLink::object) != robot.links.end();
}

inline double distance_of(const Scene& scene, std::uint32_t pair, const std::vector<Pose>& poses) {
  const ObjectPair& of = scene.pairs[pair];
  return fresh_distance(scene.objects[of.first], poses[of.first], scene.objects[of.second],
                        poses[of.second])
      .upper;
}

}  // namespace clearance::test
