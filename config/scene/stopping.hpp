// How a robot comes to a standstill once it has been told to stop, as its maker prints it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace clearance {

// What a joint needs from a speed: the distance until it stands, rad or m, and the time, s.
struct StopPoint {
  double speed = 0.0;  // rad/s or m/s
  double distance = 0.0, time = 0.0;
};

// The stop of one joint. Neither its distance nor its time falls as the speed rises, and neither is
// below a printed one of the same or a lower speed: tables are not monotone.
class JointStop {
 public:
  // Between printed speeds, a distance is at most that of the next one, and at most the speed times
  // the longer of both quotients distance/speed. Below the first one, it is the speed times that
  // one's quotient: a slower joint is assumed to need no longer. A time is that of the next printed
  // speed. Above the last one, distances grow with the square of the speed and times in proportion.
  // `points`: at least one, with speeds above 0; several may have one speed.
  [[nodiscard]] static JointStop by_table(std::vector<StopPoint> points);
  // A constant deceleration, rad/s2 or m/s2, above 0.
  [[nodiscard]] static JointStop by_deceleration(double deceleration);
  // The joint stands after this time, s, and goes on until then as fast as at first.
  [[nodiscard]] static JointStop by_time(double time);

  // The largest distance(s) / s of all speeds s up to this one, s.
  [[nodiscard]] double longest(double speed) const noexcept;
  // From a speed of at least 0, per second.
  [[nodiscard]] double distance(double speed) const noexcept;
  [[nodiscard]] double time(double speed) const noexcept;
  // The envelope of a table; empty: there is none.
  [[nodiscard]] const std::vector<StopPoint>& points() const noexcept { return points_; }

 private:
  std::vector<StopPoint> points_;  // speeds ascend; distances and times do not fall
  double deceleration_ = 0.0, time_ = 0.0;
};

// IEC 60204-1: category 0 takes the power away, 1 brakes and then takes it away, 2 keeps it.
inline constexpr int kStopCategories = 3;

// The stops that a table prints up to a load and an extension, which are shares of the largest
// ones. A step is no better than any lower one.
struct StopStep {
  double load = 1.0, extension = 1.0;
  std::vector<JointStop> joints;  // as RobotStops::joints
};

// The extension of an arm: the distance of a link's origin from the axis of a joint, m.
struct Extension {
  std::uint32_t joint = 0, link = 0;  // indices into the robot's; the joint turns, below the link
  double reach = 0.0;                 // m: the maker's 100 %; 0: the worst extension counts
  // By joint of the robot: the distance changes by no more per rad, or per m of one that slides.
  std::vector<double> levers;
};

// The load of an arm by the masses of what is attached to it, kg.
struct CarriedLoad {
  double full = 0.0;  // the maker's 100 %; 0: the cell states the load, or the worst one counts
  double tool = 0.0;  // what the arm always carries
  // The mass that it carries with the tool, or infinity if not all is stated. `step`: the step of
  // the table that has it, as a share of `full`.
  double mass = 0.0, step = 0.0;
  std::vector<StopStep> steps;  // of all loads, ascending; empty: masses choose none
};

struct RobotStops {
  int category = 1;
  double reaction = 0.0;    // s: from a report until the brakes act
  bool keeps_path = false;  // joints slow down in proportion; else each brakes by itself
  // By joint of the robot, in the unit of its variable: a joint that mimics another has that one's.
  // Joints that do not move, and the floating joint of a base on tf, have no stop. Empty: nothing
  // is stated.
  std::vector<JointStop> joints;
  // The steps of the extension, ascending, whose last one is `joints`. Empty: it is not measured.
  std::vector<StopStep> steps;
  Extension extension;
  CarriedLoad load;
  // The topic of ROS 2 that says whether the brakes act; empty: none, or `stopping` of our own
  // joint states.
  std::string stated_on;
  // By joint, rad/s2 or m/s2: until the brakes act, and while the path is kept, the velocity
  // changes by no more than this per second. Infinity: not stated.
  std::vector<double> max_accelerations;

  [[nodiscard]] bool is_stated() const noexcept { return !joints.empty(); }
};

}  // namespace clearance
