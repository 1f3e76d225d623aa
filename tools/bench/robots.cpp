#include "tools/bench/rows.hpp"

#include <fmt/format.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/tick/monitor.hpp"
#include "tools/bench/cells.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/ticks.hpp"
#include "tools/shared/joint_sweep.hpp"

namespace clearance::bench {
namespace {

constexpr int kTicks = 20'000;
constexpr std::int64_t kFirst = 1'000'000'000, kPeriod = 1'000'000;  // ns

// The robots of a cell, each joint swinging through its range.
class MovingRobots {
 public:
  explicit MovingRobots(const Scene& scene)
      : scene_(scene),
        sweep_(scene),
        variables_(scene.variables.size()),
        bases_(scene.robots.size()),
        kinematics_(scene.robots) {
    for (std::size_t robot = 0; robot < bases_.size(); ++robot) {
      const RobotBase& base = scene.robots[robot].base;
      if (base.kind != RobotBase::Kind::kObject) continue;
      bases_[robot].known = true;
      bases_[robot].pose = scene.objects[base.object].world_from_object;
    }
  }

  void move(std::int64_t now_ns) {
    sweep_.at(1e-9 * static_cast<double>(now_ns), joints_);
    for (JointSample& joint : joints_) joint.stamp_ns = now_ns;
  }
  [[nodiscard]] const std::vector<JointSample>& joints() const noexcept { return joints_; }

  // Does the tick's work for joints: takes in each joint state, and places all links.
  void place(std::int64_t now_ns) noexcept {
    for (const JointSample& joint : joints_) {
      const JointVariable& variable = scene_.variables[joint.variable];
      static_cast<void>(take(variable, joint, now_ns, {.now_ns = now_ns},
                             variables_[joint.variable],
                             variables_[variable.first_of_joint].repetition));
      advance(variable, now_ns, variables_[joint.variable]);
    }
    kinematics_.place(variables_, bases_);
  }

  // The poses and twists of the links that move, as a source without joints would send them.
  [[nodiscard]] std::vector<PoseSample> poses(std::int64_t now_ns) const {
    std::vector<PoseSample> samples;
    for (std::uint32_t robot = 0; robot < scene_.robots.size(); ++robot) {
      for (std::size_t i = 0; i < scene_.robots[robot].links.size(); ++i) {
        const std::uint32_t object = scene_.robots[robot].links[i].object;
        if (object == RobotLink::kNoObject || scene_.objects[object].fixed) continue;
        const LinkState& link = kinematics_.links(robot)[i];
        samples.push_back({object, 0, now_ns, link.pose, link.twist, true});
      }
    }
    return samples;
  }

 private:
  const Scene& scene_;
  JointSweep sweep_;
  std::vector<JointSample> joints_;
  std::vector<TrackedVariable> variables_;  // as Scene::variables
  std::vector<LinkState> bases_;            // by robot
  ForwardKinematics kinematics_;
};

std::size_t joints_in(const Scene& scene) {
  std::size_t joints = 0;
  for (const Robot& robot : scene.robots) joints += robot.joints.size();
  return joints;
}

// The time of `timed` in each cycle of the robots, after `prepare`; both are told the time.
template <class Prepare, class Timed>
void time_cycles(benchmark::State& state, const Scene& scene, const Prepare& prepare,
                 const Timed& timed) {
  std::vector<double> times;
  std::int64_t now_ns = kFirst;
  const double clock_cost = cost_of(wall_ns);
  for (auto _ : state) {
    now_ns += kPeriod;
    prepare(now_ns);
    const double start = wall_ns();
    timed(now_ns);
    times.push_back(std::max(0.0, wall_ns() - start - clock_cost));
    state.SetIterationTime(1e-9 * times.back());
  }
  state.counters["joints"] = static_cast<double>(joints_in(scene));
  state.counters["pairs"] = static_cast<double>(scene.pairs.size());
  count_times(times, state);
}

void time_kinematics(benchmark::State& state, const Scene& scene) {
  MovingRobots robots(scene);
  time_cycles(
      state, scene, [&](std::int64_t now_ns) { robots.move(now_ns); },
      [&](std::int64_t now_ns) { robots.place(now_ns); });
}

enum class Input { kPoses, kJoints };

void time_ticks(benchmark::State& state, const Scene& scene, Input input) {
  MovingRobots robots(scene);
  Monitor monitor(scene);
  std::vector<JointSample> joints;
  std::vector<PoseSample> poses;
  const auto prepare = [&](std::int64_t now_ns) {
    robots.move(now_ns);
    if (input == Input::kJoints) {
      joints = robots.joints();
    } else {
      robots.place(now_ns);
      poses = robots.poses(now_ns);
    }
  };
  time_cycles(state, scene, prepare,
              [&](std::int64_t now_ns) { monitor.tick(poses, joints, now_ns); });
}

void register_robot(const std::string& name, Scene read) {
  read.gradients = false;
  const auto scene = std::make_shared<Scene>(std::move(read));
  const auto with_gradients = std::make_shared<Scene>(*scene);
  with_gradients->gradients = true;
  register_tick_row(fmt::format("robot/kinematics/{}", name), kTicks,
                    [scene](benchmark::State& s) { time_kinematics(s, *scene); });
  register_tick_row(fmt::format("robot/tick/poses/{}", name), kTicks,
                    [scene](benchmark::State& s) { time_ticks(s, *scene, Input::kPoses); });
  register_tick_row(fmt::format("robot/tick/joints/{}", name), kTicks,
                    [scene](benchmark::State& s) { time_ticks(s, *scene, Input::kJoints); });
  register_tick_row(
      fmt::format("robot/tick/gradients/{}", name), kTicks,
      [with_gradients](benchmark::State& s) { time_ticks(s, *with_gradients, Input::kJoints); });
}

}  // namespace

void register_robots(const std::vector<std::filesystem::path>& cells) {
  for (const std::filesystem::path& file : cells) {
    std::optional<Cell> cell = read_or_say(file);
    if (cell && !cell->scene.robots.empty())
      register_robot(file.stem().string(), std::move(cell->scene));
  }
}

}  // namespace clearance::bench
