// What comes out of a tick.
//
// One rule for what is not known: a figure is NaN, a lower bound -infinity, an upper bound
// +infinity, and the status says why. An age, which is an integer, is negative then. A signed
// distance of -infinity is known: no translation parts the two.
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
  // An object has never been seen, is late without a stated maximum speed, or is contradicted: all
  // NaN, lower = -infinity, upper = +infinity.
  kUnknown = 6,
};
[[nodiscard]] const char* name(PairStatus status) noexcept;

// One object pair. All in world coordinates, m, m/s, s, ns.
struct PairReport {
  std::uint32_t pair = 0;                // index into Scene::pairs
  std::uint32_t part_a = 0, part_b = 0;  // which parts are closest, indices into Object::parts
  PairStatus status = PairStatus::kUnknown;
  // Signed, margins not subtracted. Distance, witnesses and normal are those of `evaluated_cycle`.
  // -infinity, and so is `lower`, where no translation parts two objects without end.
  double distance = 0.0;
  double lower = 0.0, upper = 0.0;  // hold for the poses of this tick
  // Holds at every instant since the last tick, for objects that went from the pose in use then to
  // this one's straight and evenly, turning evenly about one axis, the shorter way (README.md,
  // "Between two ticks"); less e for objects that displaced from that way by e, both together. A
  // late object is also off it by what it may have moved unseen. Of a pair that was not known at
  // the last tick: as `lower`. -infinity when unknown, or after a discontinuity of 10 km.
  double swept_lower = 0.0;
  Vec3 witness_a = Vec3::Zero(), witness_b = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit, from A to B; NaN where no translation parts them
  // Positive when approaching, rotation at the witness points counted. NaN without a normal, and
  // when either velocity is not known: after a first pose without twist, or one that follows a gap
  // longer than twice the age limit, and while a pose is late. Fixed objects are at rest.
  double closing_speed = 0.0;
  // max(0, distance) / closing speed; infinity when not approaching, NaN when the closing speed is
  // not known. In contact: 0, unless known to be parting.
  double time_to_contact = 0.0;
  // now - stamp of the pose in use; 0 for a fixed object; -1: never seen.
  std::int64_t age_a_ns = 0, age_b_ns = 0;
  std::uint64_t evaluated_cycle = 0;  // the tick in which distance and witnesses were computed
  // Ticks since its bounds were last found afresh from the poses of a tick: by an evaluation, or by
  // spheres or hulls around its objects where these prove it out of question. 0: in this one.
  // Counted from the start where that never was; also while it is unknown.
  std::uint64_t refresh_age_cycles = 0;
};

// Why a zone is active.
enum class ZoneCause : std::uint8_t {
  kInactive = 0,
  kNear = 1,     // by distance, or not yet proved to be farther
  kLate = 2,     // what a late object may have moved unseen: on time, the pair would be outside
  kUnknown = 3,  // an object was never seen
  kDiscontinuous = 4,  // what was between the last two poses of an object is not known
  kContradicted = 5,   // as kLate, since the poses of an object contradict each other or the cell
};

struct ZoneReport {
  // Some pair's swept_lower less both margins is, or has been within the hysteresis, too small: so
  // what came too near and was gone again between two ticks has entered, for this tick. An unknown
  // pair's lower bound is -infinity: it cannot be proved to be outside.
  bool active = false;
  // Every pair was proved outside since the last tick, or evaluated, or proved to have been inside.
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
  kUnknown = 0,   // nothing: an object or its largest speed is not known. Scaling 0
  kAssumed = 1,   // a pose is late or a speed not known: stated largest speeds stand for them
  kMeasured = 2,  // poses that are on time, and a robot's speed that is known
};

// A pair of a zone with `separation`, as ISO/TS 15066 has it (monitor/separation/README.md). m,
// m/s, ns. Unknown: clearance and remaining -infinity, speeds and distances NaN.
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
  // The largest share of its present speed, 0 to 1, that does. 0 where nothing is known.
  double scaling = 0.0;
  std::int64_t age_human_ns = 0, age_robot_ns = 0;  // as PairReport::age_a_ns
};

// The least of a zone's pairs, each by itself.
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
  std::int64_t now_ns = 0;           // the time the tick was told
  std::int64_t clock_offset_ns = 0;  // what CLOCK_REALTIME was ahead of it: TickTime
  // Stamps of the moving objects' poses in use; 0: none.
  std::int64_t newest_pose_ns = 0, oldest_pose_ns = 0;
  std::uint64_t scene_revision = 0;
  // The pair with the smallest upper bound, of all that are not kUnknown and have ever been
  // evaluated. While it is stale it is no minimum of anything: its distance is that of an old pose,
  // and another stale pair may have the least lower bound. `lower_all` bounds all pairs always.
  PairReport minimum;
  bool minimum_known = false;  // false: there is no such pair
  // No other pair can be closer (two pairs evaluated this tick: by more than their rounding), and
  // no pair is unknown or stale.
  bool minimum_certified = false;
  double lower_all = 0.0;        // every pair's true distance is at least this
  double swept_lower_all = 0.0;  // and this at every instant since the last tick: see swept_lower
  // Object pairs; each is one of the last four.
  std::uint32_t pairs_total = 0, evaluated = 0, carried = 0, stale = 0, unknown = 0;
  std::uint32_t queries = 0;  // distance queries (part pairs) this tick
  // The largest PairReport::refresh_age_cycles of all known pairs, published or not.
  std::uint64_t oldest_evaluation_cycles = 0;
  std::vector<PairReport> pairs;  // those with ObjectPair::publish, in scene order; sized once
  std::vector<ZoneReport> zones;  // one a zone, in scene order; sized once
  // Of zones with `separation`, in scene order, and of their pairs, zone by zone; sized once.
  std::vector<ZoneSeparation> separated_zones;
  std::vector<PairSeparation> separated_pairs;
  Gradients gradients;
  std::array<std::uint64_t, kRejects> rejected{};  // totals since the start
};

}  // namespace clearance
