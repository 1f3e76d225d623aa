// A question about a motion before it is made, and its answer.
//
// SI units: m, rad, s. Distances here are not negative: bodies that overlap have distance 0. All
// times count on the clock of the motion's waypoints; its first one is "now".
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance {

class SeenCloud;  // monitor/clouds

// Waypoints of some joints, as in trajectory_msgs/JointTrajectory. Between two waypoints every
// joint moves linearly in time. With velocities it moves along the cubic polynomial that has the
// positions and the velocities of both waypoints.
struct JointTrajectory {
  std::vector<std::string> joints;  // names of Scene::variables
  std::vector<double> times;        // s, increasing; one for each row
  std::vector<double> positions;    // row by row, one entry for each joint; rad or m
  std::vector<double> velocities;   // as positions, rad/s or m/s; empty: linear
  // At any instant, a joint may be off by this; one entry for each joint, rad or m; empty: 0.
  std::vector<double> deviations = {};
};

// A joint that stays where it is.
struct HeldJoint {
  std::string name;
  double position = 0.0;  // rad or m
};

// A joint of a robot whose motion nothing states.
struct StatedJoint {
  std::string name;
  double position = 0.0;    // rad or m
  double age = 0.0;         // s, from 0 on: it was there this long before the first waypoint
  double most = kInfinity;  // rad or m: it deviates from there by no more
  double speed = 0.0;       // rad/s or m/s: its last one, which may exceed its max_speed
};

struct StatedPose {
  std::string object;
  Pose world_from_object;
  double age = 0.0;  // s, from 0 on: it was there this long before the first waypoint
  // An object on which a robot stands does not rotate faster, rad/s. Infinity: not stated.
  double turn_speed = kInfinity;
  bool is_known = true;  // false: the object is left out, so that no bound counts it
};

// The newest frame of a sensor of the cell. What it shows comes nearer by the `max_speed` of the
// sensor's object, counted from the stamp of the frame.
struct SeenFrame {
  std::string sensor;  // the name of its object
  // Shows its place (SeenCloud); does not change while the question is asked.
  std::shared_ptr<const SeenCloud> cloud = {};
  Pose world_from_sensor = {};  // at the stamp
  double pose_error = 0.0;      // m: no element is farther from its exact place in the world
  double age = 0.0;             // s, from 0 on: the stamp is this long before the first waypoint
  bool is_known = true;         // as in StatedPose
};

// The motion of an object that is neither fixed nor part of a robot. Between two times its origin
// moves at constant velocity, and it rotates at constant speed about one axis, by less than a half
// turn. Before the first time and after the last one it rests.
struct ObjectMotion {
  std::string object;
  std::vector<double> times;  // s, increasing
  std::vector<Pose> world_from_object;
};

// An object that a link carries in this question, with the groups, pairs, zones, errors and load of
// an attached one. It is watched against the links of the same robot as well, but not against its
// link or `touch`.
struct Payload {
  std::string name;                 // an object of the cell that is not fixed; or a new name
  std::optional<ConvexBody> shape;  // of a new object
  std::string link;                 // an object that is a link of a robot
  Pose link_from_object;
  std::vector<std::string> touch;  // names of objects that it may touch
};

// A contact of two objects that is meant, down to a depth and until an end: as Scene::contacts.
struct MeantContact {
  std::string first, second;    // names of objects
  double depth = 0.0;           // m, above 0
  double until = kInfinity;     // s: not after this instant
  double distance = kInfinity;  // m: not after they may have been this far apart
};

// The motion of what the question states no motion for: objects that are neither fixed nor part of
// a robot, what robots stand on, and the joints of Question::joints.
enum class OthersMove : std::uint8_t {
  // Within max_speed x time since the first waypoint; joints within their limits as well.
  kWithinMaxSpeed,
  kNot,
};

// Asks for bounds of the distance over time.
struct ProfileRequest {
  // The names of a pair of objects; empty: the least distance of all pairs.
  std::string first, second;
  double tolerance = 5e-3;           // m: `upper` - `lower` of a point
  std::uint32_t most_points = 1000;  // fewer if that is enough for the tolerance
};

// A margin of the watched pairs of two objects or groups, or of the zone `a` if `b` is empty.
struct MarginBetween {
  std::string a, b;
  double margin = 0.0;  // m, from 0 on
};

// What is known of a pair before a search.
struct KnownBound {
  double lower = -kInfinity;  // m: no distance of the pair is less
  bool is_enough = false;     // the pair is not examined
};

struct Question {
  JointTrajectory motion;
  std::vector<JointTrajectory> beside;  // of other robots, which rest before and after it
  std::vector<HeldJoint> held;          // joints that stay
  // The positions of robots that do nothing for this question: `others` says how they move. Every
  // joint of the cell is in one of these. Pairs of such a robot count only if the other body has a
  // stated motion, or stays by `held`.
  std::vector<StatedJoint> joints;
  std::vector<StatedPose> poses;     // of objects that are neither fixed nor part of a robot
  std::vector<SeenFrame> seen;       // one for each sensor of the cell
  std::vector<ObjectMotion> moving;  // instead of a pose
  std::vector<Payload> payloads;     // beside what the scene has attached
  // Contacts in force at the first waypoint. While one is, its pair keeps all margins if it is no
  // deeper than allowed. Not stated: those of the scene that no time or cycle ends, as if they came
  // into force then. `lower`, `upper` and the profile count these pairs like others.
  std::optional<std::vector<MeantContact>> contacts;
  OthersMove others = OthersMove::kWithinMaxSpeed;
  // The robot may be told to stop at any instant of the motion. All bounds and margins then count
  // where it may be until it stands (monitor/ask/PLANNED_STOPS.md). No other motion may be stated.
  bool stoppable = false;
  // m, from 0 on. A margin counts for all pairs but those that a robot's own build keeps nearer in
  // every posture (monitor/pairs/kept_near.hpp).
  std::vector<double> margins = {0.0};
  std::vector<MarginBetween> margins_between;  // their answers follow those of `margins`
  // By Scene::pairs, the margin of each pair, m; -infinity: it has none. `margins` and
  // `margins_between` do not count then. Empty: not asked for.
  std::span<const double> margins_by_pair = {};
  // With `margins_by_pair`, and by pair like it: what is proven already. Empty: nothing is.
  std::span<const KnownBound> known_by_pair = {};
  double tolerance = 1e-3;  // m: `upper` - `lower` at the end
  // m: a margin is undecided if the least distance is nearer to it than this.
  double margin_tolerance = 1e-10;
  // The first instant below a margin is found to within this share of the duration.
  double instant = 1e-7;
  // m: a motion that is certainly farther away than this is not examined more closely.
  double far_enough = 1e300;
  // Only the margins are asked for. `lower` and `upper` are then as good as these needed.
  bool only_margins = false;
  // The first instant below a margin is not searched for: a verdict and any instant are enough.
  bool only_verdicts = false;
  std::optional<ProfileRequest> profile;
  bool time_scaling = false;
  double scaling_tolerance = 0.01;       // relative, of TimeScaling::factor
  std::uint64_t work_limit = 1'000'000;  // distance queries
};

// The names of those in `seen` that are not known: no bound counts what they see.
[[nodiscard]] inline std::vector<std::string> sensors_left_out(const Question& question) {
  std::vector<std::string> names;
  for (const SeenFrame& frame : question.seen)
    if (!frame.is_known) names.push_back(frame.sensor);
  return names;
}

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

// A part of the motion, from one instant to another, s. The distance is at least `lower` and at
// most `upper` at all instants of it, m. One pair may have `upper`, the other `lower`.
struct ProfilePoint {
  double from = 0.0, to = 0.0;
  double lower = 0.0, upper = 0.0;
  std::uint32_t first = 0, second = 0;  // the pair that is closest in its middle
};

// The speed that zones with `separation` admit. README.md, "Time scaling", has the assumptions.
struct TimeScaling {
  // Such a zone has a pair with a robot of the question, or the motion has to be stoppable.
  bool is_limited = false;
  // The motion may be timed faster by this, above 1, or has to be timed slower, below 1: at it and
  // at all factors below, S_p holds at all instants. 0: a zone's S_p exceeds the distance even for
  // robots that stand. Infinity: no speed of these robots is too large. With `stoppable`, stops of
  // the motion keep all margins of the question as well, and no factor above 1 is tried.
  double factor = kInfinity;
  // At a larger factor than this, S_p or a margin does not hold at the instant `time`, s.
  double factor_above = kInfinity;
  double time = 0.0;
  std::uint32_t first = 0, second = 0;  // the pair that limits it; Scene::objects
  static constexpr std::uint32_t kNoZone = ~0u;
  std::uint32_t zone = 0;  // Scene::zones; kNoZone: a margin that a stop does not keep limits it
};

// Objects are indices into Scene::objects. New objects of Question::payloads follow these, in the
// order of the question.
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
  // With Question::margins_by_pair: by Scene::pairs, a lower bound of the pair's distance, m;
  // infinity: the motion does not move the pair. `margins` has one answer, for all pairs.
  std::vector<double> lower_by_pair = {};
  // In the order of time. Each point begins where the last one ends; together they are the whole
  // motion. Empty if it was not asked for, or no pair is watched.
  std::vector<ProfilePoint> profile;
  TimeScaling scaling;            // if asked for
  bool within_work_limit = true;  // false: the bounds hold, but may be wider than asked for
  std::uint64_t queries = 0;      // distance queries
  std::uint64_t placements = 0;   // of all links
};

}  // namespace clearance
