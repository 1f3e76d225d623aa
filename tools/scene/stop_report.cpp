#include "tools/scene/stop_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>
#include <vector>

#include "tools/plot/gnuplot.hpp"

namespace clearance {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Shares of the full speed, for a joint without printed speeds.
constexpr double kShares[] = {0.33, 0.66, 1.0};
constexpr int kSteps = 200;  // of a curve

// A joint with its stop, and the unit in which people read its position.
struct ShownJoint {
  const RobotJoint& joint;
  const JointStop& stop;
  double acceleration = 0.0;  // infinite: not stated
  double most = 0.0;          // speed: the full one, or the last printed one; per second
  double scale = 1.0;
  const char* unit = "m";
};

template <class Visit>
void each_joint(const Scene& scene, Visit&& visit) {
  for (const Robot& robot : scene.robots) {
    for (std::size_t i = 0; i < robot.stopping.joints.size(); ++i) {
      const RobotJoint& joint = robot.joints[i];
      if (variables_of(joint.type) != 1) continue;
      const JointVariable& variable = scene.variables[joint.variable];
      if (variable.name != joint.name) continue;  // it mimics another
      const JointStop& stop = robot.stopping.joints[i];
      const auto& points = stop.points();
      const double printed = points.empty() ? 1.0 : points.back().speed;
      ShownJoint shown{joint, stop, robot.stopping.max_accelerations[i],
                       std::isfinite(variable.max_speed) ? variable.max_speed : printed};
      if (joint.type != JointType::kPrismatic) {
        shown.scale = kDegrees;
        shown.unit = "deg";
      }
      visit(robot, shown);
    }
  }
}

// Returns the load that counts, if masses choose it.
std::string load_of(const CarriedLoad& load) {
  if (!(load.full > 0.0)) return "";
  return fmt::format("\n  rows up to {:g} % of the load, {}", 100.0 * load.step,
                     std::isfinite(load.mass)
                         ? fmt::format("for {:g} kg of {:g} kg", load.mass, load.full)
                         : "since not all that it carries has a mass");
}

// Returns the steps of the extension, if postures choose among them.
std::string steps_of(const RobotStops& stops) {
  std::vector<std::string> steps;
  for (const StopStep& step : stops.steps)
    steps.push_back(fmt::format("{:g}", 100.0 * step.extension));
  return steps.empty() ? ""
                       : fmt::format(
                             "\n  rows up to {} % of the extension, by the posture; here "
                             "those of the last step",
                             fmt::join(steps, ", "));
}

std::vector<double> speeds_of(const ShownJoint& shown) {
  std::vector<double> speeds;
  for (const StopPoint& point : shown.stop.points()) speeds.push_back(point.speed);
  if (speeds.empty())
    for (const double share : kShares) speeds.push_back(share * shown.most);
  return speeds;
}

}  // namespace

std::string stop_table(const Scene& scene) {
  std::string text;
  const Robot* last = nullptr;
  each_joint(scene, [&](const Robot& robot, const ShownJoint& shown) {
    if (std::exchange(last, &robot) != &robot) {
      text += fmt::format(
          "{}: category {}, brakes act after {:.0f} ms, the path is {}{}{}\n{:<24} {:>14} {:>14} "
          "{:>9}\n",
          robot.name, robot.stopping.category, 1e3 * robot.stopping.reaction,
          robot.stopping.keeps_path ? "kept" : "left", load_of(robot.stopping.load),
          steps_of(robot.stopping), "  joint", "from, per s", "goes on for", "in, ms");
    }
    for (const double speed : speeds_of(shown)) {
      text += fmt::format("  {:<22} {:>10.2f} {:<3} {:>10.3f} {:<3} {:>9.0f}\n", shown.joint.name,
                          shown.scale * speed, shown.unit, shown.scale * shown.stop.distance(speed),
                          shown.unit, 1e3 * shown.stop.time(speed));
    }
    if (std::isfinite(shown.acceleration))
      text += fmt::format("  {:<22} gains at most {:.2f} {} per s each second\n", shown.joint.name,
                          shown.scale * shown.acceleration, shown.unit);
  });
  return text;
}

std::string stop_plot(const Scene& scene) {
  std::string data, curves;
  int number = 0;
  each_joint(scene, [&](const Robot&, const ShownJoint& shown) {
    data += fmt::format("$joint{} << END\n", number);
    for (int i = 0; i <= kSteps; ++i) {
      const double speed = shown.most * i / kSteps;
      data += fmt::format("{:.6g} {:.6g} {:.6g}\n", 100.0 * i / kSteps,
                          shown.scale * shown.stop.distance(speed), 1e3 * shown.stop.time(speed));
    }
    data += "END\n";
    curves +=
        fmt::format("{}$joint{} using 1:2 with lines linewidth 1.6 linecolor rgb '{}' title {}",
                    number == 0 ? "plot " : ", ", number,
                    kPlotColours[static_cast<std::size_t>(number) % std::size(kPlotColours)],
                    plot_text(fmt::format("{}, {}", shown.joint.name, shown.unit)));
    ++number;
  });
  return data +
         "set grid linecolor rgb '#e4e4e4'\nset border 3\nset tics nomirror\nset yrange [0:*]\n"
         "set key left top\nset xlabel 'percent of the full speed'\n"
         "set ylabel 'until the joint stands'\n" +
         curves + "\n";
}

}  // namespace clearance
