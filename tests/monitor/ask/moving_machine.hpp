// A machine in time for StoppableCampaign. It follows the cubics of its waypoints, by their own
// formula, until its brakes act at some instant. Then it goes on along its path, or each joint by
// itself, within its table by some law. Others move meanwhile, as fast as the question says.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "monitor/interface/question.hpp"
#include "tests/monitor/ask/arms_that_stop.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/true_bodies.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

// A motion of the left arm, or of both; the other one and a person are beside it.
class MovingMachine {
 public:
  MovingMachine(const Scene& scene, std::uint64_t seed)
      : scene_(scene), left_(scene.robots[0]), random_(seed), exact_(errors()) {}

  // The right arm rests, or may move, or with `together` has waypoints. The person may move.
  Question draw(bool others_move, bool together = false) {
    question_ = {};
    question_.stoppable = true;
    question_.others = others_move ? OthersMove::kWithinMaxSpeed : OthersMove::kNot;
    question_.margins = {0.0, 0.02, 0.05};
    question_.only_margins = random_.chance(0.5);
    resting_.assign(scene_.variables.size(), 0.0);
    JointTrajectory& motion = question_.motion;
    const std::size_t rows = 2 + static_cast<std::size_t>(random_.uniform(0.0, 4.0));
    motion.times = {random_.uniform(-1.0, 1.0)};
    while (motion.times.size() < rows)
      motion.times.push_back(motion.times.back() + random_.uniform(0.05, 0.5));
    std::vector<std::uint32_t> moved;
    for (std::uint32_t v = 0; v < scene_.variables.size(); ++v) {
      const JointVariable& of = scene_.variables[v];
      const double low = 0.8 * std::max(of.lower, -2.5), high = 0.8 * std::min(of.upper, 2.5);
      resting_[v] = random_.uniform(low, high);
      if (of.robot == 0 || together) {
        moved.push_back(v);
        motion.joints.push_back(of.name);
      } else if (others_move && random_.chance(0.3)) {
        question_.joints.push_back(
            {.name = of.name, .position = resting_[v], .age = random_.uniform(0.0, 0.05)});
      } else {
        question_.held.push_back({of.name, resting_[v]});
      }
    }
    const double share = random_.uniform(0.1, 0.8);  // of the largest speeds
    for (std::size_t row = 0; row < rows; ++row) {
      for (const std::uint32_t v : moved) {
        const JointVariable& of = scene_.variables[v];
        double next = resting_[v];
        if (row > 0) {
          const double most = share * of.max_speed * (motion.times[row] - motion.times[row - 1]);
          next = motion.positions[motion.positions.size() - moved.size()] +
                 most * random_.uniform(-1.0, 1.0);
        }
        motion.positions.push_back(std::clamp(next, of.lower, of.upper));
      }
    }
    if (random_.chance(0.6)) draw_velocities(share, moved);
    for (const Object& object : scene_.objects) {
      if (object.name != "person") continue;
      person_ = Vec3(1.0, 0.0, 1.0) + random_.uniform(0.5, 3.0) * random_.direction();
      question_.poses = {
          {.object = object.name, .world_from_object = at(person_.x(), person_.y(), person_.z())}};
    }
    return question_;
  }

  // The same motion at `factor` of its speed.
  Question slow_down(double factor) {
    for (double& time : question_.motion.times) time /= factor;
    for (double& velocity : question_.motion.velocities) velocity *= factor;
    return question_;
  }

  // The poses at an instant of a stop. `farthest`: joints that leave the path have come as far as
  // their tables say, or stand where they were.
  std::vector<Pose> drawn_instant(bool farthest = false) {
    const JointTrajectory& motion = question_.motion;
    const double begin = motion.times.front(), end = motion.times.back();
    const RobotStops& stops = left_.stopping;
    double acts = random_.uniform(begin, end);
    if (random_.chance(0.3))
      acts = end + (random_.chance(0.5) ? 1.0 : random_.unit()) * stops.reaction;
    std::vector<double> at = resting_, speeds;
    double in_proportion = 0.0, longest = 0.0;
    for (std::size_t k = 0; k < motion.joints.size(); ++k) {
      const JointStop& stop = stop_of(k);
      speeds.push_back(state(k, acts).speed);
      const double speed = std::abs(speeds.back());
      if (speed > 0.0) in_proportion = std::max(in_proportion, stop.distance(speed) / speed);
      longest = std::max(longest, stop.time(speed));
    }
    const double share = random_.chance(0.4) ? 1.0 : random_.unit();
    const double along = in_proportion * (random_.chance(0.5) ? share : share * random_.unit());
    for (std::size_t k = 0; k < motion.joints.size(); ++k) {
      const std::uint32_t v = variable(k);
      const State now = state(k, acts);
      at[v] = now.position;
      if (stops.keeps_path)
        at[v] = state(k, acts + along).position;
      else if (farthest)
        at[v] += random_.chance(0.7)
                     ? std::copysign(stop_of(k).distance(std::abs(now.speed)), now.speed)
                     : 0.0;
      else
        at[v] += std::copysign(went(stop_of(k), std::abs(now.speed), share * longest, random_),
                               now.speed);
      // What slides does not leave its limits.
      if (joint_of(k).type == JointType::kPrismatic)
        at[v] = std::clamp(at[v], scene_.variables[v].lower, scene_.variables[v].upper);
    }
    return poses_at(at, acts - begin + share * longest);
  }

  // The same of a stop of both arms, which are told at one instant. The brakes of each act by then.
  std::vector<Pose> drawn_instant_together(bool farthest) {
    const JointTrajectory& motion = question_.motion;
    const double begin = motion.times.front();
    const double told = random_.uniform(begin, motion.times.back());
    std::vector<Braking> arms;
    double all_stand = told;
    for (const Robot& robot : scene_.robots) {
      Braking& arm = arms.emplace_back();
      arm.acts = told + (random_.chance(0.5) ? 1.0 : random_.unit()) * robot.stopping.reaction;
      arm.share_of_law = random_.chance(0.5) ? 1.0 : random_.unit();
      for (std::size_t k = 0; k < motion.joints.size(); ++k) {
        if (&robot_of(k) != &robot) continue;
        const double speed = std::abs(state(k, arm.acts).speed);
        if (speed > 0.0)
          arm.in_proportion = std::max(arm.in_proportion, stop_of(k).distance(speed) / speed);
        arm.longest = std::max(arm.longest, stop_of(k).time(speed));
      }
      all_stand = std::max(all_stand, arm.acts + arm.longest);
    }
    const double now = farthest ? all_stand : random_.uniform(told, all_stand);
    std::vector<double> at = resting_;
    for (std::size_t k = 0; k < motion.joints.size(); ++k) {
      const Braking& arm = arms[scene_.variables[variable(k)].robot];
      const State acts = state(k, std::min(now, arm.acts));
      const double since = std::max(0.0, now - arm.acts);
      const double share = since >= arm.longest ? 1.0 : since / arm.longest;
      double& position = at[variable(k)];
      position = acts.position;
      if (since > 0.0 && robot_of(k).stopping.keeps_path)
        position = state(k, arm.acts + arm.in_proportion * share * arm.share_of_law).position;
      else if (farthest)
        position += std::copysign(stop_of(k).distance(std::abs(acts.speed)), acts.speed);
      else if (since > 0.0)
        position +=
            std::copysign(went(stop_of(k), std::abs(acts.speed), since, random_), acts.speed);
      if (joint_of(k).type == JointType::kPrismatic)
        position = std::clamp(position, scene_.variables[variable(k)].lower,
                              scene_.variables[variable(k)].upper);
    }
    return poses_at(at, now - begin);
  }

 private:
  // A stop of one of two arms.
  struct Braking {
    double acts = 0.0, in_proportion = 0.0, longest = 0.0, share_of_law = 1.0;  // s
  };
  struct State {
    double position = 0.0, speed = 0.0;
  };

  DrawnErrors errors() { return drawn_errors(scene_, random_); }

  void draw_velocities(double share, const std::vector<std::uint32_t>& moved) {
    JointTrajectory& motion = question_.motion;
    const bool ends_at_rest = random_.chance(0.6);
    for (std::size_t row = 0; row < motion.times.size(); ++row) {
      const bool rests = row == 0 || (row + 1 == motion.times.size() && ends_at_rest);
      for (const std::uint32_t v : moved) {
        const JointVariable& of = scene_.variables[v];
        // What slides within a few centimetres would leave its limits between its waypoints.
        const bool is_small = of.upper - of.lower < 0.2;
        motion.velocities.push_back(
            rests || is_small ? 0.0 : share * of.max_speed * random_.uniform(-1.0, 1.0));
      }
    }
  }

  [[nodiscard]] std::uint32_t variable(std::size_t k) const {
    const auto at =
        std::ranges::find(scene_.variables, question_.motion.joints[k], &JointVariable::name);
    return static_cast<std::uint32_t>(at - scene_.variables.begin());
  }
  [[nodiscard]] const Robot& robot_of(std::size_t k) const {
    return scene_.robots[scene_.variables[variable(k)].robot];
  }
  [[nodiscard]] const RobotJoint& joint_of(std::size_t k) const {
    return *std::ranges::find(robot_of(k).joints, question_.motion.joints[k], &RobotJoint::name);
  }
  [[nodiscard]] const JointStop& stop_of(std::size_t k) const {
    const Robot& robot = robot_of(k);
    return robot.stopping.joints[static_cast<std::size_t>(&joint_of(k) - robot.joints.data())];
  }

  // By the basis functions of Hermite; past the end in a line.
  [[nodiscard]] State state(std::size_t k, double t) const {
    const JointTrajectory& m = question_.motion;
    const std::size_t n = m.joints.size(), rows = m.times.size();
    std::size_t row = 0;
    while (row + 2 < rows && t >= m.times[row + 1]) ++row;
    const double h = m.times[row + 1] - m.times[row];
    const double p0 = m.positions[row * n + k], p1 = m.positions[(row + 1) * n + k];
    if (t > m.times.back()) {
      const double speed = m.velocities.empty() ? (p1 - p0) / h : m.velocities[(rows - 1) * n + k];
      return {p1 + speed * (t - m.times.back()), speed};
    }
    const double u = (t - m.times[row]) / h;
    if (m.velocities.empty()) return {p0 + u * (p1 - p0), (p1 - p0) / h};
    const double v0 = h * m.velocities[row * n + k], v1 = h * m.velocities[(row + 1) * n + k];
    const double u2 = u * u, u3 = u2 * u;
    return {p0 * (2 * u3 - 3 * u2 + 1) + v0 * (u3 - 2 * u2 + u) + p1 * (3 * u2 - 2 * u3) +
                v1 * (u3 - u2),
            (6 * (p1 - p0) * (u - u2) + v0 * (3 * u2 - 4 * u + 1) + v1 * (3 * u2 - 2 * u)) / h};
  }

  // `elapsed`: since the first waypoint, s.
  std::vector<Pose> poses_at(std::vector<double>& at, double elapsed) {
    std::vector<Pose> sent(scene_.objects.size(), test::at(person_.x(), person_.y(), person_.z()));
    if (question_.others == OthersMove::kWithinMaxSpeed) {
      for (const StatedJoint& stated : question_.joints) {
        const auto v = static_cast<std::size_t>(
            std::ranges::find(scene_.variables, stated.name, &JointVariable::name) -
            scene_.variables.begin());
        const JointVariable& of = scene_.variables[v];
        at[v] = std::clamp(at[v] + random_.sign() * of.max_speed * (elapsed + stated.age), of.lower,
                           of.upper);
      }
      // The person goes towards one of the arm's links.
      const std::vector<Pose> now = true_poses(scene_, at, sent, exact_);
      const RobotLink& link = left_.links[static_cast<std::size_t>(
          random_.uniform(0.0, static_cast<double>(left_.links.size())))];
      Vec3 towards = random_.direction();
      if (link.object != RobotLink::kNoObject) towards = now[link.object].position - person_;
      if (!(towards.norm() > 1e-6)) towards = Vec3::UnitX();
      for (Pose& pose : sent) pose.position += kPersonSpeed * elapsed * towards.normalized();
    }
    return true_poses(scene_, at, sent, exact_);
  }

  const Scene& scene_;
  const Robot& left_;
  Random random_;
  DrawnErrors exact_;
  Question question_;
  std::vector<double> resting_;  // by variable
  Vec3 person_ = Vec3::Zero();
};

}  // namespace clearance::test
