#include "tests/monitor/adversary/truth_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "monitor/interface/pair_name.hpp"
#include "tests/monitor/adversary/rests_on.hpp"

namespace clearance::test::lies {
namespace {

constexpr double kRounding = 1e-9;  // m
// Between two ticks a body is taken to move straight from one pose to the next. The path bends: an
// acceleration of 20 m/s2 over 10 ms departs by a quarter of a millimetre.
constexpr double kBend = 2.5e-4;  // m
// The motion that a question states departs from the true one by less, m.
constexpr double kPathError = 1e-6;
// A velocity from differences is that of half an interval ago, or of a stamp an age limit ago. No
// body accelerates by more than 8 m/s2.
constexpr double kSpeedError = 8.0 * 0.02 + 0.02;  // m/s
// The path length of the farthest point of a robot when a joint rotates by a radian, m.
constexpr double kLever = 2.1;
// The camera is nearer to the points that it sees, m. Bounds are those of the balls by which it
// knows them, whose radius is the stated error of the depth.
constexpr double kSight = 2.0;
constexpr double kSeenRadius = 0.002 * 1.001;
// Upper bounds are those of elements: a pixel reaches as far as its error and noise, along a ray at
// the picture's corner, and a cube of the map from corner to corner.
constexpr double kPixelReach = 1.12 * 0.0145, kCubeReach = 1.7321 * kCube;

// The length of stated speed x age limit, m.
double slack_of(Channel channel) {
  if (is_robot(channel)) return kLever * kJointSpeed[0] * 1e-9 * static_cast<double>(kAgeLimit);
  if (channel == Channel::kOdom || channel == Channel::kBase)
    return kBaseSpeed * 1e-9 * static_cast<double>(kBaseAgeLimit);
  if (channel == Channel::kEye || channel == Channel::kPoints)
    return (1.0 + kSight) * kEyeSpeed * 1e-9 * static_cast<double>(kEyeAgeLimit);
  if (is_seen(channel)) return kSeenSpeed * 1e-9 * static_cast<double>(kEyeAgeLimit);
  return kBallSpeed * 1e-9 * static_cast<double>(kAgeLimit);
}

std::int64_t age_limit_of(std::size_t body) {
  return is_link_of(Channel::kArm, body) || body == kPartBody ? kBaseAgeLimit : kAgeLimit;
}

// How much nearer than the truth an upper bound may be, m.
double reach_of(std::size_t body) {
  return body == kLensBody ? kPixelReach : body == kMapBody ? kCubeReach : 0.0;
}

}  // namespace

const char* name(Claim claim) {
  constexpr std::array<const char*, kClaims> kNames{
      "lower",      "upper", "swept lower", "minimum", "zone",
      "separation", "speed", "answer",      "command", "partner"};
  return kNames[static_cast<std::size_t>(claim)];
}

bool Verdict::is_true() const {
  return std::ranges::all_of(claims, [](const False& each) { return each.times == 0; });
}

std::string Verdict::text() const {
  std::string text;
  for (std::size_t i = 0; i < kClaims; ++i) {
    if (claims[i].times == 0) continue;
    text +=
        fmt::format("  {}: false {} times, by {:.4f} at worst; first: {}\n",
                    name(static_cast<Claim>(i)), claims[i].times, claims[i].worst, claims[i].first);
  }
  text += fmt::format("  questions: {} asked, {} answered, {} free; {}\n", asked, answered, free,
                      refusal);
  text += fmt::format("  known again {} ms after the last fault\n", recovered / kMs);
  return text + fmt::format("  certified in {:.2f} % of pairs and ticks, {} in {:.2f} %\n",
                            100.0 * certified, least_pair, 100.0 * least_certified);
}

TruthJudge::TruthJudge(const Scene& scene, const TrueMotion& truth,
                       const std::vector<Fault>& faults)
    : truth_(truth), faults_(faults) {
  change(scene);
  for (const Fault& fault : faults) {
    if (fault.lie == Lie::kWrapped) continue;  // there is nothing to recover from
    ended_ = std::max(ended_, fault.to);
    available_from_ = std::max(available_from_, fault.to + recovers(fault));
  }
}

void TruthJudge::change(const Scene& scene) {
  scene_ = &scene;
  const std::size_t pairs = scene.pairs.size();
  was_known_.assign(pairs, 0);
  goes_on_.assign(pairs, 0);
  frame_age_.assign(pairs, 0);
  used_.assign(pairs, 0.0);
  used_since_.assign(pairs, 0.0);
  certified_.assign(pairs, 0);
  judged_.assign(pairs, 0);
  known_since_.assign(pairs, 0);
  body_.clear();
  for (const Object& object : scene.objects) {
    std::size_t body = 0;
    while (object.name != body_name(body)) ++body;
    body_.push_back(body);
  }
}

void TruthJudge::await_command(std::size_t body, std::int64_t since) {
  awaited_body_ = body;
  if (t_ > since + kCommandTakes)
    note_false(Claim::kCommand, 1e-9 * static_cast<double>(t_ - since - kCommandTakes), "waits");
}

void TruthJudge::judge(const Report& report, std::int64_t t) {
  tick_ = t > 0 ? t - t_ : kMs;
  t_ = t;
  centres_[2] = t > 0 ? centres_[0] : truth_.centres(t - tick_);
  centres_[1] = truth_.centres(t - tick_ / 2);
  centres_[0] = truth_.centres(t);
  find_allowed(t);
  for (const PairReport& pair : report.pairs) judge_pair(pair);
  judge_minimum(report);
  for (std::size_t zone = 0; zone < report.zones.size(); ++zone) judge_zone(report, zone);
  for (const PairSeparation& pair : report.separated_pairs) judge_separation(pair);
}

void TruthJudge::find_allowed(std::int64_t t) {
  allowed_ = {};
  for (const Fault& fault : faults_) {
    const Admissible admitted = admissible(fault);
    for (std::size_t body = 0; body < kBodies; ++body) {
      Allowed& of = allowed_[body];
      if (is_hidden_by(body, fault))
        of.is_excused |= t < fault.from + admitted.delay + kEyeAgeLimit;
      if (!rests_on(body, fault.channel)) continue;
      // A late picture that tf has not placed is in use for another second: its speed is stated.
      const bool may_be_late = body == kLensBody || body == kMapBody;
      const std::int64_t ends = kSlackEnds + (may_be_late ? kSecond : 0);
      if (t >= fault.from && t < fault.to + ends)
        of.error += admitted.slack * slack_of(fault.channel);
      of.is_excused |= t >= fault.from && t < fault.from + admitted.delay;
      const std::int64_t delay = speed_delay(fault);
      of.is_speed_excused |= t >= fault.from && t < fault.from + delay;
      of.is_speed_excused |= t >= fault.to && t < fault.to + delay;
    }
  }
  if (truth_.carries(t)) allowed_[kPartBody] = allowed_[kArmBody + kLinks - 1];
  // Until a command is in force, the report is of the scene before (idl/COMMANDS.md). Nothing is
  // where an absent object was.
  if (awaited_body_ < kBodies) allowed_[awaited_body_].is_excused = true;
  for (std::size_t i = 0; i < body_.size(); ++i)
    allowed_[body_[i]].is_excused |= scene_->objects[i].absent;
}

bool TruthJudge::moves_with(std::size_t body, Channel robot) const {
  return is_link_of(robot, body) ||
         (body == kPartBody && robot == Channel::kArm && truth_.carries(t_));
}

// Bounds hold for the poses in use, whose ages the report states. Those of a late object include
// its motion until the tick.
double TruthJudge::allowed(std::uint32_t pair, std::int64_t age_a, std::int64_t age_b) const {
  const auto of = [&](std::uint32_t object, std::int64_t age) {
    const std::size_t body = body_[object];
    const double aged = age > 0 && age <= age_limit_of(body)
                            ? TrueMotion::fastest(body) * 1e-9 * static_cast<double>(age)
                            : 0.0;
    return aged + allowed_[body].error + (body == kEyeBody ? kSeenRadius : 0.0);
  };
  return kRounding + of(scene_->pairs[pair].first, age_a) + of(scene_->pairs[pair].second, age_b);
}

bool TruthJudge::is_excused(std::uint32_t pair) const {
  return allowed_[body_[scene_->pairs[pair].first]].is_excused ||
         allowed_[body_[scene_->pairs[pair].second]].is_excused;
}

long double TruthJudge::distance(std::uint32_t pair, const Centres& centres) const {
  const ObjectPair& of = scene_->pairs[pair];
  return TrueMotion::distance(body_[of.first], body_[of.second], centres);
}

long double TruthJudge::least_since(std::uint32_t pair) const {
  long double least = distance(pair, centres_[0]);
  if (goes_on_[pair] == 0) return least;
  for (const Centres& centres : centres_) least = std::min(least, distance(pair, centres));
  return least;
}

std::int64_t TruthJudge::age_of_frame(const PairReport& pair) const {
  const auto of = [&](std::uint32_t object, std::int64_t age) {
    return scene_->objects[object].is_seen() ? age : 0;
  };
  return of(scene_->pairs[pair.pair].first, pair.age_a_ns) +
         of(scene_->pairs[pair.pair].second, pair.age_b_ns);
}

void TruthJudge::judge_pair(const PairReport& pair) {
  const bool is_known = pair.status <= PairStatus::kStale;
  const double before = used_[pair.pair];
  used_[pair.pair] = allowed(pair.pair, pair.age_a_ns, pair.age_b_ns);
  used_since_[pair.pair] = std::max(before, used_[pair.pair]);
  note_known(pair);
  if (t_ >= available_from_) {
    ++judged_[pair.pair];
    certified_[pair.pair] += pair.status <= PairStatus::kCarried;
  }
  const std::int64_t age = age_of_frame(pair),
                     age_before = std::exchange(frame_age_[pair.pair], age);
  goes_on_[pair.pair] = std::exchange(was_known_[pair.pair], is_known) && age >= age_before;
  if (!is_known || is_excused(pair.pair)) return;
  const auto truth = static_cast<double>(distance(pair.pair, centres_[0]));
  const double error = used_[pair.pair];
  const auto said = [&](double since) {
    return fmt::format(
        "{} is {}: {:.4f} to {:.4f}, swept {:.4f}; true {:.4f}, since {:.4f}; "
        "ages {} and {} ms, allowed {:.4f}",
        pair_name(*scene_, pair.pair), name(pair.status), pair.lower, pair.upper, pair.swept_lower,
        truth, since, pair.age_a_ns / kMs, pair.age_b_ns / kMs, error);
  };
  const auto since = static_cast<double>(least_since(pair.pair));
  if (pair.lower > truth + error)
    note_false(Claim::kLower, pair.lower - truth - error, said(since));
  const ObjectPair& of = scene_->pairs[pair.pair];
  const double nearer = error + reach_of(body_[of.first]) + reach_of(body_[of.second]);
  if (pair.upper < truth - nearer)
    note_false(Claim::kUpper, truth - nearer - pair.upper, said(since));
  const double error_since = used_since_[pair.pair] + kBend;
  if (goes_on_[pair.pair] && pair.swept_lower > since + error_since)
    note_false(Claim::kSwept, pair.swept_lower - since - error_since, said(since));
}

void TruthJudge::note_known(const PairReport& pair) {
  std::int64_t& since = known_since_[pair.pair];
  if (t_ < ended_ || since == kSettledOnce) return;
  if (since < ended_ || pair.status > PairStatus::kCarried) since = t_;
  if (t_ < since + kSettled) return;
  verdict_.recovered = std::max(verdict_.recovered, since - ended_);
  since = kSettledOnce;
}

void TruthJudge::judge_minimum(const Report& report) {
  for (std::uint32_t pair = 0; pair < scene_->pairs.size(); ++pair) {
    if (is_excused(pair)) continue;
    const auto truth = static_cast<double>(distance(pair, centres_[0]));
    double claimed = report.lower_all;
    if (report.minimum_certified) claimed = std::max(claimed, report.minimum.lower);
    const double by = claimed - truth - used_[pair];
    if (by > 0.0) {
      note_false(Claim::kMinimum, by,
                 fmt::format("all pairs are above {:.4f}, {} is at {:.4f}", claimed,
                             pair_name(*scene_, pair), truth));
    }
  }
}

void TruthJudge::judge_zone(const Report& report, std::size_t zone) {
  if (report.zones[zone].active) return;
  const Zone& levels = scene_->zones[zone];
  for (const std::uint32_t pair : levels.pairs) {
    if (is_excused(pair)) continue;
    const double inside = enter_below(levels, pair) - static_cast<double>(least_since(pair));
    const double by = inside - used_since_[pair] - kBend;
    if (by > 0.0) {
      note_false(Claim::kZone, by,
                 fmt::format("zone '{}' is not active, {} is inside by {:.4f}", levels.name,
                             pair_name(*scene_, pair), inside));
    }
  }
}

// A contact that the scene allows is in the zone only if it is too deep.
double TruthJudge::enter_below(const Zone& zone, std::uint32_t pair) const {
  for (const AllowedContact& contact : scene_->contacts) {
    if (std::ranges::count(contact.pairs, pair) != 0) return -contact.depth;
  }
  return zone.enter_below;
}

void TruthJudge::judge_separation(const PairSeparation& pair) {
  if (pair.validity == SeparationValidity::kUnknown || is_excused(pair.pair)) return;
  const auto truth = static_cast<double>(distance(pair.pair, centres_[0]));
  const double by = pair.clearance - truth - used_[pair.pair];
  if (by > 0.0) {
    note_false(Claim::kSeparation, by,
               fmt::format("{} has a clearance of {:.4f}, true {:.4f}",
                           pair_name(*scene_, pair.pair), pair.clearance, truth));
  }
  if (pair.validity != SeparationValidity::kMeasured) return;
  const std::size_t first = body_[scene_->pairs[pair.pair].first];
  const std::size_t second = body_[scene_->pairs[pair.pair].second];
  if (allowed_[first].is_speed_excused || allowed_[second].is_speed_excused) return;
  const std::size_t human = first == 0 ? first : second, robot = first == 0 ? second : first;
  const TruePoint between = centres_[0][robot] - centres_[0][human];
  const TruePoint direction = between / between.norm();
  const long double per_second = 1e9L / static_cast<long double>(tick_);
  const auto human_speed =
      static_cast<double>((centres_[0][human] - centres_[2][human]).dot(direction) * per_second);
  const auto robot_speed =
      static_cast<double>((centres_[2][robot] - centres_[0][robot]).dot(direction) * per_second);
  const double slower = std::max(human_speed - pair.human_speed, robot_speed - pair.robot_speed);
  if (slower > kSpeedError) {
    note_false(Claim::kSpeed, slower - kSpeedError,
               fmt::format("{}: measured {:.3f} and {:.3f} m/s, true {:.3f} and {:.3f}",
                           pair_name(*scene_, pair.pair), pair.human_speed, pair.robot_speed,
                           human_speed, robot_speed));
  }
}

// The question states where the joints are, so faults of theirs excuse nothing; the ages of all
// other inputs are part of the answer. The arm's base is held where it was last heard, and moves.
void TruthJudge::judge(const Answer& answer, const std::optional<std::string>& refusal,
                       const std::vector<double>& times) {
  ++verdict_.asked;
  if (refusal) verdict_.refusal = *refusal;
  if (refusal) return;
  ++verdict_.answered;
  const MarginAnswer& margin = answer.margins.front();
  const bool is_free = margin.verdict == clearance::Verdict::kFree;
  verdict_.free += is_free ? 1 : 0;
  const double claimed = is_free ? std::max(answer.lower, margin.margin) : answer.lower;
  const std::int64_t last = t_ + std::llround(1e9 * times.back());
  for (std::int64_t t = t_; t <= last; t += kMs) {
    const Centres centres = truth_.centres(t);
    for (std::uint32_t pair = 0; pair < scene_->pairs.size(); ++pair) {
      const std::array bodies{body_[scene_->pairs[pair].first], body_[scene_->pairs[pair].second]};
      double error = kPathError;
      bool is_of_robot = false, is_excused = false;
      for (const std::size_t body : bodies) {
        const bool is_of_arm = moves_with(body, Channel::kArm);
        const bool is_link = is_of_arm || is_link_of(Channel::kPost, body);
        is_of_robot |= is_link;
        is_excused |= body == awaited_body_;
        if (is_of_arm) error += kBaseSpeed * 1e-9 * static_cast<double>(t - t_ + kBaseAgeLimit);
        if (is_link && !is_of_arm) continue;
        const Allowed& of = allowed_[is_of_arm ? kArmBody : body];
        is_excused |= of.is_excused;
        error += of.error + (body == kEyeBody ? kSeenRadius : 0.0);
      }
      if (!is_of_robot || is_excused) continue;
      const auto truth = static_cast<double>(distance(pair, centres));
      const double by = claimed - std::max(truth, 0.0) - error;
      if (by <= 0.0) continue;
      note_false(Claim::kAnswer, by,
                 fmt::format("{}: at least {:.4f}, {} is at {:.4f} after {} ms",
                             is_free ? "free" : "not free", claimed, pair_name(*scene_, pair),
                             truth, (t - t_) / kMs));
    }
  }
}

void TruthJudge::note_false(Claim claim, double by, const std::string& what) {
  Verdict::False& found = verdict_.claims[static_cast<std::size_t>(claim)];
  if (found.times++ == 0) found.first = fmt::format("at {} ms, {}", t_ / kMs, what);
  found.worst = std::max(found.worst, by);
}

Verdict TruthJudge::verdict() const {
  Verdict verdict = verdict_;
  verdict.recovers = available_from_ - ended_;
  const bool is_late = t_ > available_from_ && std::ranges::any_of(known_since_, [](auto since) {
                         return since != kSettledOnce;
                       });
  if (is_late) verdict.recovered = t_ - ended_;
  std::uint64_t certified = 0, judged = 0;
  for (std::uint32_t pair = 0; pair < scene_->pairs.size(); ++pair) {
    if (judged_[pair] == 0) continue;
    certified += certified_[pair];
    judged += judged_[pair];
    const double share = static_cast<double>(certified_[pair]) / static_cast<double>(judged_[pair]);
    if (verdict.least_pair.empty() || share < verdict.least_certified) {
      verdict.least_certified = share;
      verdict.least_pair = pair_name(*scene_, pair);
    }
  }
  if (judged > 0) verdict.certified = static_cast<double>(certified) / static_cast<double>(judged);
  return verdict;
}

}  // namespace clearance::test::lies
