#include "monitor/examples/arm/stops.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "config/cell/simulation.hpp"
#include "core/distance.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/examples/arm/swinging_joint.hpp"
#include "monitor/examples/arm/world.hpp"

namespace clearance::stops {
namespace {

constexpr std::chrono::milliseconds kPatience(500);
constexpr double kStep = 5e-3;    // s, at most: of the machine and of the true distance
constexpr double kProgram = 0.6;  // speed of its motion, of the joint's limit
constexpr double kSlow = 0.25;    // of that, in the zone `slow`
// Both places of the first joint, rad, and a stretched arm.
constexpr double kFrom = -0.9, kTo = 0.9;
constexpr double kPosture[] = {kFrom, 1.1, 0.0, 0.2, 0.0, 0.3, 0.0};

SwingingJointOptions options_of(const Cell& cell) {
  const Scene& scene = cell.scene;
  if (scene.robots.size() != 1 || !scene.robots[0].stopping.is_stated() ||
      scene.robots[0].stopping.max_accelerations.empty() || cell.simulation.movers.size() != 1)
    throw std::invalid_argument(
        "the cell has to have one robot that states 'stopping' with 'acceleration', and one mover");
  const Robot& robot = scene.robots[0];
  const auto joint = std::ranges::find(robot.joints, scene.variables[0].name, &RobotJoint::name);
  const auto index = static_cast<std::size_t>(joint - robot.joints.begin());
  return {.from = kFrom,
          .to = kTo,
          .full_speed = kProgram * scene.variables[0].max_speed,
          .acceleration = robot.stopping.max_accelerations[index],
          .reaction = robot.stopping.reaction,
          .stop = robot.stopping.joints[index]};
}

// How fast the arm may be, by the daemon's answers.
class Answers {
 public:
  explicit Answers(client::Connection& connection)
      : reports_(connection, {.old_after = kPatience, .depth = 4}),
        separation_(connection, {.old_after = kPatience, .depth = 4}),
        zones_(connection) {}

  // Waits for those of a tick that began after the stamp.
  bool wait_for(std::int64_t stamp_ns) {
    while (separation_.next(std::chrono::milliseconds(20)) && separation_->now_ns < stamp_ns) {
    }
    while (reports_.next(std::chrono::milliseconds(20)) && reports_->now_ns < stamp_ns) {
    }
    zones_.update(*reports_);
    return separation_->now_ns >= stamp_ns && reports_->now_ns >= stamp_ns;
  }
  [[nodiscard]] bool is_known() const {
    return separation_->stops._length > 0 && separation_->stops._buffer[0].validity != 0;
  }
  // `speed` is that of the positions which this tick has used.
  [[nodiscard]] double allowed(Obeyed obeyed, double speed, double full_speed) const {
    double scaling = 1.0;
    switch (obeyed) {
      case Obeyed::kZones:
        return is_active("stop") ? 0.0 : is_active("slow") ? kSlow * full_speed : full_speed;
      case Obeyed::kSeparation:
        for (const auto& zone : std::span(separation_->zones._buffer, separation_->zones._length))
          scaling = std::min(scaling, zone.scaling);
        break;
      case Obeyed::kStops:
        for (const auto& stop : std::span(separation_->stops._buffer, separation_->stops._length))
          scaling = std::min(scaling, stop.scaling);
        break;
    }
    return scaling < 1.0 ? scaling * speed : full_speed;
  }

 private:
  [[nodiscard]] bool is_active(const char* name) const {
    return std::ranges::any_of(zones_.states(), [name](const auto& each) {
      return each.second.active && std::string_view(each.second.name) == name;
    });
  }

  client::Reports reports_;
  client::Separation separation_;
  client::Zones zones_;
};

// Where the bodies truly are, without the daemon.
class Truth {
 public:
  explicit Truth(const Cell& cell)
      : cell_(cell), states_(cell.scene.variables.size()), kinematics_(cell.scene.robots) {}

  // m, between the arm and the person.
  double distance_at(double t_s, const std::vector<double>& positions) {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      states_[i].input.has_value = true;
      states_[i].position = positions[i];
    }
    kinematics_.place(states_, {});
    poses_at(cell_.simulation, t_s, people_);
    const auto& objects = cell_.scene.objects;
    const std::span<const LinkState> links = kinematics_.links(0);
    double least = kInfinity;
    for (std::size_t i = 0; i < links.size(); ++i) {
      const std::uint32_t link = cell_.scene.robots[0].links[i].object;
      if (link == RobotLink::kNoObject) continue;
      for (const PoseAt& person : people_)
        least = std::min(least, distance_of(objects[link], links[i].pose, objects[person.object],
                                            person.world_from_object));
    }
    return least;
  }

 private:
  static double distance_of(const Object& a, const Pose& world_from_a, const Object& b,
                            const Pose& world_from_b) {
    double least = kInfinity;
    for (const Part& part_a : a.parts) {
      for (const Part& part_b : b.parts) {
        TrackingState cold;
        const DistanceResult found =
            distance(part_a.shape, part_b.shape, compose(world_from_a, part_a.object_from_part),
                     compose(world_from_b, part_b.object_from_part), cold);
        least = std::min(least, found.upper);
      }
    }
    return least;
  }

  const Cell& cell_;
  std::vector<TrackedVariable> states_;
  ForwardKinematics kinematics_;
  std::vector<PoseAt> people_;
};

}  // namespace

RunResult run(const Cell& cell, client::Connection& connection, const RunOptions& options,
              const std::function<bool()>& go_on) {
  RunResult result;
  const SwingingJointOptions machine = options_of(cell);
  SwingingJoint swing(machine);
  std::vector<double> positions(cell.scene.variables.size(), 0.0), velocities(positions);
  std::copy_n(kPosture, std::min(std::size(kPosture), positions.size()), positions.begin());
  World world(cell, connection, "stopping arm", "tracked person");
  Answers answers(connection);
  Truth truth(cell);

  double t_s = 0.0, full_s = 0.0;
  const std::int64_t patience_ns = 10 * std::chrono::nanoseconds(kPatience).count();
  const auto advance = [&](double seconds) {
    swing.advance(seconds);
    t_s += seconds;
    full_s += swing.is_at_full_speed() ? seconds : 0.0;
    positions[0] = swing.position();
    velocities[0] = swing.velocity();
    const double found = truth.distance_at(t_s, positions);
    result.least_distance_m = std::min(result.least_distance_m, found);
    if (velocities[0] != 0.0)
      result.least_while_moving_m = std::min(result.least_while_moving_m, found);
  };
  std::int64_t now_ns = client::now_ns(), answered_ns = now_ns;
  while (t_s < options.seconds && go_on()) {
    const std::int64_t stamp_ns = world.send(t_s, positions, velocities);
    const bool answered = answers.wait_for(stamp_ns);
    const std::int64_t before_ns = now_ns;
    now_ns = client::now_ns();
    if (answered) answered_ns = now_ns;
    if (now_ns - answered_ns > patience_ns) return result;
    // What was moved between two runs is not known at first.
    if (t_s == 0.0 && !(answered && answers.is_known())) continue;
    if (answered)
      swing.command(answers.allowed(options.obeyed, std::abs(velocities[0]), machine.full_speed));
    for (double left_s = 1e-9 * static_cast<double>(now_ns - before_ns); left_s > 0.0;
         left_s -= kStep)
      advance(std::min(left_s, kStep));
  }
  result.strokes = swing.strokes();
  result.at_full_speed = t_s > 0.0 ? full_s / t_s : 0.0;
  result.heard = t_s >= options.seconds;
  return result;
}

}  // namespace clearance::stops
