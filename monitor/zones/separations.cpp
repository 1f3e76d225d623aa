#include "monitor/zones/separations.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/pairs/pair_table.hpp"
#include "monitor/zones/closing.hpp"
#include "monitor/zones/protective_distance.hpp"

namespace clearance {
namespace {

double age_of(std::int64_t age_ns) noexcept { return rounded_up(seconds(age_ns)); }

// Returns the unobserved motion of a late object, m: the lower bounds of its pairs are already
// reduced by it.
double counted_in_bounds(const TrackedObject& object) noexcept {
  return object.input.late ? object.may_have_moved : 0.0;
}

PairSeparation unknown_separation(std::uint32_t zone, std::uint32_t pair) noexcept {
  PairSeparation unknown{.zone = zone, .pair = pair};
  unknown.clearance = unknown.remaining = -kInfinity;
  unknown.human_speed = unknown.robot_speed = kNan;
  unknown.human_term = unknown.robot_term = unknown.stopping_term = kNan;
  unknown.protective_distance = kNan;
  return unknown;
}

// The direction from the robot to the person, if it was found in this tick; else NaN.
Vec3 towards_human(const PairReport& pair, bool human_is_first, std::uint64_t cycle) noexcept {
  if (pair.evaluated_cycle != cycle) return Vec3::Constant(kNan);
  return human_is_first ? Vec3(-pair.normal) : pair.normal;
}

// The largest factor that brings the robot's present speed to the limit or below.
double scaling_of(double robot_speed, double speed_limit, double remaining_when_standing) noexcept {
  if (!(remaining_when_standing >= 0.0)) return 0.0;
  if (robot_speed <= speed_limit) return 1.0;
  return rounded_down(speed_limit / robot_speed);
}

// The result for one assumption about the person's motion.
struct Finding {
  Approach approach;
  ProtectiveDistance distance;  // at the robot's present speed
  double standing;              // S_p of a robot that stands, m
  double speed_limit;
};

Finding find(const Separation& terms, const Approach& approach, double clearance) noexcept {
  return {.approach = approach,
          .distance = protective_distance(terms, approach, approach.robot_speed),
          .standing = protective_distance(terms, approach, 0.0).sum,
          .speed_limit = largest_speed(terms, approach, clearance)};
}

// The worse of each figure. The terms are those of the larger sum.
Finding worse_of(const Finding& a, const Finding& b) noexcept {
  Finding worse = a.distance.sum >= b.distance.sum ? a : b;
  worse.approach.human_speed = std::max(a.approach.human_speed, b.approach.human_speed);
  worse.standing = std::max(a.standing, b.standing);
  worse.speed_limit = std::min(a.speed_limit, b.speed_limit);
  return worse;
}

// Takes the least of each figure.
void count_in(const PairSeparation& pair, ZoneSeparation& zone) noexcept {
  const bool is_least = pair.scaling < zone.scaling ||
                        (pair.scaling == zone.scaling && pair.remaining < zone.remaining);
  if (is_least) zone.pair = pair.pair;
  zone.validity = std::min(zone.validity, pair.validity);
  zone.remaining = std::min(zone.remaining, pair.remaining);
  zone.speed_limit = std::min(zone.speed_limit, pair.speed_limit);
  zone.scaling = std::min(zone.scaling, pair.scaling);
}

}  // namespace

Separations::Separations(const Scene& scene, const ZoneLevels& levels) : scene_(scene) {
  std::vector<std::uint32_t> place(scene.pairs.size(), 0);
  std::uint32_t published = 0;
  for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
    place[p] = published;
    published += scene.pairs[p].publish;
  }
  for (std::uint32_t z = 0; z < scene.zones.size(); ++z) {
    const Zone& zone = scene.zones[z];
    if (!zone.separation) continue;
    const std::size_t first = members_.size();
    for (std::size_t i = 0; i < zone.pairs.size(); ++i) {
      const std::uint32_t pair = zone.pairs[i];
      const bool human_is_first = zone.separation->human_is_first[i] != 0;
      const ObjectPair& objects = scene.pairs[pair];
      const auto in_zone =
          std::ranges::find(levels.zones_of(pair), z, &ZoneLevels::Membership::zone);
      members_.push_back({.pair = pair,
                          .published = place[pair],
                          .human = human_is_first ? objects.first : objects.second,
                          .robot = human_is_first ? objects.second : objects.first,
                          .human_is_first = human_is_first,
                          .margins = in_zone->margins});
    }
    zones_.push_back({z, first, members_.size()});
  }
}

void Separations::prepare(Report& report) const {
  for (const SeparatedZone& zone : zones_) {
    report.separated_zones.push_back({.zone = zone.zone, .pair = members_[zone.first_member].pair});
    for (std::size_t m = zone.first_member; m < zone.end_member; ++m)
      report.separated_pairs.push_back(unknown_separation(zone.zone, members_[m].pair));
  }
}

void Separations::write(std::span<const TrackedObject> objects, std::uint64_t cycle,
                        std::int64_t report_delay_ns, Report& report) const noexcept {
  for (std::size_t z = 0; z < zones_.size(); ++z) {
    const SeparatedZone& zone = zones_[z];
    ZoneSeparation least{.zone = zone.zone,
                         .validity = SeparationValidity::kAbsent,
                         .pair = members_[zone.first_member].pair,
                         .remaining = kInfinity,
                         .speed_limit = kInfinity,
                         .scaling = 1.0};
    for (std::size_t m = zone.first_member; m < zone.end_member; ++m) {
      const Member& member = members_[m];
      PairSeparation& pair = report.separated_pairs[m];
      write_pair(zone, member, report.pairs[member.published], objects, cycle, report_delay_ns,
                 pair);
      if (pair.validity != SeparationValidity::kAbsent) count_in(pair, least);
    }
    report.separated_zones[z] = least;
  }
}

// Measured speeds count; a speed that is not known counts as the largest that is stated. While a
// pose is late, its last measured speed counts as well: a larger age never allows more.
void Separations::write_pair(const SeparatedZone& zone, const Member& member,
                             const PairReport& pair, std::span<const TrackedObject> objects,
                             std::uint64_t cycle, std::int64_t report_delay_ns,
                             PairSeparation& out) const noexcept {
  const Separation& terms = *scene_.zones[zone.zone].separation;
  const TrackedObject &human = objects[member.human], &robot = objects[member.robot];
  out = unknown_separation(zone.zone, member.pair);
  out.age_human_ns = member.human_is_first ? pair.age_a_ns : pair.age_b_ns;
  out.age_robot_ns = member.human_is_first ? pair.age_b_ns : pair.age_a_ns;

  if (human.absent || robot.absent) {
    out.validity = SeparationValidity::kAbsent;
    out.speed_limit = kInfinity;
    out.scaling = 1.0;
    return;
  }
  const double robot_limit = scene_.objects[member.robot].max_speed;
  const double robot_assumed = std::min(terms.robot_speed, robot_limit);
  const bool robot_known = robot.velocity_known();
  if (pair.status == PairStatus::kUnknown || !(pair.lower > -kInfinity) ||
      (!robot_known && !(robot_assumed < kInfinity)) ||
      (terms.reaction_is_measured && report_delay_ns < 0)) {
    return;
  }
  const Vec3 towards = towards_human(pair, member.human_is_first, cycle);
  const Vec3& on_human = member.human_is_first ? pair.witness_a : pair.witness_b;
  const Vec3& on_robot = member.human_is_first ? pair.witness_b : pair.witness_a;
  const double robot_measured =
      robot.twist_known ? speed_towards(robot, towards, on_robot, robot_limit) : 0.0;
  const Approach assumed{
      .human_speed = terms.human_speed.value_or(scene_.objects[member.human].approach_speed),
      .robot_speed = robot_known ? robot_measured : std::max(robot_assumed, robot_measured),
      .human_age = age_of(out.age_human_ns),
      .robot_age = age_of(out.age_robot_ns),
      .report_delay = terms.reaction_is_measured ? age_of(report_delay_ns) : 0.0,
      .human_counted = counted_in_bounds(human),
      .robot_counted = counted_in_bounds(robot)};
  out.clearance = member.margins > 0.0 ? rounded_down(pair.lower - member.margins) : pair.lower;

  const bool human_known = !terms.human_speed_is_measured || human.velocity_known();
  Finding found;
  if (terms.human_speed_is_measured && human.twist_known) {
    Approach measured = assumed;
    measured.human_speed =
        speed_towards(human, -towards, on_human, scene_.objects[member.human].max_speed);
    measured.human_acceleration = terms.human_acceleration;
    found = find(terms, measured, out.clearance);
    if (!human_known) found = worse_of(found, find(terms, assumed, out.clearance));
  } else {
    found = find(terms, assumed, out.clearance);
  }

  const bool on_time = !human.input.late && !robot.input.late && human_known && robot_known;
  out.validity = on_time ? SeparationValidity::kMeasured : SeparationValidity::kAssumed;
  out.human_speed = found.approach.human_speed;
  out.robot_speed = found.approach.robot_speed;
  out.human_term = found.distance.human;
  out.robot_term = found.distance.robot;
  out.stopping_term = found.distance.stopping;
  out.protective_distance = found.distance.sum;
  out.remaining = rounded_down(out.clearance - found.distance.sum);
  out.speed_limit = found.speed_limit;
  out.scaling = scaling_of(out.robot_speed, out.speed_limit, out.clearance - found.standing);
}

}  // namespace clearance
