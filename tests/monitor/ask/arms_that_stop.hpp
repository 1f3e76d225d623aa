// The shipped cell of two arms, which state how they stop, and a person beside them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/ask/printed_stops.hpp"
#include "tests/monitor/tick/fresh_distance.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

inline constexpr double kPersonSpeed = 1.6;  // m/s

// The first of the seeds that a test draws.
inline std::uint64_t first_seed() {
  const char* stated = std::getenv("CLEARANCE_STOPS_SEED");
  return stated == nullptr ? 1 : std::strtoull(stated, nullptr, 10);
}

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

// The object of a link; `link` is its name without the prefix.
inline std::uint32_t object_of(const Robot& robot, const std::string& link) {
  return std::ranges::find(robot.links, robot.prefix + link, &RobotLink::name)->object;
}

// The share of its distance that a joint has gone after a time `t` of a stop that takes `time`, s.
// A power of 1 keeps the speed, and of 2 the deceleration.
inline double share_gone(double t, double time, double power) {
  return 1.0 - std::pow(std::max(0.0, 1.0 - t / time), power);
}

// How far a joint has come after a time of its stop from a speed, by some law that fits its table:
// it needs no more than the table says, and often less.
inline double went(const JointStop& stop, double speed, double t, Random& random) {
  const double distance = (random.chance(0.5) ? 1.0 : random.unit()) * stop.distance(speed);
  const double time = stop.time(speed);
  if (!(distance > 0.0)) return 0.0;
  const double steepest = std::max(1.0, speed * time / distance);
  const double power = random.uniform(1.0, steepest);
  return distance * share_gone(t, time, power);
}

inline const std::string kSomeStops = "{reaction_ms: 50, path: kept, time_ms: 200}";
inline constexpr double kMargin = 0.07;        // m, of the zone between both arms
inline constexpr double kPersonMargin = 0.05;  // m, between the left arm and the person

// Arms that stop in drawn manners, as their cell states them, and how the true machines stop.
struct DrawnArms {
  Scene scene;
  std::vector<std::vector<MachineStop>> machines;  // by robot and joint
  std::vector<double> reaches;                     // PrintedStops::reach(), by robot
};

// `reaction`: draws that of an arm, s. `turns`: draws the accelerations of an arm; infinity: none
// is stated.
template <class Reaction, class Turns>
DrawnArms drawn_arms(Random& random, const Reaction& reaction, const Turns& turns,
                     bool measures = false) {
  const PrintedStops left(reaction(), random, measures), right(reaction(), random, measures);
  DrawnArms arms;
  arms.reaches = {left.reach(), right.reach()};
  Scene& scene = arms.scene =
      arms_that_stop(left.text(), right.text(),
                     "  - {name: walks, between: [left, person], stops: {margin: 0.05}}\n");
  std::ranges::find(scene.zones, "slow", &Zone::name)->stop_margin = kMargin;
  for (Robot& robot : scene.robots) {
    RobotStops& stops = robot.stopping;
    stops.max_accelerations.clear();
    const double most = turns();
    for (std::size_t j = 0; j < robot.joints.size(); ++j)
      stops.max_accelerations.push_back(most < kInfinity ? most * random.uniform(0.3, 1.0)
                                                         : kInfinity);
  }
  for (const Robot& robot : scene.robots) {
    auto rows = (arms.machines.empty() ? left : right).rows().begin();
    auto& machine = arms.machines.emplace_back();
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      std::vector<JointStop> stated;
      for (const StopStep& step : robot.stopping.steps) stated.push_back(step.joints[j]);
      if (stated.empty()) stated.push_back(robot.stopping.joints[j]);
      machine.emplace_back(stated, moves(scene, robot, j) ? *rows++ : PrintedRows());
    }
  }
  return arms;
}
inline DrawnArms drawn_arms(std::uint64_t seed, bool measures = false) {
  Random random(seed);
  return drawn_arms(
      random, [&] { return 1e-3 * random.integer(0, 100); },
      [&] { return random.chance(0.4) ? random.uniform(0.0, 3.0) : kInfinity; }, measures);
}
inline Scene drawn_scene(std::uint64_t seed) { return drawn_arms(seed).scene; }

// The largest margin of a pair in zones with `stops`, m.
inline double margin_of(const Scene& scene, std::uint32_t pair) {
  double margin = 0.0;
  for (const Zone& zone : scene.zones)
    if (zone.stop_margin && std::ranges::find(zone.pairs, pair) != zone.pairs.end())
      margin = std::max(margin, *zone.stop_margin);
  return margin;
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
