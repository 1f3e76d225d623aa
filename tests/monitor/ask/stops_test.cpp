// Stops of robots, against machines that stop: each joint goes on with its velocity until the
// brakes act, and then comes to rest within its table, in proportion or by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "monitor/pairs/kept_near.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/ask/arms_that_stop.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/true_bodies.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

constexpr double kOracle = 2e-9;  // m: what the oracle rounds

// The present speeds of a machine, and how it stops. Every part of a stop is drawn.
class StoppingMachine {
 public:
  StoppingMachine(const Scene& scene, std::uint64_t seed)
      : scene_(scene),
        random_(seed),
        monitor_(scene),
        exact_(test::drawn_errors(scene, random_)),
        positions_(scene.variables.size()),
        velocities_(scene.variables.size()),
        sent_(scene.objects.size()) {}

  // A tick of another posture, long after the last one. `share`: of the largest speeds.
  const Report& tick(double share, std::int64_t age_ns = 0) {
    now_ += 100'000'000'000;
    std::vector<JointSample> joints;
    for (std::uint32_t v = 0; v < positions_.size(); ++v) {
      const JointVariable& of = scene_.variables[v];
      positions_[v] =
          random_.uniform(std::max(of.lower, -2.5) * 0.8, std::min(of.upper, 2.5) * 0.8);
      velocities_[v] = share * of.max_speed * random_.uniform(-1.0, 1.0);
      JointSample sample = test::joint(v, positions_[v], now_ - age_ns);
      sample.has_velocity = true;
      sample.velocity = velocities_[v];
      joints.push_back(sample);
    }
    age_ = 1e-9 * static_cast<double>(age_ns);
    std::vector<PoseSample> poses;
    for (std::uint32_t i = 0; i < sent_.size(); ++i) {
      if (scene_.objects[i].name != "person") continue;
      sent_[i].position = Vec3(1.2, 0.0, 1.0) + random_.in_box(0.6);
      poses.push_back(test::sample(i, sent_[i], now_));
    }
    return monitor_.tick(poses, joints, now_);
  }

  // The poses at an instant of a stop of all robots that begins with this report, or a little
  // later: of `robot` from `scaling` times its speed.
  std::vector<Pose> drawn_instant(const Robot& robot, double scaling = 1.0) {
    std::vector<double> at = positions_;
    double elapsed = 0.0;
    for (const Robot& each : scene_.robots) {
      const double time = stop(each, &each == &robot ? scaling : 1.0, at);
      if (&each == &robot) elapsed = time;
    }
    std::vector<Pose> sent = sent_;
    for (Pose& pose : sent) pose.position += test::kPersonSpeed * elapsed * random_.direction();
    return test::true_poses(scene_, at, sent, exact_);
  }

 private:
  // Where the joints of a robot may be at an instant of its stop. Returns the time since the
  // report, s.
  double stop(const Robot& robot, double scaling, std::vector<double>& at) {
    const RobotStops& stops = robot.stopping;
    const bool is_braking = chance(0.8);
    const double reaction = age_ + (is_braking && chance(0.7) ? 1.0 : random_.uniform(0.0, 1.0)) *
                                       (stops.reaction + 1.0 / scene_.rate_hz);
    const double share = chance(0.4) ? 1.0 : random_.uniform(0.0, 1.0);
    std::vector<double> speeds(robot.joints.size(), 0.0);  // from which they brake
    double in_proportion = 0.0, longest = 0.0;
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      if (!test::moves(scene_, robot, j)) continue;
      const std::uint32_t v = robot.joints[j].variable;
      const double most = stops.max_accelerations.empty() ? kInfinity : stops.max_accelerations[j];
      const double changed =
          most < kInfinity ? most * reaction * (chance(0.5) ? side() : random_.uniform(-1.0, 1.0))
                           : 0.0;
      at[v] += (velocities_[v] + 0.5 * changed) * reaction;
      speeds[j] = scaling * (velocities_[v] + changed);
      const double speed = std::abs(speeds[j]);
      if (speed > 0.0)
        in_proportion = std::max(in_proportion, stops.joints[j].distance(speed) / speed);
      longest = std::max(longest, stops.joints[j].time(speed));
    }
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      if (!test::moves(scene_, robot, j)) continue;
      const std::uint32_t v = robot.joints[j].variable;
      if (is_braking && stops.keeps_path) {
        at[v] += speeds[j] * share * in_proportion;
      } else if (is_braking) {
        at[v] += std::copysign(
            test::went(stops.joints[j], std::abs(speeds[j]), share * longest, random_), speeds[j]);
      }
      // What slides does not leave its limits.
      const JointVariable& limits = scene_.variables[v];
      if (robot.joints[j].type == JointType::kPrismatic)
        at[v] = std::clamp(at[v], limits.lower, limits.upper);
    }
    return reaction - age_ + (is_braking ? share * longest : 0.0);
  }
  bool chance(double share) { return random_.uniform(0.0, 1.0) < share; }
  double side() { return chance(0.5) ? 1.0 : -1.0; }

  const Scene& scene_;
  Random random_;
  Monitor monitor_;
  test::DrawnErrors exact_;
  std::vector<double> positions_, velocities_;
  double age_ = 0.0;
  std::vector<Pose> sent_;
  std::int64_t now_ = kStart;
};

struct Compared {
  std::size_t bounds = 0, outside = 0;
  double worst = kInfinity;
  std::string pair;  // that has it
};
void count(const Scene& scene, std::uint32_t pair, double truth, double least, Compared& compared) {
  ++compared.bounds;
  compared.outside += truth < least - kOracle;
  if (truth - least >= compared.worst) return;
  const ObjectPair& of = scene.pairs[pair];
  compared.worst = truth - least;
  compared.pair = scene.objects[of.first].name + " - " + scene.objects[of.second].name;
}

// Calls use(report, robot, poses) for instants of stops.
template <class Use>
void for_each_instant(const Scene& scene, std::uint64_t seed, bool scaled, const Use& use) {
  StoppingMachine machine(scene, seed);
  for (int i = 0; i < 24; ++i) {
    const Report& report = machine.tick(0.1 * (1 + i % 8), i % 3 == 0 ? 8 * kTick : 0);
    for (std::size_t k = 0; k < 20; ++k) {
      const std::size_t r = k % scene.robots.size();
      const double scaling = report.stops[r].scaling;
      if (scaled && scaling == 0.0) continue;
      const Robot& robot = scene.robots[r];
      use(report, robot, machine.drawn_instant(robot, scaled ? scaling : 1.0));
    }
  }
}

TEST(StopsOfRobots, AreNeverNearerThanTheBoundUntilTheyStand) {
  for (std::uint64_t seed = 1; seed <= repeats(80); ++seed) {
    const Scene scene = test::drawn_scene(seed);
    Compared compared;
    for_each_instant(
        scene, seed, false, [&](const Report& report, const Robot& robot, const auto& poses) {
          for (const PairReport& pair : report.pairs) {
            const ObjectPair& of = scene.pairs[pair.pair];
            if (pair.stop_lower > 0.0 && (test::is_moved_link(scene, robot, of.first) ||
                                          test::is_moved_link(scene, robot, of.second)))
              count(scene, pair.pair, test::distance_of(scene, pair.pair, poses), pair.stop_lower,
                    compared);
          }
        });
    EXPECT_GT(compared.bounds, 1'000u);
    EXPECT_EQ(compared.outside, 0u)
        << "seed " << seed << ", " << compared.worst << ", " << compared.pair;
  }
}

TEST(StopsOfRobots, FromTheStatedShareOfTheSpeedKeepTheMargins) {
  std::size_t slowed = 0;
  for (std::uint64_t seed = 1; seed <= repeats(80); ++seed) {
    const Scene scene = test::drawn_scene(seed);
    const std::vector<std::uint32_t> near = kept_nearer(scene, 0.0);
    const auto& between = scene.zones.front().pairs;
    Compared compared;
    for_each_instant(
        scene, seed, true, [&](const Report& report, const Robot& robot, const auto& poses) {
          slowed +=
              report.stops[static_cast<std::size_t>(&robot - scene.robots.data())].scaling < 1.0;
          for (const PairReport& pair : report.pairs) {
            const ObjectPair& of = scene.pairs[pair.pair];
            if (!(test::is_moved_link(scene, robot, of.first) ||
                  test::is_moved_link(scene, robot, of.second)))
              continue;
            if (std::ranges::binary_search(near, pair.pair)) continue;
            const bool has_margin = std::ranges::find(between, pair.pair) != between.end();
            count(scene, pair.pair, test::distance_of(scene, pair.pair, poses),
                  has_margin ? test::kMargin : 0.0, compared);
          }
        });
    EXPECT_EQ(compared.outside, 0u)
        << "seed " << seed << ", " << compared.worst << ", " << compared.pair;
  }
  EXPECT_GT(slowed, 10u);
}

}  // namespace
}  // namespace clearance
