// The results of a tick.
//
// One rule holds for everything that is not known: a value is NaN, a lower bound is -infinity, and
// an upper bound is +infinity. The status says why. An unknown age, which is an integer, is
// negative. A signed distance of -infinity is known: no translation separates the two objects.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/convex_body.hpp"
#include "core/vec.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

enum class PairStatus : std::uint8_t {
  kConverged = 0,       // evaluated this tick: the bounds include only rounding
  kTouching = 1,        // evaluated: in contact, to within rounding
  kOverlapping = 2,     // evaluated: the objects share a point
  kIterationLimit = 3,  // evaluated: the bounds hold but are wider than rounding
  // The pair was not evaluated this tick: the motion bound carries the bounds over. A pair that has
  // never been evaluated (evaluated_cycle 0) has bounds from bounding spheres, and NaN for the
  // rest.
  kCarried = 4,
  kStale = 5,  // a pose is older than its limit: the stated maximum speed widens the bounds
  // An object was never heard of, is late without a stated maximum speed, or is contradicted. All
  // values are NaN, lower = -infinity, upper = +infinity.
  kUnknown = 6,
  // An object is known not to be there (Monitor::set_absent). Values and bounds are those of
  // kUnknown. The pair depends on no input: it makes no zone active, and the minimum and lower_all
  // leave it out.
  kAbsent = 7,
};
// A word for each enumerator, and "" for any other value.
[[nodiscard]] const char* name(PairStatus status) noexcept;

// One object pair, in world coordinates, m, m/s, s, ns.
struct PairReport {
  std::uint32_t pair = 0;                // index into Scene::pairs
  std::uint32_t part_a = 0, part_b = 0;  // the closest parts, indices into Object::parts
  PairStatus status = PairStatus::kUnknown;
  // Signed distance without subtracting margins. Distance, witness points and normal belong to
  // `evaluated_cycle`. It is -infinity, and so is `lower`, if no translation separates two
  // unbounded objects.
  double distance = 0.0;
  double lower = 0.0, upper = 0.0;  // bounds for the poses of this tick
  // A lower bound of the distance at every instant since the last tick. It assumes that each object
  // moved from its former pose in use to its present one as monitor/schedule/SWEPT.md says. If the
  // two objects together deviate from that motion by e, the bound is lower by e. A late object may
  // also deviate by its unobserved motion. The bound equals `lower` for a pair that was not known
  // at the last tick, and for one with a new frame of a sensor. It is -infinity for an unknown
  // pair, and after a discontinuity of 10 km.
  double swept_lower = 0.0;
  // m: by which `lower` is below the bound for the model as stated, because of the errors that the
  // cell states (config/KEYS.md). `distance`, witnesses and normal are those of the model. NaN if
  // the pair is unknown.
  double model_error = 0.0;
  // m: a lower bound of the distance until all robots stand that are told to stop now and move one
  // of the two (RobotStop), rounded to no worse than 0. -infinity if that is not known; NaN if no
  // joint that stops moves one of the two.
  double stop_lower = std::numeric_limits<double>::quiet_NaN();
  // The closest points, world. Of objects that overlap: the point of each that lies deepest in the
  // other along the normal, as in DistanceResult. Points and normal are NaN if an image has no
  // element left.
  Vec3 witness_a = Vec3::Zero(), witness_b = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit, from A to B; NaN if no translation separates them
  // Positive when approaching; includes the rotation at the witness points. It is NaN without a
  // normal, and if either velocity is not known. A velocity is not known while a pose is late.
  // Without a twist, it is also not known after a first pose, or after a gap longer than twice the
  // age limit. Fixed objects are at rest.
  double closing_speed = 0.0;
  // max(0, distance) / closing speed. It is infinity when not approaching, and NaN if the closing
  // speed is not known. In contact it is 0, unless the two are known to separate.
  double time_to_contact = 0.0;
  // now - stamp of the pose in use; 0 for a fixed object; -1: no pose is in use.
  std::int64_t age_a_ns = 0, age_b_ns = 0;
  std::uint64_t evaluated_cycle = 0;  // the tick in which distance and witnesses were computed
  // Ticks since the bounds were last computed from the poses of a tick. Either an evaluation
  // computed them, or spheres or hulls around the objects proved the pair far. It is 0 if this
  // happened in this tick. If it never happened, the count begins with the first tick. It continues
  // while the pair is unknown.
  std::uint64_t refresh_age_cycles = 0;
};

// The reason why a zone is active.
enum class ZoneCause : std::uint8_t {
  kInactive = 0,
  kNear = 1,  // by distance, or not yet proved to be farther away
  // An object is late and may have moved unobserved. If its poses were on time, the pair would be
  // outside.
  kLate = 2,
  kUnknown = 3,         // an object has no pose
  kDiscontinuous = 4,   // the motion between the last two poses of an object is not known
  kContradicted = 5,    // like kLate, but an object's poses contradict each other or the cell
  kContactTooDeep = 6,  // the pair has an allowed contact, and may be deeper than that allows
  kContactTooLate = 7,  // the pair may touch after its allowed contact has ended
  kNoShare = 8,         // a share of the cell with pairs of the zone is not heard; no tick gives it
};
[[nodiscard]] const char* name(ZoneCause cause) noexcept;

struct ZoneReport {
  // Pairs whose ContactReport has the status kAllowed do not count here: they make no zone active,
  // and are in none of these figures.
  //
  // True if swept_lower less both margins is below the threshold for some pair. The threshold
  // depends on the state (hysteresis). A pair that came too near and went away again between two
  // ticks has therefore entered, for this tick. An unknown pair has the lower bound -infinity, so
  // it cannot be proved to be outside.
  bool active = false;
  // Every pair was proved to be outside since the last tick, was evaluated, or was proved to have
  // been inside.
  bool certified = false;
  bool changed = false;  // `active` changed in this tick
  // The pair with the smallest (lower - margins). A zone may be active only because of the time
  // between the ticks, while all pairs are outside now. Then it is the pair with the smallest
  // (swept_lower - margins).
  std::uint32_t pair = 0;
  double clearance = 0.0;         // the smallest (lower - margins), m
  double swept_clearance = 0.0;   // the smallest (swept_lower - margins), m
  std::uint64_t since_cycle = 0;  // the tick in which `active` last changed; 0: never
  ZoneCause cause = ZoneCause::kInactive;
  std::uint32_t cause_object = 0;  // from kLate on: the object of `pair`, index into Scene::objects
};

// The kind of data on which a separation depends.
enum class SeparationValidity : std::uint8_t {
  kUnknown = 0,   // none: an object or its largest speed is not known. Scaling 0
  kAssumed = 1,   // stated largest speeds: a pose is late or a speed is not known
  kMeasured = 2,  // poses that are on time, and a known speed of the robot
  // An object is known not to be there: the pair has no values and limits nothing. Scaling 1. For a
  // zone, this holds for all its pairs.
  kAbsent = 3,
};
[[nodiscard]] const char* name(SeparationValidity validity) noexcept;

// A pair of a zone with `separation`, after ISO/TS 15066 (monitor/zones/README.md), in m, m/s,
// ns. If unknown or absent, clearance and remaining are -infinity, speeds and distances NaN.
struct PairSeparation {
  std::uint32_t zone = 0, pair = 0;  // indices into Scene::zones and Scene::pairs
  SeparationValidity validity = SeparationValidity::kUnknown;
  double clearance = 0.0;  // lower bound of the distance less both margins
  // The largest speeds towards each other, not below 0.
  double human_speed = 0.0, robot_speed = 0.0;
  // The terms S_h, S_r and S_s. With C, Z_d and Z_r they give the protective separation distance
  // S_p.
  double human_term = 0.0, robot_term = 0.0, stopping_term = 0.0;
  double protective_distance = 0.0;
  double remaining = 0.0;  // clearance less S_p: below 0 the robot must stop or slow down
  // The largest speed of the robot towards the person that keeps `remaining` at 0 or above. It is 0
  // if no speed does, and infinity if the speed does not matter.
  double speed_limit = 0.0;
  // The largest factor, 0 to 1, by which the robot may scale its present speed so that `remaining`
  // stays at 0 or above. It is 0 if nothing is known.
  double scaling = 0.0;
  std::int64_t age_human_ns = 0, age_robot_ns = 0;  // like PairReport::age_a_ns
};

// The minimum of each value over the zone's pairs that are not absent.
struct ZoneSeparation {
  std::uint32_t zone = 0;
  SeparationValidity validity = SeparationValidity::kUnknown;
  std::uint32_t pair = 0;  // the pair with the least scaling, then the least `remaining`
  double remaining = 0.0, speed_limit = 0.0, scaling = 0.0;
};

// A robot that states how it stops: from the present positions and velocities of its joints until
// it stands (monitor/ask/STOPS.md).
struct RobotStop {
  std::uint32_t robot = 0;  // index into Scene::robots
  // kMeasured: all velocities are known. kAssumed: limits stand in for some. kUnknown: an input
  // that a pair of the robot depends on is not known, or the robot is late; `scaling` is 0.
  // kAbsent: all of its links are; it limits nothing.
  SeparationValidity validity = SeparationValidity::kUnknown;
  // The largest share of its present speed, 0 to 1, from which it stops clear of everything by the
  // stated margins. 1 also if it stands beyond them; 0 if no share is certified.
  double scaling = 0.0;
  // The least of its bounds less their margins over its pairs, until it stands, m. The bound of
  // another robot may be lower (PairReport::stop_lower). -infinity: not known.
  double clearance = 0.0;
  std::uint32_t pair = 0;  // that has this clearance; Scene::pairs
  double share = 0.0;      // of its motion to the stop, 0 to 1, that is certainly clear
  double time = 0.0;       // s: until it stands, from the report on; NaN: not known
};

// Whether the contact that is allowed for a pair is as allowed.
enum class ContactStatus : std::uint8_t {
  // The contact is in force or not, but a pose is not known, late, contradicted or after a
  // discontinuity. Zones treat the pair like any other.
  kUnknown = 0,
  kAllowed = 1,  // in force; certified to be no deeper than allowed since the last tick
  kTooDeep = 2,  // in force; may have been deeper than allowed since the last tick
  kEnded = 3,    // not in force any more; the pair is certified not to touch
  kTooLate = 4,  // not in force any more; the pair may touch
  kAbsent = 5,   // an object is known not to be there
};
[[nodiscard]] const char* name(ContactStatus status) noexcept;

// The condition that ended an allowance: ContactEnd of config/scene/contact.hpp.
enum class ContactEnded : std::uint8_t {
  kNot = 0,
  kByDistance = 1,
  kByTime = 2,  // duration or time
  kByCycle = 3,
};
[[nodiscard]] const char* name(ContactEnded ended) noexcept;

// A pair for which the scene allows a contact. The pair's distance is in Report::pairs as always.
struct ContactReport {
  std::uint32_t contact = 0, pair = 0;  // indices into Scene::contacts and Scene::pairs
  ContactStatus status = ContactStatus::kUnknown;
  ContactEnded ended = ContactEnded::kNot;
  // The pair is certified to have been no deeper than this at any instant since the last tick, m:
  // max(0, -swept_lower). Infinity: not known.
  double depth = 0.0;
  // The tick in which the allowance came into force, and its time.
  std::uint64_t since_cycle = 0;
  std::int64_t since_ns = 0;
  // The first tick in which it is not in force any more, and its time; 0: it is in force.
  std::uint64_t ended_cycle = 0;
  std::int64_t ended_ns = 0;
};

// What the frame in use of a sensor cannot show near a link, at the stamp of the frame.
struct HiddenReport {
  std::uint32_t pair = 0;      // index into Scene::pairs: the sensor, and a link or what it carries
  std::uint32_t elements = 0;  // of the frame, left out as the link's own image
  // The blind shell, m: anything within this of the link may be left out with its own image. Then
  // no distance from the sensor to any object is that of it: the shells of all links count for each
  // pair of the sensor. Infinity: no frame is in use.
  double thickness = kInfinity;
  // A lower bound of the distance to the nearest place in the picture that the frame has not seen
  // (monitor/clouds/README.md), and about where that is, in the world, m. -infinity and NaN: not
  // known, or the sensor's `unseen` is not asked for. Infinity and NaN: there is no such place.
  double unseen = -kInfinity;
  Vec3 unseen_at = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
};

// Whether the closest points of a pair are the only ones. If they are not, its distance has no
// gradient: the rates are one of several, and may jump.
enum class GradientStatus : std::uint8_t {
  kUnknown = 0,  // there are no rates
  kUnique = 1,   // no other points are as close, or the joints move them alike
  // Other points are as close within 1e-9 m or 1e-6 rad: a kink of the distance.
  kOneOfSeveral = 2,
  // Only the parts were compared. The features of curved bodies are not, nor are those of bodies
  // that touch or overlap or whose query did not converge.
  kPartsCompared = 3,
};
[[nodiscard]] const char* name(GradientStatus status) noexcept;

// Tells how near a pair is to having a second pair of closest points. NaN: not known.
struct GradientAlternative {
  GradientStatus status = GradientStatus::kUnknown;
  // Every other pair of parts, unless it meets the closest points as well, is farther apart than
  // the closest one by at least this, m. Infinity: there is no other.
  double farther = 0.0;
  // The sine of the angle between the bodies and a flat contact, 0 to 1: at right angles to the
  // normal, one of them recedes from the closest points at about this angle or more. 0: both extend
  // along one such line, as parallel faces do. Lines along which the joints change all distances
  // alike are left out.
  double tilt = 0.0;
};

// Derivatives of published pairs' distances with respect to joint positions, in the layout of
// monitor/interface/gradient_rows.hpp. An entry is NaN if the pair was not evaluated in this tick,
// or if a joint that moves it is not known. All vectors are empty unless Scene::gradients.
struct Gradients {
  std::vector<double> rates;  // m/rad or m/m, one for each entry of the rows; sized once
  // The rate of change of the distance due to all motion other than that of joints, m/s; one for
  // each row. NaN if PairReport::closing_speed is.
  std::vector<double> drifts;
  std::vector<GradientAlternative> alternatives;  // one for each row
};

struct Report {
  std::uint64_t cycle = 0;           // counts ticks from 1
  std::int64_t now_ns = 0;           // the time of the tick (TickTime)
  std::int64_t clock_offset_ns = 0;  // CLOCK_REALTIME less now_ns (TickTime)
  std::int64_t report_delay_ns = 0;  // that the tick was told (TickTime); -1: not measured
  // Newest and oldest stamp of the moving objects' poses in use; 0: none is in use.
  std::int64_t newest_pose_ns = 0, oldest_pose_ns = 0;
  std::uint64_t scene_revision = 0;
  // The pair with the smallest upper bound, among all that are known and have been evaluated. While
  // it is stale it is not a minimum: its distance belongs to an old pose. Another stale pair may
  // then have a smaller lower bound. `lower_all` always bounds all pairs.
  PairReport minimum;
  bool minimum_known = false;  // false: there is no such pair
  // No other pair can be closer, and no pair is unknown or stale. Another pair that was evaluated
  // in this tick may still be closer within rounding. Absent pairs do not count.
  bool minimum_certified = false;
  double lower_all = 0.0;  // lower bound of the true distance of every pair that is not absent
  double swept_lower_all = 0.0;  // the same at every instant since the last tick: see swept_lower
  // Numbers of object pairs. Each pair is in one of the last four counts, or absent.
  std::uint32_t pairs_total = 0, evaluated = 0, carried = 0, stale = 0, unknown = 0;
  std::uint32_t queries = 0;  // distance queries (part pairs) in this tick
  // The largest PairReport::refresh_age_cycles of all known pairs, published or not.
  std::uint64_t oldest_evaluation_cycles = 0;
  std::vector<PairReport> pairs;  // those with ObjectPair::publish, in scene order; sized once
  std::vector<ZoneReport> zones;  // all zones, in scene order; sized once
  // The zones with `separation`, in scene order, and their pairs, zone by zone; sized once.
  std::vector<ZoneSeparation> separated_zones;
  std::vector<PairSeparation> separated_pairs;
  std::vector<RobotStop> stops;  // of the robots that state how they stop, in scene order
  Gradients gradients;
  // contact_pairs() of the scene, in ascending order of pairs; sized once. `minimum` and
  // `lower_all` include these pairs: an entry here says whether the contact is allowed.
  std::vector<ContactReport> contacts;
  // The pairs of a sensor and a link, or what it carries, in ascending order; sized once.
  std::vector<HiddenReport> hidden;
  std::array<std::uint64_t, kRejects> rejected{};  // totals since the start
};

// The number of pairs with the status kAbsent in a report or its message: those outside the four
// counts.
template <class Counts>
[[nodiscard]] std::uint32_t absent_pairs(const Counts& counts) noexcept {
  return counts.pairs_total - counts.evaluated - counts.carried - counts.stale - counts.unknown;
}

}  // namespace clearance
