#include "monitor/zones/protective_distance.hpp"

#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

// S_p = c0 + c1 v + c2 v^2 for a speed v, in exact numbers. None is negative.
struct Quadratic {
  double c0, c1, c2;
};

// The time, s, and the distance, m, that stopping takes from the speed v at which braking begins:
// constants, plus `time` v and `distance` v^2.
struct Stopping {
  double constant_time = 0.0, constant_distance = 0.0;
  double time = 0.0, distance = 0.0;
};

Stopping stopping(const Separation& terms) noexcept {
  const double time = seconds(terms.stopping_time_ns);
  const double speed = terms.stopping_speed;
  if (speed == 0.0) {
    return {.constant_time = time, .constant_distance = terms.stopping_distance};
  }
  return {.time = time / speed, .distance = terms.stopping_distance / (speed * speed)};
}

// T_r, s.
double reaction_time(const Separation& terms, const Approach& approach) noexcept {
  const double stated = seconds(terms.reaction_time_ns);
  return approach.report_delay > 0.0 ? rounded_up(stated + approach.report_delay) : stated;
}

// `human_age` and `counted`, m: the person's path begins this long ago, and this much of it is left
// out.
Quadratic quadratic(const Separation& terms, const Approach& approach, double human_age,
                    double counted) noexcept {
  const Stopping s = stopping(terms);
  const double reaction = reaction_time(terms, approach);
  const double gained = terms.robot_acceleration * reaction;
  // The time until the robot stands: t0 + t1 v.
  const double t0 = human_age + reaction + s.constant_time + s.time * gained;
  const double t1 = s.time;
  const double half = 0.5 * approach.human_acceleration;
  const double human0 = (approach.human_speed + half * t0) * t0 - counted;
  const double human1 = (approach.human_speed + 2.0 * half * t0) * t1;
  const double robot0 =
      std::fmax(0.0, approach.robot_speed * approach.robot_age - approach.robot_counted) +
      gained * reaction;
  const double stopping0 = s.constant_distance + s.distance * gained * gained;
  const double others =
      terms.intrusion_distance + terms.human_uncertainty + terms.robot_uncertainty;
  return {.c0 = human0 + robot0 + stopping0 + others,
          .c1 = human1 + reaction + 2.0 * s.distance * gained,
          .c2 = half * t1 * t1 + s.distance};
}

// In the form without cancellation. At least one of c1 and c2 is not 0.
double root(const Quadratic& q, double distance) noexcept {
  const double left = std::fmax(distance - q.c0, 0.0);
  return 2.0 * left / (q.c1 + std::sqrt(q.c1 * q.c1 + 4.0 * q.c2 * left));
}

// The person's path in this time, m.
double path(const Approach& approach, double time) noexcept {
  return (approach.human_speed + 0.5 * approach.human_acceleration * time) * time;
}

}  // namespace

// Only sums, products and rounding outward of figures that are not negative. Each of them is
// monotonic, so S_p is never smaller for a larger speed.
ProtectiveDistance protective_distance(const Separation& terms, const Approach& approach,
                                       double speed) noexcept {
  const Stopping s = stopping(terms);
  const double reaction = reaction_time(terms, approach);
  const double braked_from = rounded_up(speed + terms.robot_acceleration * reaction);
  const double since_pose =
      rounded_up(approach.human_age + reaction + s.constant_time + swept(braked_from, s.time));
  ProtectiveDistance found;
  found.human = rounded_up(path(approach, since_pose));
  if (approach.human_counted > 0.0) {
    const double from_now = rounded_up(reaction + s.constant_time + swept(braked_from, s.time));
    found.human =
        rounded_up(std::fmax(path(approach, from_now), found.human - approach.human_counted));
  }
  double before_tick = approach.robot_speed * approach.robot_age;
  if (approach.robot_counted > 0.0)
    before_tick = std::fmax(0.0, rounded_up(before_tick) - approach.robot_counted);
  found.robot = rounded_up(before_tick + braked_from * reaction);
  found.stopping =
      rounded_up(s.constant_distance + swept(braked_from, swept(braked_from, s.distance)));
  found.sum = rounded_up(found.human + found.robot + found.stopping + terms.intrusion_distance +
                         terms.human_uncertainty + terms.robot_uncertainty);
  return found;
}

// The root of c0 + c1 v + c2 v^2 = distance, for the longer of the person's two paths. It is then
// lowered, by its excess and more, until the rounded S_p is within the distance.
double largest_speed(const Separation& terms, const Approach& approach, double distance) noexcept {
  constexpr int kMostSteps = 8;
  constexpr double kMore = 1.0 + 0x1p-40;
  if (!(protective_distance(terms, approach, 0.0).sum <= distance)) return 0.0;
  const Quadratic q = quadratic(terms, approach, approach.human_age, approach.human_counted);
  if (q.c1 == 0.0 && q.c2 == 0.0) return kInfinity;
  double speed = root(q, distance);
  if (approach.human_counted > 0.0)
    speed = std::fmin(speed, root(quadratic(terms, approach, 0.0, 0.0), distance));
  double step = 0x1p-50 * speed;
  for (int i = 0; i < kMostSteps && speed > 0.0; ++i) {
    const double over = protective_distance(terms, approach, speed).sum - distance;
    if (over <= 0.0) return speed;
    step = std::fmax(2.0 * step, kMore * over / (q.c1 + 2.0 * q.c2 * speed));
    speed -= step;
  }
  return 0.0;
}

}  // namespace clearance
