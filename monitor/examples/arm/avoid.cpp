#include "monitor/examples/arm/avoid.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <span>

#include "monitor/examples/arm/world.hpp"

namespace clearance::avoid {
namespace {

constexpr std::chrono::milliseconds kPatience(500);
// A step advances the run's time by at most this, however long the machine stalled.
constexpr std::int64_t kLongestStepNs = 5'000'000;
// The first second leads from rest to the path and does not count.
constexpr double kLeadIn = 1.0;  // s

// Positions with a bent elbow, within the limits of the cell's arm.
std::vector<double> home_of(const Scene& scene) {
  constexpr double kHome[] = {0.0, -0.6, 0.0, 1.4, 0.0, 0.8, 0.0};
  std::vector<double> home(scene.variables.size(), 0.0);
  std::copy_n(kHome, std::min(std::size(kHome), home.size()), home.begin());
  return home;
}

// An upright figure of eight around the home position, in 8 s; it starts slowly.
class Path {
 public:
  explicit Path(const Vec3& middle) : middle_(middle) {}
  [[nodiscard]] Target at(double t_s) const {
    constexpr double kTurn = 2.0 * std::numbers::pi / 8.0;  // rad/s
    const double s = std::min(1.0, t_s / kLeadIn);
    const double grown = s * s * (3.0 - 2.0 * s), growing = 6.0 * s * (1.0 - s) / kLeadIn;
    const double a = kTurn * t_s;
    const Vec3 shape(0.0, 0.12 * std::sin(a), 0.06 * std::sin(2.0 * a));
    const Vec3 rate(0.0, 0.12 * kTurn * std::cos(a), 0.12 * kTurn * std::cos(2.0 * a));
    return {middle_ + grown * shape, grown * rate + growing * shape};
  }

 private:
  Vec3 middle_;
};

// The least distance of the arm from the obstacles.
class Nearest {
 public:
  Nearest(const Scene& scene, const ArmModel& arm, RunResult& result)
      : scene_(scene), arm_(arm), result_(result) {}
  void update(const clearance_msg_Gradients& gradients) {
    for (const auto& pair : std::span(gradients.pairs._buffer, gradients.pairs._length)) {
      const ObjectPair& objects = scene_.pairs[pair.pair];
      const Object &a = scene_.objects[objects.first], &b = scene_.objects[objects.second];
      const bool of_one_link = arm_.has(objects.first) != arm_.has(objects.second);
      const bool of_an_obstacle = of_one_link && !a.fixed && !b.fixed;
      if (!of_an_obstacle || !(pair.distance < result_.least_distance_m)) continue;
      result_.least_distance_m = pair.distance;
      result_.nearest = a.name + " - " + b.name;
    }
  }

 private:
  const Scene& scene_;
  const ArmModel& arm_;
  RunResult& result_;
};

// An arm that is late, or that was moved between two runs, is not known.
bool all_known(const clearance_msg_Gradients& gradients) {
  const auto known = [](const clearance_msg_PairGradient& pair) {
    return std::isfinite(pair.drift) &&
           std::ranges::all_of(std::span(pair.joints._buffer, pair.joints._length),
                               [](const auto& entry) { return std::isfinite(entry.rate); });
  };
  return std::ranges::all_of(std::span(gradients.pairs._buffer, gradients.pairs._length), known);
}

}  // namespace

// Each step waits for the daemon's answer to the last positions, computes new velocities, and
// advances the time.
RunResult run(const Cell& cell, client::Connection& connection, const RunOptions& options,
              const std::function<bool()>& go_on) {
  RunResult result;
  const Scene& scene = cell.scene;
  ArmModel arm(scene);
  std::vector<double> positions = home_of(scene), velocities(positions.size(), 0.0);
  const Controller controller(scene, arm, positions, options.controller);
  arm.place(positions);
  const Path path(arm.end_point());
  World world(cell, connection, "avoid arm", "avoid obstacles");
  client::Gradients gradients(connection, {.old_after = kPatience, .depth = 4});
  Nearest nearest(scene, arm, result);

  double t_s = 0.0, errors = 0.0;
  const std::int64_t patience_ns = 10 * std::chrono::nanoseconds(kPatience).count();
  std::int64_t now_ns = client::now_ns(), answered_ns = now_ns;
  while (t_s < options.seconds && go_on()) {
    const std::int64_t stamp_ns = world.send(t_s, positions, velocities);
    // Waits for a tick that began after the stamp.
    while (gradients.next(std::chrono::milliseconds(20)) && gradients->now_ns < stamp_ns) {
    }
    const std::int64_t before_ns = now_ns;
    now_ns = client::now_ns();
    if (gradients->now_ns < stamp_ns || !all_known(*gradients)) {
      if (now_ns - answered_ns > patience_ns) return result;
      std::ranges::fill(velocities, 0.0);
      continue;
    }
    answered_ns = now_ns;
    nearest.update(*gradients);
    arm.place(positions);
    const Target target = path.at(t_s);
    if (t_s > kLeadIn) {
      const double error = (arm.end_point() - target.position).norm();
      errors += error;
      result.largest_error_m = std::max(result.largest_error_m, error);
      result.mean_error_m = errors / static_cast<double>(++result.steps);
    }
    velocities = controller.velocities(positions, target, *gradients);
    const double step_s = 1e-9 * static_cast<double>(std::min(now_ns - before_ns, kLongestStepNs));
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += step_s * velocities[i];
    t_s += step_s;
  }
  result.heard = result.steps > 0;
  return result;
}

}  // namespace clearance::avoid
