// Stated motions of objects that are neither fixed nor part of a robot: poses over time, and bounds
// of the motion in an interval of time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/ask/trajectory.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

// An object at an instant, and its motion in a stretch around it.
struct ObjectState {
  std::uint32_t object = 0;
  Pose pose;
  // The velocity of its origin, in the world, m/s. It is constant in the stretch if that is in one
  // segment.
  Vec3 velocity = Vec3::Zero();
  double shift = 0.0;  // no farther does its origin move from its place at the instant, m
  double turn = 0.0;   // nor does it rotate by more, rad
  // The object's angular velocity, constant like the other one, rad/s in the world.
  Vec3 angular = Vec3::Zero();
};

class MovingObjects {
 public:
  // Takes the motions of a question, or returns what is wrong with them. The names of the objects
  // are known to be right: `objects` has their indices.
  [[nodiscard]] std::optional<std::string> take(const Question& question,
                                                std::span<const std::uint32_t> objects,
                                                std::span<const double> timeline);

  void place(const Stretch& stretch, double at) noexcept;
  [[nodiscard]] std::span<const ObjectState> states() const noexcept { return states_; }

 private:
  // The rotation between two poses: by `angle`, in [0, pi] rad, about `axis` of the object's frame.
  struct Turn {
    Vec3 axis = Vec3::UnitZ();
    double angle = 0.0;
  };
  void rest(const Pose& pose, ObjectState& state) const noexcept;

  std::span<const ObjectMotion> motions_;
  std::vector<ObjectState> states_;
  std::vector<std::vector<std::int32_t>> rows_;  // by motion, by segment of the timeline
  std::vector<std::vector<Turn>> turns_;         // by motion, between its rows
};

}  // namespace clearance
