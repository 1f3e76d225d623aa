#include "tools/shared/joint_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clearance {
namespace {

// Defaults for joints without limits: speed, rad/s or m/s, and amplitude, rad or m.
constexpr double kUsualSpeed = 0.5;
constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
constexpr double kSlide = 0.2;
// The largest frequency, however small the amplitude.
constexpr double kHighest = 0.3;  // Hz
constexpr double kOfSpeed = 0.5;
// The golden ratio spreads frequencies and phases, so that no two joints move alike for long.
constexpr double kGolden = 0.6180339887498949;

bool is_bounded(const JointVariable& variable) noexcept {
  return std::isfinite(variable.lower) && std::isfinite(variable.upper);
}

Swing swing_of(const JointVariable& variable, double share, double free_amplitude,
               std::size_t number) {
  Swing swing;
  if (variable.is_held()) return {.centre = variable.held};
  swing.centre = is_bounded(variable) ? 0.5 * (variable.lower + variable.upper) : 0.0;
  swing.amplitude =
      is_bounded(variable) ? 0.5 * share * (variable.upper - variable.lower) : free_amplitude;
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

}  // namespace

JointSample moving_joint(std::size_t variable, double position, double velocity) {
  JointSample sample;
  sample.variable = static_cast<std::uint32_t>(variable);
  sample.position = position;
  sample.velocity = velocity;
  sample.has_velocity = true;
  return sample;
}

// The last of the seven positions of a floating joint is the real part of its quaternion. It stays
// 1: no rotation.
JointSweep::JointSweep(const Scene& scene, double share) {
  for (const JointVariable& variable : scene.variables) {
    swings_.push_back(swing_of(variable, share, kQuarterTurn, swings_.size()));
  }
  for (const Robot& robot : scene.robots) {
    for (const RobotJoint& joint : robot.joints) {
      const std::uint32_t count = variables_of(joint.type);
      if (count < 2) continue;
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t at = joint.variable + i;
        const bool slides = i < (joint.type == JointType::kPlanar ? 2u : 3u);
        if (slides) swings_[at] = swing_of(scene.variables[at], share, kSlide, at);
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
    joints.push_back(moving_joint(i, swing.centre + swing.amplitude * std::sin(angle),
                                  swing.amplitude * rate * std::cos(angle)));
  }
}

}  // namespace clearance
