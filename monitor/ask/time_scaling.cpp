// The largest factor by which a motion may be timed faster so that S_p of zones holds.
//
// At an instant, S_p of a pair is a function of the robot's speed: factor x the speed of the
// fastest point of the sphere around the link's part. The pair admits largest_speed() / that speed.
#include <algorithm>
#include <cmath>

#include "monitor/ask/motion_search.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/zones/protective_distance.hpp"

namespace clearance {
namespace {

// Factors nearer to each other than this are not told apart.
constexpr double kLeastFactor = 1e-4;

// The largest factor that a pair at `distance`, m, admits, rounded down. `speed`: of the robot as
// the motion is timed, m/s.
double factor_of(const Separation& terms, const Approach& approach, double distance,
                 double speed) noexcept {
  const double limit = largest_speed(terms, approach, distance);
  if (limit == kInfinity) return kInfinity;
  if (limit > 0.0 && speed > 0.0) return rounded_down(limit / speed);
  if (!(protective_distance(terms, approach, 0.0).sum <= distance)) return 0.0;
  return speed == 0.0 ? kInfinity : 0.0;
}

}  // namespace

void MotionSearch::collect_separated() {
  for (std::uint32_t z = 0; z < scene_.zones.size(); ++z) {
    const Zone& zone = scene_.zones[z];
    if (!zone.separation) continue;
    for (std::size_t i = 0; i < zone.pairs.size(); ++i) {
      const ObjectPair& objects = scene_.pairs[zone.pairs[i]];
      const bool human_is_first = zone.separation->human_is_first[i] != 0;
      const std::uint32_t robot = human_is_first ? objects.second : objects.first;
      const double margins =
          rounded_up(scene_.objects[objects.first].margin + scene_.objects[objects.second].margin);
      const std::uint32_t human = human_is_first ? objects.first : objects.second;
      const double human_speed =
          zone.separation->human_speed.value_or(scene_.objects[human].approach_speed);
      for (std::uint32_t p = 0; p < pairs_.pairs().size(); ++p) {
        std::uint32_t first = 0, second = 0;
        note_pair(p, first, second);
        if (first == objects.first && second == objects.second)
          separated_.push_back({z, p, robot, human, margins, human_speed});
      }
    }
  }
  scaled_.resize(separated_.size());
}

std::optional<std::string> MotionSearch::fault_of_scaling() const {
  for (std::uint32_t i = 0; i < separated_.size(); ++i) {
    const std::uint32_t robot = separated_[i].robot;
    const Zone& zone = scene_.zones[separated_[i].zone];
    if (posture_.is_of_question(robot) && bundle_of(separated_[i].pair).object_tip != robot) {
      return "the zone \"" + zone.name + "\" limits \"" + scene_.objects[robot].name +
             "\", which another zone has as its human beside the same object: a motion is timed "
             "only if a pair has one human";
    }
    if (posture_.is_of_question(robot) && zone.separation->reaction_is_measured) {
      return "the zone \"" + zone.name +
             "\" states controller_time_ms: a motion is timed only if it states reaction_time_ms, "
             "since what reports take is not known before it is made";
    }
    if (posture_.is_of_question(robot) && posture_.may_deviate_by_assumption(robot)) {
      return "\"" + scene_.objects[robot].name +
             "\" may move by its assumed speed: a motion is timed only if the question states that "
             "of all that moves the robot";
    }
  }
  return std::nullopt;
}

void MotionSearch::scale_time() {
  TimeScaling& scaling = answer_->scaling;
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < separated_.size(); ++i) {
    const PartPair& pair = pairs_.pairs()[separated_[i].pair];
    const std::uint32_t robot = separated_[i].robot;
    if (posture_.is_present(posture_.parts()[pair.base].object) && posture_.is_present(robot) &&
        posture_.is_of_question(robot))
      scaled_[count++] = i;
  }
  scaling.is_limited = count > 0 || question_->stoppable;
  posture_.stops().count_none();
  const Trajectory& trajectory = posture_.trajectory();
  if (trajectory.planned_segments() == 0)
    scale({0, 0, trajectory.begin(), trajectory.begin()}, count, 0.0);
  for (std::uint32_t i = 0; i < trajectory.planned_segments(); ++i)
    scale(trajectory.segment(i), count, 0.0);
  scaling.factor = std::min(scaling.factor, scaling.factor_above);
  if (question_->stoppable) scale_stops();
}

// A slower motion has shorter stops: so what holds at a factor holds at all lower ones.
void MotionSearch::scale_stops() {
  TimeScaling& scaling = answer_->scaling;
  only_stops_ = true;
  double least = 0.0, most = std::min(1.0, scaling.factor);
  double next = most;
  while (most - least > question_->scaling_tolerance * most && most > kLeastFactor) {
    MarginAnswer limit;
    const Verdict verdict = stops_scaled(next, limit);
    if (verdict == Verdict::kBelow && next < scaling.factor_above) {
      scaling.factor_above = next;
      scaling.time = limit.below_at;
      scaling.first = limit.first;
      scaling.second = limit.second;
      scaling.zone = TimeScaling::kNoZone;
    }
    (verdict == Verdict::kFree ? least : most) = next;
    next = 0.5 * (least + most);
  }
  scaling.factor = least;
  only_stops_ = false;
  posture_.stops().count_none();
}

// Returns kFree if all margins are kept, else the verdict of the first that is not.
Verdict MotionSearch::stops_scaled(double factor, MarginAnswer& limit) {
  posture_.count_stops(factor);
  const auto is_free = [&](double margin) {
    proven_until_ = posture_.trajectory().begin();
    limit = {.margin = margin};
    decide(limit);
    return limit.verdict == Verdict::kFree;
  };
  bool all = true;
  for (std::size_t i = 0; all && i < question_->margins.size(); ++i) {
    exempt_kept(question_->margins[i]);
    all = is_free(question_->margins[i]);
  }
  for (std::size_t i = 0; all && i < question_->margins_between.size(); ++i) {
    exempt_all_but(question_->margins_between[i]);
    all = is_free(question_->margins_between[i].margin);
  }
  exempt_.clear();
  return all ? Verdict::kFree : limit.verdict;
}

// `known`: a lower bound of the factor in a longer stretch.
void MotionSearch::scale(const Stretch& stretch, std::size_t count, double known) noexcept {
  TimeScaling& scaling = answer_->scaling;
  if (count == 0) return;
  if (is_exhausted()) {
    answer_->within_work_limit = false;
    scaling.factor = std::min(scaling.factor, known);
    return;
  }
  const double middle = posture_.trajectory().middle(stretch);
  place(stretch, middle);
  const bool divides = can_divide(stretch, middle);
  const auto enough = [&] {
    const double above = scaling.factor_above;
    if (above == kInfinity) return above;
    return (1.0 - question_->scaling_tolerance) * above - kLeastFactor;
  };
  std::size_t kept = 0;
  double least = kInfinity;
  for (std::size_t i = 0; i < count; ++i) {
    const SeparatedPair& separated = separated_[scaled_[i]];
    const PartPair& of = pairs_.pairs()[separated.pair];
    const Bundle& bundle = pairs_.bundles()[of.bundle];
    const Separation& terms = *scene_.zones[separated.zone].separation;
    const TipMotion motion = tip_motion(bundle, stretch, middle, posture_);
    Pair at = pair_at(separated.pair, motion);
    // S_p counts the person's path since the pose was measured. So nothing is assumed before.
    const Approach people{.human_speed = separated.human_speed,
                          .human_age = posture_.age(separated.human)};
    ObjectApproach approach = at.approach;
    approach.nearing = {};
    const double radius = at.tip.sphere_in_world.radius;
    const double fastest = largest_tip_speed(motion, radius);
    const double apart = gap(at, separated.pair, kInfinity);
    const double loss = rounded_up(motion.moved + motion.error + approach.moved);
    double lower =
        factor_of(terms, people, rounded_down(apart - loss - separated.margins), fastest);
    if (lower < enough()) {
      const PairAtMiddle found = query(at, separated.pair);
      const double over =
          lower_over(found, at.base, at.tip, bundle.keeps_direction, motion, approach, kInfinity);
      lower = std::max(lower,
                       factor_of(terms, people, rounded_down(over - separated.margins), fastest));
      const double slowest = largest_tip_speed({.twist = motion.twist, .nearing = {}}, radius);
      // With stated errors, no larger factor is certain.
      const double now =
          rounded_up(found.upper + motion.error - 2.0 * bundle.model_error - separated.margins);
      const double upper =
          rounded_up(rounded_up(factor_of(terms, people, now, (1.0 - 0x1p-40) * slowest)));
      if (upper < scaling.factor_above) {
        scaling.factor_above = upper;
        scaling.time = middle;
        scaling.zone = separated.zone;
        note_pair(separated.pair, scaling.first, scaling.second);
      }
    }
    if (lower >= enough() || !divides) {
      scaling.factor = std::min(scaling.factor, lower);
      continue;
    }
    least = std::min(least, lower);
    std::swap(scaled_[kept++], scaled_[i]);
  }
  const double inherited = std::max(known, least);
  scale(Trajectory::before(stretch, middle), kept, inherited);
  scale(Trajectory::after(stretch, middle), kept, inherited);
}

}  // namespace clearance
