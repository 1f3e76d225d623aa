#include "tools/robot/joint_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "monitor/csv/table.hpp"

namespace clearance {
namespace {

// Where nothing is stated: rad/s or m/s, and how far to either side, rad or m.
constexpr double kUsualSpeed = 0.5;
constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
constexpr double kReach = 0.2;
// No faster than this, however short the way.
constexpr double kHighest = 0.3;  // Hz
constexpr double kOfRange = 0.45, kOfSpeed = 0.5;
// Paces and phases of which no two are alike for long.
constexpr double kGolden = 0.6180339887498949;

bool is_bounded(const JointVariable& variable) noexcept {
  return std::isfinite(variable.lower) && std::isfinite(variable.upper);
}

Swing swing_of(const JointVariable& variable, double free_reach, std::size_t number) {
  Swing swing;
  swing.centre = is_bounded(variable) ? 0.5 * (variable.lower + variable.upper) : 0.0;
  swing.amplitude =
      is_bounded(variable) ? kOfRange * (variable.upper - variable.lower) : free_reach;
  const double speed =
      kOfSpeed * (std::isfinite(variable.max_speed) ? variable.max_speed : kUsualSpeed);
  const double fraction = std::fmod(kGolden * static_cast<double>(number + 1), 1.0);
  swing.phase = 2.0 * std::numbers::pi * fraction;
  if (swing.amplitude > 0.0) {
    swing.frequency_hz = (0.7 + 0.3 * fraction) *
                         std::min(kHighest, speed / (2.0 * std::numbers::pi * swing.amplitude));
  }
  return swing;
}

JointSample sample_of(std::size_t variable, double position, double velocity) {
  JointSample sample;
  sample.variable = static_cast<std::uint32_t>(variable);
  sample.position = position;
  sample.velocity = velocity;
  sample.has_velocity = true;
  return sample;
}

// Nearest to 0 within the limits.
double rest_of(const JointVariable& variable) noexcept {
  return std::clamp(0.0, variable.lower, std::max(variable.lower, variable.upper));
}

}  // namespace

// The last of the seven positions of a floating joint is the real part of its quaternion, which
// stays that of no turn.
JointSweep::JointSweep(const Scene& scene) {
  for (const JointVariable& variable : scene.variables) {
    swings_.push_back(swing_of(variable, kQuarterTurn, swings_.size()));
  }
  for (const Robot& robot : scene.robots) {
    for (const RobotJoint& joint : robot.joints) {
      const std::uint32_t count = variables_of(joint.type);
      if (count < 2) continue;
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t at = joint.variable + i;
        const bool slides = i < (joint.type == JointType::kPlanar ? 2u : 3u);
        if (slides) swings_[at] = swing_of(scene.variables[at], kReach, at);
        if (joint.type == JointType::kFloating && !slides)
          swings_[at] = {.centre = i == 6 ? 1.0 : 0.0};
      }
    }
  }
}

void JointSweep::at(double t_s, std::vector<JointSample>& joints) const {
  joints.clear();
  for (std::size_t i = 0; i < swings_.size(); ++i) {
    const Swing& swing = swings_[i];
    const double rate = 2.0 * std::numbers::pi * swing.frequency_hz;
    const double angle = rate * t_s + swing.phase;
    joints.push_back(sample_of(i, swing.centre + swing.amplitude * std::sin(angle),
                               swing.amplitude * rate * std::cos(angle)));
  }
}

JointLogMotion::JointLogMotion(const std::filesystem::path& file, const Scene& scene) {
  for (const JointVariable& variable : scene.variables) resting_.push_back(rest_of(variable));
  const std::vector<std::string> header = csv_column_names(file);
  std::vector<std::string_view> columns = {"t_ns"};
  for (std::uint32_t i = 0; i < scene.variables.size(); ++i) {
    if (std::ranges::find(header, scene.variables[i].name) == header.end()) continue;
    columns.push_back(scene.variables[i].name);
    variables_.push_back(i);
  }
  CsvTable table(file, columns);
  while (table.next()) {
    Row row{0, std::vector<double>(variables_.size())};
    bool good = table.time_ns(0, row.t_ns);
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      good = good && table.number(i + 1, row.positions[i]);
    }
    if (good) rows_.push_back(std::move(row));
  }
  error_ = table.error();
  if (error_.empty() && (rows_.empty() || variables_.empty())) {
    error_ = fmt::format("{}: found no {}; expected t_ns and a column for each joint, by its name",
                         file.string(), rows_.empty() ? "rows" : "joint of the cell");
  }
}

double JointLogMotion::seconds() const noexcept {
  return rows_.empty() ? 0.0 : 1e-9 * static_cast<double>(rows_.back().t_ns - rows_.front().t_ns);
}

void JointLogMotion::at(double t_s, std::vector<JointSample>& joints) {
  joints.clear();
  for (std::size_t i = 0; i < resting_.size(); ++i)
    joints.push_back(sample_of(i, resting_[i], 0.0));
  const std::int64_t t_ns = rows_.front().t_ns + std::llround(1e9 * t_s);
  if (t_ns < rows_[at_].t_ns) at_ = 0;
  while (at_ + 1 < rows_.size() && rows_[at_ + 1].t_ns <= t_ns) ++at_;
  const Row& before = rows_[at_];
  const Row& after = rows_[std::min(at_ + 1, rows_.size() - 1)];
  const double span_s = 1e-9 * static_cast<double>(after.t_ns - before.t_ns);
  const double passed_s = 1e-9 * static_cast<double>(t_ns - before.t_ns);
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const double velocity =
        span_s > 0.0 ? (after.positions[i] - before.positions[i]) / span_s : 0.0;
    joints[variables_[i]] =
        sample_of(variables_[i], before.positions[i] + velocity * passed_s, velocity);
  }
}

}  // namespace clearance
