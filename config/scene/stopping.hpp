// How a robot comes to a standstill once it has been told to stop, as its maker prints it.
#pragma once

#include <cstdint>
#include <vector>

namespace clearance {

// What a joint needs from a speed: the distance until it stands, rad or m, and the time, s.
struct StopPoint {
  double speed = 0.0;  // rad/s or m/s
  double distance = 0.0, time = 0.0;
};

// The stop of one joint. No distance or time that it gives is below a printed one of the same or a
// lower speed: tables are not monotone.
class JointStop {
 public:
  // Between printed speeds, a distance is at most that of the next one, and at most the speed times
  // the longer of both quotients distance/speed. A time is that of the next one. Above the last
  // printed speed, distances grow with the square of the speed and times in proportion. `points`:
  // at least one; with speeds above 0.
  [[nodiscard]] static JointStop by_table(std::vector<StopPoint> points);
  // A constant deceleration, rad/s2 or m/s2, above 0.
  [[nodiscard]] static JointStop by_deceleration(double deceleration);
  // The joint stands after this time, s, and goes on until then as fast as at first.
  [[nodiscard]] static JointStop by_time(double time);

  // The largest distance(s) / s of all speeds s up to this one, s.
  [[nodiscard]] double longest(double speed) const noexcept;
  // From a speed of at least 0.
  [[nodiscard]] double distance(double speed) const noexcept;
  [[nodiscard]] double time(double speed) const noexcept;
  [[nodiscard]] const std::vector<StopPoint>& points() const noexcept { return points_; }

 private:
  std::vector<StopPoint> points_;  // speeds ascending; distances and times do not fall
  double deceleration_ = 0.0, time_ = 0.0;
};

// IEC 60204-1: category 0 takes the power away, 1 brakes and then takes it away, 2 keeps it.
inline constexpr int kStopCategories = 3;

struct RobotStops {
  int category = 1;
  double reaction = 0.0;    // s: from a report until the brakes act
  bool keeps_path = false;  // joints slow down in proportion; else each brakes by itself
  // By joint of the robot; of those that do not move, nothing. Empty: nothing is stated.
  std::vector<JointStop> joints;
  // By joint of the robot: until the brakes act, its velocity changes by no more than this times
  // the time, rad/s2 or m/s2. Infinity, or empty: it keeps its velocity.
  std::vector<double> accelerations;

  [[nodiscard]] bool is_stated() const noexcept { return !joints.empty(); }
};

}  // namespace clearance
