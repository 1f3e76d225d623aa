// Two arms that stop, beside a person, in all that STOPS.md assumes: whatever it does not state is
// drawn anew in each stop. The person is wherever walking at full speed may have led.
//
// Oracle: places of joints in closed form, kinematics of its own and a fresh distance of each pair,
// at each millisecond at which the pair may have come to its margin.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/ask/arms_that_stop.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/true_bodies.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

inline constexpr double kStep = 1e-3;    // s: of the oracle
inline constexpr double kOracle = 2e-9;  // m: what it rounds
// No point of an arm is farther from the axes of its joints, m; what slides goes by its own speed.
inline constexpr double kReaches[] = {1.1, 1.1, 0.9, 0.7, 0.5, 0.3, 0.3, 1.0};

// Postures of a recorded or planned motion, one after the other.
struct RecordedMotion {
  std::vector<double> times;                   // s
  std::vector<std::vector<double>> positions;  // of the first joints of an arm

  // A CSV with a line of names, and then the time in ns and positions. What follows them is left
  // out. No file: no motion.
  explicit RecordedMotion(const char* file) {
    if (file == nullptr) return;
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::ranges::replace(line, ',', ' ');
      std::istringstream numbers(line);
      double value = 0.0;
      numbers >> value;
      times.push_back(1e-9 * value);
      auto& row = positions.emplace_back();
      while (row.size() < 7 && numbers >> value) row.push_back(value);
    }
    EXPECT_GT(positions.size(), 1u) << file;
  }
};

// The least of distances less their margins.
struct Judged {
  std::size_t stops = 0, slowed = 0, distances = 0, nearer = 0;
  double least_left = kInfinity;  // m
  std::string worst;              // the pair

  void add(const Judged& other) {
    stops += other.stops;
    slowed += other.slowed;
    distances += other.distances;
    nearer += other.nearer;
    if (other.least_left < least_left) worst = other.worst;
    least_left = std::min(least_left, other.least_left);
  }
};

class StoppingMachine {
 public:
  // `late`: how much later than stated the brakes act, s.
  StoppingMachine(const DrawnArms& arms, std::uint64_t seed, const RecordedMotion& motion,
                  double late = 0.0)
      : arms_(arms),
        motion_(motion),
        late_(late),
        random_(seed),
        monitor_(arms.scene),
        exact_(drawn_errors(arms.scene, random_)),
        joints_(arms.scene.variables.size()),
        robots_(arms.scene.robots.size()) {
    const Scene& scene = arms.scene;
    for (std::uint32_t r = 0; r < robots_.size(); ++r)
      for (std::size_t j = 0; j < scene.robots[r].joints.size(); ++j)
        if (moves(scene, scene.robots[r], j)) {
          Joint& joint = joints_[scene.robots[r].joints[j].variable];
          joint.of = j;
          joint.reach = kReaches[robots_[r].joints.size()];
          joint.stop = &arms.machines[r][j];
          joint.most = scene.robots[r].stopping.max_accelerations[j];
          robots_[r].joints.push_back(scene.robots[r].joints[j].variable);
        }
    person_ = static_cast<std::uint32_t>(std::ranges::find(scene.objects, "person", &Object::name) -
                                         scene.objects.begin());
    for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
      const ObjectPair& of = scene.pairs[p];
      Pair pair;
      pair.pair = p;
      pair.has_person = of.first == person_ || of.second == person_;
      for (std::uint32_t r = 0; r < robots_.size(); ++r) add_joints(r, of, pair);
      pairs_.push_back(pair);
    }
  }

  // A tick of another posture, long after the last one. `share`: of the largest speeds.
  const Report& tick(double share) {
    now_ += 100'000 * kTick;
    const bool is_late = random_.chance(0.5);
    for (Joint& joint : joints_) joint.age = is_late ? random_.integer(0, 10) : 0;
    person_age_ = is_late ? random_.integer(0, 10) : 0;
    place_.position = Vec3(1.0, 0.0, 1.0) + random_.in_box(0.7);
    int before = 0;  // ticks that tell of the motion
    for (Robot& robot : robots_) {
      draw(robot, share);
      before = std::max(before, robot.tells == Tells::kLies     ? 40
                                : robot.tells == Tells::kPlaces ? 12
                                                                : 0);
    }
    const Report* report = nullptr;
    for (int k = before; k >= 0; --k) {
      now_ += kTick;
      report = &monitor_.tick(std::vector{sample(person_, place_, now_ - person_age_ * kTick)},
                              samples(k), now_);
    }
    return *report;
  }

  // The robots stop, each from this share of its speed; 0: the robot is not judged, and stops from
  // its full speed. `margin`: of Scene::pairs.
  template <class Margin>
  void stop(const std::vector<double>& shares, const Margin& margin, Judged& judged) {
    if (!std::ranges::all_of(robots_, [&](const Robot& robot) { return admits(robot); })) return;
    double end = 0.0;
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      robots_[r].judged = shares[r] > 0.0;
      brake(robots_[r], arms_.scene.robots[r], shares[r] > 0.0 ? shares[r] : 1.0);
      bool is_moving = false;
      for (const std::uint32_t v : robots_[r].joints)
        is_moving = is_moving || joints_[v].velocity != 0.0;
      if (!robots_[r].judged) continue;
      end = std::max(end, robots_[r].stands);
      judged.stops += is_moving;
      judged.slowed += is_moving && shares[r] < 1.0;
    }
    for (Pair& pair : pairs_) {
      pair.due = kInfinity;
      pair.end = 0.0;
      pair.fastest = 1e-3 + (pair.has_person ? kPersonSpeed : 0.0);
      for (const std::uint32_t v : pair.joints)
        pair.fastest +=
            joints_[v].reach * (std::abs(joints_[v].velocity) + 2.0 * std::abs(joints_[v].turns));
      for (const std::uint32_t r : pair.robots) {
        if (robots_[r].judged) pair.due = 0.0;
        pair.end = std::max(pair.end, robots_[r].stands);
      }
      pair.margin = pair.due < kInfinity ? margin(pair.pair) : 0.0;
      end = pair.due < kInfinity ? std::max(end, pair.end) : end;
    }
    double due = 0.0;
    for (int i = 0; kStep * i < end + kStep; ++i) {
      const double t = std::min(end, kStep * i);
      if (t >= due) due = judge(t, judged);
    }
  }

  [[nodiscard]] Random& random() { return random_; }

 private:
  // How a robot tells its velocities: not all of them ever, by its places alone, or too small ones.
  enum class Tells { kAll, kNotAll, kPlaces, kLies };
  struct Joint {
    std::size_t of = 0;  // Robot::joints
    double reach = 0.0;  // m, or 1 of what slides
    const MachineStop* stop = nullptr;
    double most = kInfinity;                // acceleration, rad/s2 or m/s2
    int age = 0;                            // of its position, ticks
    double position = 0.0, velocity = 0.0;  // at its stamp
    bool is_told = true;
    // In a stop: its acceleration until it brakes, the velocity from then on, and how it brakes.
    double turns = 0.0, braked = 0.0, distance = 0.0, time = 0.0, power = 1.0;
  };
  struct Robot {
    std::vector<std::uint32_t> joints;  // Scene::variables
    Tells tells = Tells::kAll;
    bool judged = false;
    double share = 1.0, slows = 0.0, brakes = 0.0, stands = 0.0;  // s: from the report on
  };
  struct Pair {
    std::uint32_t pair = 0;
    bool has_person = false;
    std::vector<std::uint32_t> robots;  // that move a body of it
    std::vector<std::uint32_t> joints;  // between its bodies; Scene::variables
    double fastest = 0.0;               // m/s: no two points approach faster
    double margin = 0.0, due = 0.0, end = 0.0;
  };

  // Joint j places link j + 1. Of two links of one arm, joints below both do not count.
  void add_joints(std::uint32_t r, const ObjectPair& of, Pair& pair) const {
    const clearance::Robot& robot = arms_.scene.robots[r];
    const auto link = [&](std::uint32_t object) {
      return static_cast<std::size_t>(std::ranges::find(robot.links, object, &RobotLink::object) -
                                      robot.links.begin());
    };
    std::size_t from = std::min(link(of.first), link(of.second)), to = link(of.first);
    if (from == robot.links.size()) return;
    to = std::max(to, link(of.second));
    if (to == robot.links.size()) to = std::exchange(from, 0);
    if (is_moved_link(arms_.scene, robot, of.first) || is_moved_link(arms_.scene, robot, of.second))
      pair.robots.push_back(r);
    for (const std::uint32_t v : robots_[r].joints)
      if (joints_[v].of >= from && joints_[v].of < to) pair.joints.push_back(v);
  }

  double shape() { return random_.chance(0.5) ? 1.0 : random_.unit(); }

  void draw(Robot& robot, double share) {
    const bool turns = joints_[robot.joints.front()].most < kInfinity;
    const double kind = random_.unit();
    robot.tells = kind < 0.75   ? Tells::kAll
                  : kind < 0.85 ? Tells::kNotAll
                  : turns       ? Tells::kAll  // a mean over the past is half an interval old
                  : kind < 0.96 ? Tells::kPlaces
                                : Tells::kLies;
    const std::size_t rows = motion_.positions.size();
    const auto row =
        rows > 1 ? static_cast<std::size_t>(random_.integer(0, static_cast<int>(rows) - 2)) : 0;
    const double faster = random_.log_uniform(0.5, 5.0);
    for (std::size_t i = 0; i < robot.joints.size(); ++i) {
      const JointVariable& of = arms_.scene.variables[robot.joints[i]];
      Joint& joint = joints_[robot.joints[i]];
      const double least = 0.8 * std::max(of.lower, -2.5), most = 0.8 * std::min(of.upper, 2.5);
      joint.position = random_.uniform(least, most);
      joint.velocity = share * of.max_speed * random_.uniform(-1.0, 1.0);
      if (rows > 1 && i < motion_.positions[row].size()) follow(row, i, faster, of, joint);
      const bool slides = of.upper - of.lower < 0.2;
      if (slides && robot.tells != Tells::kAll) joint.velocity = 0.0;  // it stays within limits
      joint.is_told = robot.tells != Tells::kNotAll || random_.chance(0.8);
    }
  }
  // The arm has the range of another arm's joint, perhaps with the other sign.
  void follow(std::size_t row, std::size_t i, double faster, const JointVariable& of,
              Joint& joint) const {
    const double before = motion_.positions[row][i], after = motion_.positions[row + 1][i];
    const double seconds = std::max(1e-6, motion_.times[row + 1] - motion_.times[row]);
    const double side = before < of.lower || before > of.upper ? -1.0 : 1.0;
    joint.position = std::clamp(side * before, of.lower + 0.1, of.upper - 0.1);
    joint.velocity = std::clamp(faster * side * (after - before) / seconds, -0.95 * of.max_speed,
                                0.95 * of.max_speed);
  }

  // Of `k` ticks before the present one.
  [[nodiscard]] std::vector<JointSample> samples(int k) const {
    std::vector<JointSample> samples;
    for (const Robot& robot : robots_) {
      for (const std::uint32_t v : robot.joints) {
        const Joint& joint = joints_[v];
        samples.push_back(clearance::test::joint(v, joint.position - kStep * k * joint.velocity,
                                                 now_ - joint.age * kTick));
        samples.back().has_velocity = joint.is_told && robot.tells != Tells::kPlaces;
        samples.back().velocity =
            robot.tells == Tells::kLies ? 0.3 * joint.velocity : joint.velocity;
      }
    }
    return samples;
  }
  // A lie that the positions have not refuted yet is not admitted.
  [[nodiscard]] bool admits(const Robot& robot) const {
    return robot.tells != Tells::kLies || std::ranges::all_of(robot.joints, [&](std::uint32_t v) {
             return joints_[v].velocity == 0.0 || monitor_.joint_age(v).velocities_contradict;
           });
  }

  // Draws a stop. Before the brakes act, the robot may already be slower.
  void brake(Robot& robot, const clearance::Robot& of, double share) {
    const double latest = of.stopping.reaction + 1.0 / arms_.scene.rate_hz + late_;
    robot.share = share;
    robot.brakes = shape() * latest;
    robot.slows = shape() * robot.brakes;
    for (const std::uint32_t v : robot.joints) {
      Joint& joint = joints_[v];
      const bool may_turn = joint.most < kInfinity && joint.is_told;
      joint.turns = may_turn ? random_.sign() * shape() * joint.most : 0.0;
      joint.braked = joint.velocity + joint.turns * own_time(robot, joint, robot.brakes);
    }
    const std::size_t step = step_of(robot, of);
    double in_proportion = 0.0, longest = 0.0;
    for (const std::uint32_t v : robot.joints) {
      Joint& joint = joints_[v];
      const double speed = std::abs(share * joint.braked);
      joint.distance = joint.stop->distance(speed, step);
      joint.time = joint.stop->time(speed, step);
      if (speed > 0.0) in_proportion = std::max(in_proportion, joint.distance / speed);
      longest = std::max(longest, joint.time);
    }
    // In proportion: as seconds of the robot's own time, share x `distance` in all.
    const double lasts = std::max(1e-12, shape() * in_proportion), all = std::max(longest, 1e-9);
    const double power = random_.uniform(1.0, std::max(1.0, all / lasts));
    robot.stands = robot.brakes;
    for (const std::uint32_t v : robot.joints) {
      Joint& joint = joints_[v];
      if (of.stopping.keeps_path) {
        joint.distance = share * lasts;
        joint.time = all;
        joint.power = power;
      } else {
        const double speed = std::abs(share * joint.braked);
        joint.distance *= shape();
        joint.power = random_.uniform(
            1.0, std::max(1.0, speed * joint.time / std::max(1e-12, joint.distance)));
      }
      robot.stands = std::max(robot.stands, robot.brakes + joint.time);
    }
  }
  // The step of the extension that the posture has when the brakes act: how far the hand is from
  // the vertical line through the shoulder.
  [[nodiscard]] std::size_t step_of(const Robot& robot, const clearance::Robot& of) {
    const double reach = arms_.reaches[static_cast<std::size_t>(&robot - robots_.data())];
    if (reach == 0.0) return 0;
    at_.assign(joints_.size(), 0.0);
    for (const std::uint32_t v : robot.joints)
      at_[v] = position(robot, of, joints_[v], robot.brakes);
    const std::vector<Pose> places =
        true_poses(arms_.scene, at_, std::vector<Pose>(arms_.scene.objects.size(), place_), exact_);
    const Vec3 arm =
        places[object_of(of, "hand")].position - places[object_of(of, "shoulder")].position;
    return arm.head<2>().norm() > 0.5 * reach ? 1 : 0;
  }
  // How much of its motion a joint has made since its stamp, as a time at the robot's full speed.
  static double own_time(const Robot& robot, const Joint& joint, double t) {
    return kStep * joint.age + std::min(t, robot.slows) +
           robot.share * std::max(0.0, t - robot.slows);
  }
  [[nodiscard]] double position(const Robot& robot, const clearance::Robot& of, const Joint& joint,
                                double t) const {
    const double own = own_time(robot, joint, std::min(t, robot.brakes));
    double at = joint.position + (joint.velocity + 0.5 * joint.turns * own) * own;
    if (t <= robot.brakes || joint.time <= 0.0) return at;
    const double went = joint.distance * share_gone(t - robot.brakes, joint.time, joint.power);
    if (!of.stopping.keeps_path) return at + std::copysign(went, joint.braked);
    return at + (joint.braked + 0.5 * joint.turns * went) * went;
  }

  // Judges the pairs that are due. Returns when the next one is.
  double judge(double t, Judged& judged) {
    const Scene& scene = arms_.scene;
    at_.assign(joints_.size(), 0.0);
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      for (const std::uint32_t v : robots_[r].joints) {
        at_[v] = position(robots_[r], scene.robots[r], joints_[v], t);
        const JointVariable& of = scene.variables[v];
        // What slides does not leave its limits.
        if (of.upper - of.lower < 0.2) at_[v] = std::clamp(at_[v], of.lower, of.upper);
      }
    }
    const std::vector<Pose> places =
        true_poses(scene, at_, std::vector<Pose>(scene.objects.size(), place_), exact_);
    const double walked = kPersonSpeed * (t + kStep * person_age_);
    double next = kInfinity;
    for (Pair& pair : pairs_) {
      if (pair.due <= t) {
        const double left =
            distance_of(scene, pair.pair, places) - pair.margin - (pair.has_person ? walked : 0.0);
        pair.due = t + std::max(0.0, left / pair.fastest);
        ++judged.distances;
        judged.nearer += left < -kOracle || (pair.margin == 0.0 && left <= 0.0);
        if (left < judged.least_left) {
          judged.least_left = left;
          const ObjectPair& of = scene.pairs[pair.pair];
          judged.worst = scene.objects[of.first].name + " - " + scene.objects[of.second].name;
        }
      }
      if (pair.due > pair.end) pair.due = kInfinity;
      next = std::min(next, pair.due);
    }
    return next;
  }

  const DrawnArms& arms_;
  const RecordedMotion& motion_;
  double late_;
  Random random_;
  Monitor monitor_;
  DrawnErrors exact_;
  std::vector<Joint> joints_;  // Scene::variables
  std::vector<Robot> robots_;
  std::vector<Pair> pairs_;
  std::uint32_t person_ = 0;
  Pose place_;          // of the person, at its stamp
  int person_age_ = 0;  // ticks
  std::vector<double> at_;
  std::int64_t now_ = kStart;
};

}  // namespace clearance::test
