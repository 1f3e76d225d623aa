// A question about a motion before it is made, and its answer.
//
// SI units: m, rad, s. Distances here are not negative: bodies that overlap have distance 0.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/pose.hpp"

namespace clearance {

// Waypoints of some joints, as in trajectory_msgs/JointTrajectory. Between two waypoints every
// joint moves linearly in time. With velocities it moves along the cubic polynomial that has the
// positions and the velocities of both waypoints.
struct JointTrajectory {
  std::vector<std::string> joints;  // names of Scene::variables
  std::vector<double> times;        // s, increasing; one for each row
  std::vector<double> positions;    // row by row, one entry for each joint; rad or m
  std::vector<double> velocities;   // as positions, rad/s or m/s; empty: linear
};

struct HeldJoint {
  std::string name;
  double position = 0.0;  // rad or m
};

struct StatedPose {
  std::string object;
  Pose world_from_object;
};

// The motion of objects that are neither fixed nor part of a robot.
enum class OthersMove : std::uint8_t {
  kWithinMaxSpeed,  // within max_speed x time since the first waypoint
  kNot,
};

struct Question {
  JointTrajectory motion;
  std::vector<HeldJoint> held;    // every other joint of the cell
  std::vector<StatedPose> poses;  // of objects that are neither fixed nor part of a robot
  OthersMove others = OthersMove::kWithinMaxSpeed;
  std::vector<double> margins = {0.0};  // m, from 0 on
  double tolerance = 1e-3;              // m: `upper` - `lower` at the end
  // m: a margin is undecided if the least distance is nearer to it than this.
  double margin_tolerance = 1e-10;
  // m: a motion that is certainly farther away than this is not examined more closely.
  double far_enough = 1e300;
  std::uint64_t work_limit = 1'000'000;  // distance queries
};

enum class Verdict : std::uint8_t { kFree, kBelow, kUndecided };

[[nodiscard]] const char* name(Verdict verdict) noexcept;

// `margin` 0 asks for contact: free means that the bodies are disjoint at all instants.
struct MarginAnswer {
  double margin = 0.0;
  Verdict verdict = Verdict::kUndecided;
  // Unless free: the distance is at least the margin at all instants before `above_until`, s.
  double above_until = 0.0;
  // If below: at this instant the distance is below the margin, s. No earlier one is known.
  double below_at = 0.0;
  std::uint32_t first = 0, second = 0;  // the pair that is below it, or may be; Scene::objects
};

struct Answer {
  // The least distance over all instants of the motion is in [lower, upper], m.
  double lower = 0.0, upper = 0.0;
  // The instant (s), the pair (indices into Scene::objects) and its closest points in the world
  // where `upper` is attained. If the bodies overlap, the points are of no use.
  double time = 0.0;
  std::uint32_t first = 0, second = 0;
  Vec3 point_on_first = Vec3::Zero(), point_on_second = Vec3::Zero();
  bool has_pair = false;              // false: no watched pair has a link of the cell's robots
  std::vector<MarginAnswer> margins;  // in the order of the question
  bool within_work_limit = true;      // false: the bounds hold, but may be wider than asked for
  std::uint64_t queries = 0;          // distance queries
  std::uint64_t placements = 0;       // of all links
};

}  // namespace clearance
