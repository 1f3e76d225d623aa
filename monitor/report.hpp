// What comes out of a tick.
//
// One rule holds for all that is not known: a figure is NaN, a lower bound -infinity, an upper
// bound +infinity, and the status says why. An age, which is an integer, is negative then. A signed
// distance of -infinity is known: no translation separates the two.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

enum class PairStatus : std::uint8_t {
  kConverged = 0,       // evaluated this tick: bounds are rounding only
  kTouching = 1,        // evaluated: contact to within rounding
  kOverlapping = 2,     // evaluated: they share a point
  kIterationLimit = 3,  // evaluated: the bounds hold but are wider than rounding
  // Not evaluated this tick: bounds carried over by the motion bound. A pair that has not been
  // evaluated yet (evaluated_cycle 0) has its bounds from bounding spheres and NaN for the rest.
  kCarried = 4,
  kStale = 5,  // a pose is older than its limit: bounds decayed by the stated maximum speed
  // An object has never been heard of, is late without a stated maximum speed, or is contradicted:
  // all NaN, lower = -infinity, upper = +infinity.
  kUnknown = 6,
  // An object is known not to be there (Monitor::set_absent): figures and bounds as of kUnknown.
  // The pair rests on no input: it makes no zone active, and the minimum and lower_all leave it
  // out.
  kAbsent = 7,
  kCount,
};
// A word for each enumerator; "" for any other value.
[[nodiscard]] const char* name(PairStatus status) noexcept;

// One object pair. All in world coordinates, m, m/s, s, ns.
struct PairReport {
  std::uint32_t pair = 0;                // index into Scene::pairs
  std::uint32_t part_a = 0, part_b = 0;  // which parts are closest, indices into Object::parts
  PairStatus status = PairStatus::kUnknown;
  // Signed, margins not subtracted. Distance, witnesses and normal are those of `evaluated_cycle`.
  // -infinity, and so is `lower`, where no translation separates two unbounded objects.
  double distance = 0.0;
  double lower = 0.0, upper = 0.0;  // hold for the poses of this tick
  // A lower bound at every instant since the last tick, for objects that moved from the pose in use
  // then to this tick's as monitor/swept/README.md says. If the two deviate from that motion by e
  // together, the bound is lower by e; a late object may also deviate by its unobserved motion.
  // Equal to `lower` for a pair that was not known at the last tick. -infinity when unknown, or
  // after a discontinuity of 10 km.
  double swept_lower = 0.0;
  Vec3 witness_a = Vec3::Zero(), witness_b = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit, from A to B; NaN where no translation separates them
  // Positive when approaching, rotation at the witness points counted. NaN without a normal, and
  // when either velocity is not known: after a first pose without twist, or one that follows a gap
  // longer than twice the age limit, and while a pose is late. Fixed objects are at rest.
  double closing_speed = 0.0;
  // max(0, distance) / closing speed; infinity when not approaching, NaN when the closing speed is
  // not known. In contact: 0, unless the two are known to separate.
  double time_to_contact = 0.0;
  // now - stamp of the pose in use; 0 for a fixed object; -1: no pose is in use.
  std::int64_t age_a_ns = 0, age_b_ns = 0;
  std::uint64_t evaluated_cycle = 0;  // the tick in which distance and witnesses were computed
  // Ticks since its bounds were last found afresh from the poses of a tick: by an evaluation, or by
  // spheres or hulls around its objects that prove it far. 0: in this tick. Counted from the start
  // if that never happened; it goes on counting while the pair is unknown.
  std::uint64_t refresh_age_cycles = 0;
};

// Why a zone is active.
enum class ZoneCause : std::uint8_t {
  kInactive = 0,
  kNear = 1,  // by distance, or not yet proved to be farther
  // By the unobserved motion of a late object: with poses on time the pair would be outside.
  kLate = 2,
  kUnknown = 3,        // an object has no pose
  kDiscontinuous = 4,  // the motion between the last two poses of an object is not known
  kContradicted = 5,   // as kLate, but the poses of an object contradict each other or the cell
};
[[nodiscard]] const char* name(ZoneCause cause) noexcept;

struct ZoneReport {
  // Some pair's swept_lower less both margins is below the threshold, which depends on the state
  // (hysteresis). So a pair that came too near and was gone again between two ticks has entered,
  // for this tick. An unknown pair's lower bound is -infinity: it cannot be proved to be outside.
  bool active = false;
  // Every pair was proved to be outside since the last tick, or evaluated, or proved to have been
  // inside.
  bool certified = false;
  bool changed = false;  // this tick
  // The pair with the smallest (lower - margins); where all of those are outside and the zone is
  // active for what was between the ticks, the one with the smallest (swept_lower - margins).
  std::uint32_t pair = 0;
  double clearance = 0.0;         // the smallest (lower - margins), m
  double swept_clearance = 0.0;   // the smallest (swept_lower - margins), m
  std::uint64_t since_cycle = 0;  // when `active` last changed; 0: never
  ZoneCause cause = ZoneCause::kInactive;
  std::uint32_t cause_object = 0;  // of `pair`, for all causes from kLate on: index into objects
};

// What the figures of a separation rest on.
enum class SeparationValidity : std::uint8_t {
  kUnknown = 0,   // on nothing: an object or its largest speed is not known. Scaling 0
  kAssumed = 1,   // on stated largest speeds: a pose is late or a speed is not known
  kMeasured = 2,  // on poses that are on time, and a robot's speed that is known
  // An object is known not to be there: the pair has no figures and limits nothing. Scaling 1. Of a
  // zone: all its pairs are so.
  kAbsent = 3,
};
[[nodiscard]] const char* name(SeparationValidity validity) noexcept;

// A pair of a zone with `separation`, as ISO/TS 15066 has it (monitor/separation/README.md). m,
// m/s, ns. Unknown or absent: clearance and remaining -infinity, speeds and distances NaN.
struct PairSeparation {
  std::uint32_t zone = 0, pair = 0;  // indices into Scene::zones and Scene::pairs
  SeparationValidity validity = SeparationValidity::kUnknown;
  double clearance = 0.0;  // lower bound of the distance less both margins
  // Towards each other, at most; not below 0.
  double human_speed = 0.0, robot_speed = 0.0;
  // S_h, S_r and S_s, and with C, Z_d and Z_r the protective separation distance S_p.
  double human_term = 0.0, robot_term = 0.0, stopping_term = 0.0;
  double protective_distance = 0.0;
  double remaining = 0.0;  // clearance less S_p: below 0 the robot has to be stopped or slower
  // The largest speed of the robot towards the person that keeps it at 0 or above; 0: none does,
  // infinity: the speed does not matter.
  double speed_limit = 0.0;
  // The largest factor of its present speed, 0 to 1, that does so. 0 where nothing is known.
  double scaling = 0.0;
  std::int64_t age_human_ns = 0, age_robot_ns = 0;  // as PairReport::age_a_ns
};

// The least of a zone's pairs that are not absent, each figure by itself.
struct ZoneSeparation {
  std::uint32_t zone = 0;
  SeparationValidity validity = SeparationValidity::kUnknown;
  std::uint32_t pair = 0;  // that of the least scaling, of these of the least `remaining`
  double remaining = 0.0, speed_limit = 0.0, scaling = 0.0;
};

// How published pairs' distances change with joint positions, as
// monitor/gradients/gradient_rows.hpp lays them out: NaN where the pair was not evaluated in this
// tick, or a joint that moves it is not known. Both are empty unless Scene::gradients.
struct Gradients {
  std::vector<double> rates;  // m/rad or m/m, one an entry of the rows; sized once
  // One a row, m/s: the distance's rate of change if all joints stood still, by what else moves.
  // NaN where PairReport::closing_speed is.
  std::vector<double> drifts;
};

struct Report {
  std::uint64_t cycle = 0;           // counts ticks from 1
  std::int64_t now_ns = 0;           // the time of the tick (TickTime)
  std::int64_t clock_offset_ns = 0;  // what CLOCK_REALTIME was ahead of it: TickTime
  // Stamps of the moving objects' poses in use; 0: none.
  std::int64_t newest_pose_ns = 0, oldest_pose_ns = 0;
  std::uint64_t scene_revision = 0;
  // The pair with the smallest upper bound, of all that are known and have ever been evaluated.
  // While it is stale it is no minimum of anything: its distance is that of an old pose,
  // and another stale pair may have the least lower bound. `lower_all` bounds all pairs always.
  PairReport minimum;
  bool minimum_known = false;  // false: there is no such pair
  // No other pair can be closer (two pairs evaluated this tick: by more than their rounding), and
  // no pair is unknown or stale. Absent pairs do not count.
  bool minimum_certified = false;
  double lower_all = 0.0;        // the true distance of every pair that is not absent, at least
  double swept_lower_all = 0.0;  // the same at every instant since the last tick: see swept_lower
  // Object pairs; each is in one of the last four counts, or absent.
  std::uint32_t pairs_total = 0, evaluated = 0, carried = 0, stale = 0, unknown = 0;
  std::uint32_t queries = 0;  // distance queries (part pairs) this tick
  // The largest PairReport::refresh_age_cycles of all known pairs, published or not.
  std::uint64_t oldest_evaluation_cycles = 0;
  std::vector<PairReport> pairs;  // those with ObjectPair::publish, in scene order; sized once
  std::vector<ZoneReport> zones;  // one a zone, in scene order; sized once
  // The zones with `separation`, in scene order, and their pairs, zone by zone; sized once.
  std::vector<ZoneSeparation> separated_zones;
  std::vector<PairSeparation> separated_pairs;
  Gradients gradients;
  std::array<std::uint64_t, kRejects> rejected{};  // totals since the start
};

// How many pairs have the status kAbsent, in a report or a message of it: those that the four
// counts leave.
template <class Counts>
[[nodiscard]] std::uint32_t absent_pairs(const Counts& counts) noexcept {
  return counts.pairs_total - counts.evaluated - counts.carried - counts.stale - counts.unknown;
}

}  // namespace clearance
