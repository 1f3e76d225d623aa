#include "monitor/ask/motion_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "config/scene/chain_rounding.hpp"
#include "config/scene/pairs_between.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// Shorter stretches are not divided, relative to the duration.
constexpr double kShortest = 0x1p-46;
// Halves of halves: 32 levels of segments, and 46 in a segment.
constexpr std::size_t kMostLevels = 84;  // and the list of all pairs

const ObjectApproach kNoApproach;

}  // namespace

const char* name(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kFree:
      return "free";
    case Verdict::kBelow:
      return "below";
    case Verdict::kUndecided:
      return "undecided";
  }
  return "";
}

MotionSearch::MotionSearch(const Scene& scene)
    : scene_(scene), posture_(scene), pairs_(scene, posture_) {
  order_.resize(pairs_.pairs().size());
  open_.resize(kMostLevels * pairs_.bundles().size());
  std::size_t contacts = 0;
  for (const AllowedContact& contact : scene.contacts) contacts += contact.pairs.size();
  contacts_.reserve(contacts);
  if (contacts > 0) contact_of_.reserve(pairs_.pairs().size());
  collect_separated();
  leasts_.resize(std::max<std::size_t>(1, scene.pairs.size()));
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> watched;
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p)
    watched.emplace(std::minmax(scene.pairs[p].first, scene.pairs[p].second), p);
  for (std::uint32_t pair = 0; pair < pairs_.pairs().size(); ++pair) {
    std::uint32_t first = 0, second = 0;
    note_pair(pair, first, second);
    watched_.push_back(watched.at(std::minmax(first, second)));
  }
}

// All parts of a pair of objects have one chain.
double MotionSearch::add_levers(std::uint32_t pair, std::vector<Lever>& levers) const {
  const auto part = std::ranges::find(watched_, pair);
  if (part == watched_.end()) return kInfinity;
  const Bundle& bundle = bundle_of(static_cast<std::uint32_t>(part - watched_.begin()));
  for (const ChainJoint& joint : posture_.chains().joints(bundle.chain)) {
    const double reach = joint.largest_reach < kLargestLength ? joint.largest_reach : kInfinity;
    levers.push_back({joint.variable, joint.factor * (joint.rotates ? reach : 1.0)});
  }
  return bundle.model_error;
}

std::optional<std::string> MotionSearch::fault(const Question& question) const {
  if (!(question.tolerance > 0.0) || !(question.margin_tolerance > 0.0) ||
      !(question.scaling_tolerance > 0.0)) {
    return "a tolerance is not above 0";
  }
  if (!question.margins_by_pair.empty() && question.margins_by_pair.size() != scene_.pairs.size())
    return "the question needs a margin for each watched pair, or none";
  if (!question.known_by_pair.empty() && question.known_by_pair.size() != scene_.pairs.size())
    return "the question needs a known bound for each watched pair, or none";
  const auto wrong = [](double margin) -> std::optional<std::string> {
    if (margin >= 0.0 && std::isfinite(margin)) return std::nullopt;
    return "a margin is " + std::to_string(margin) + "; expected a finite number from 0 on, m";
  };
  for (const double margin : question.margins) {
    if (auto fault = wrong(margin)) return fault;
  }
  for (const MarginBetween& of : question.margins_between) {
    if (auto fault = wrong(of.margin)) return fault;
    const std::vector<std::uint32_t> pairs = pairs_between(scene_, of.a, of.b);
    const bool is_left_out = std::ranges::all_of(pairs, [&](std::uint32_t pair) {
      return posture_.is_left_out(scene_.pairs[pair].first) ||
             posture_.is_left_out(scene_.pairs[pair].second);
    });
    if (pairs.empty()) return why_no_pairs_between(scene_, of.a, of.b);
    const std::string named = "the margin of \"" + of.a + (of.b.empty() ? "" : "\" and \"" + of.b);
    if (is_left_out) return named + "\" is of pairs that the question leaves out";
    // Absent objects keep each margin.
    const auto is_there = [&](std::uint32_t pair) {
      return posture_.is_present(scene_.pairs[pair].first) &&
             posture_.is_present(scene_.pairs[pair].second);
    };
    const auto is_asked = [&](std::uint32_t pair) {
      return is_asked_about(scene_.pairs[pair].first, scene_.pairs[pair].second);
    };
    if (std::ranges::any_of(pairs, is_there) && std::ranges::none_of(pairs, is_asked))
      return named + "\" is of pairs without a link of a robot that the question moves or holds";
  }
  if (!question.profile) return std::nullopt;
  const ProfileRequest& profile = *question.profile;
  if (!(profile.tolerance > 0.0) || profile.most_points == 0)
    return "the tolerance of the profile is not above 0, or it has no point";
  for (const std::string* name : {&profile.first, &profile.second}) {
    if (profile.first.empty() && profile.second.empty()) break;
    const auto at = std::find_if(scene_.objects.begin(), scene_.objects.end(),
                                 [&](const Object& object) { return object.name == *name; });
    if (at == scene_.objects.end()) return "the cell has no object \"" + *name + "\"";
  }
  for (std::uint32_t i = 0; i < pairs_.pairs().size(); ++i) {
    std::uint32_t first = 0, second = 0;
    note_pair(i, first, second);
    if (is_in_profile(profile, i) && is_asked_about(first, second)) return std::nullopt;
  }
  if (profile.first.empty()) return std::nullopt;
  return "the pair of the profile, \"" + profile.first + "\" and \"" + profile.second +
         "\", is not watched with a link of a robot that the question moves or holds";
}

// The question says nothing of other pairs.
bool MotionSearch::is_asked_about(std::uint32_t first, std::uint32_t second) const noexcept {
  return (posture_.is_link(first) && posture_.is_of_question(first)) ||
         (posture_.is_link(second) && posture_.is_of_question(second));
}

std::optional<std::string> MotionSearch::ask(const Question& question, Answer& answer) {
  if (auto text = posture_.take(question)) return text;
  if (auto text = fault(question)) return text;
  if (question.time_scaling) {
    if (auto text = fault_of_scaling()) return text;
  }
  if (auto text = take_contacts(question)) return text;
  begin(question, answer);
  if (is_by_pair()) {
    bound_by_pair();
  } else {
    if (!question.only_margins) find_least();
    decide_margins();
  }
  if (question.profile) make_profile(*question.profile);
  if (question.time_scaling) scale_time();
  return std::nullopt;
}

void MotionSearch::begin(const Question& question, Answer& answer) {
  question_ = &question;
  answer_ = &answer;
  std::vector<MarginAnswer> margins = std::move(answer.margins);
  std::vector<ProfilePoint> profile = std::move(answer.profile);
  std::vector<double> lower_by_pair = std::move(answer.lower_by_pair);
  answer = {};
  answer.margins = std::move(margins);
  answer.profile = std::move(profile);
  answer.lower_by_pair = std::move(lower_by_pair);
  answer.profile.clear();
  answer.margins.assign(
      is_by_pair() ? 1 : question.margins.size() + question.margins_between.size(), {});
  answer.lower_by_pair.assign(question.margins_by_pair.size(), -kInfinity);
  if (is_by_pair()) make_room_by_pair();
  answer.upper = kInfinity;
  std::ranges::fill(leasts_, Least());
  duration_ = posture_.trajectory().end() - posture_.trajectory().begin();
  pairs_.forget();
  const OpenList all = all_pairs();
  answer.has_pair = !all.is_empty();
}

MotionSearch::OpenList MotionSearch::all_pairs() noexcept {
  OpenList list;
  std::iota(order_.begin(), order_.end(), 0u);
  const auto bundles = pairs_.bundles();
  for (std::uint32_t b = 0; b < bundles.size(); ++b) {
    std::uint32_t count = bundles[b].end - bundles[b].first;
    const bool base_counts =
        bundles[b].base_is_link && posture_.is_of_question(bundles[b].object_base);
    if (!posture_.is_of_question(bundles[b].object_tip) && !base_counts) continue;
    if (!posture_.is_present(bundles[b].object_tip)) continue;
    if (!posture_.all_present()) {
      count = 0;
      for (std::uint32_t i = bundles[b].first; i < bundles[b].end; ++i) {
        const std::uint32_t base = posture_.parts()[pairs_.pairs()[i].base].object;
        if (posture_.is_present(base)) order_[bundles[b].first + count++] = i;
      }
    }
    if (count > 0) open_[list.end++] = {b, count};
  }
  return list;
}

void MotionSearch::place(const Stretch& stretch, double at) noexcept {
  posture_.place(stretch, at);
  ++answer_->placements;
}

bool MotionSearch::can_divide(const Stretch& stretch, double middle) const noexcept {
  return stretch.from < middle && middle < stretch.to &&
         stretch.to - stretch.from > kShortest * duration_;
}

MotionSearch::Pair MotionSearch::pair_at(std::uint32_t pair, const TipMotion& motion) noexcept {
  const PartPair& of = pairs_.pairs()[pair];
  const PosedPart& tip = posture_.part(pairs_.bundles()[of.bundle].tip);
  const PosedPart& base = posture_.part(of.base);
  const Bundle& bundle = pairs_.bundles()[of.bundle];
  const ObjectApproach* approach = &posture_.approach(base.object);
  if (bundle.base_carries_tip) approach = &kNoApproach;
  if (posture_.any_free()) {
    approach_ = *approach;
    Nearing& nearing = approach_.nearing;
    Nearing of_base;
    if (bundle.base_is_link && posture_.may_deviate(base.object)) {
      of_base = posture_.chains().nearing(bundle.chain, base.object, base.sphere_in_world,
                                          posture_.bounds(), posture_.free_variables());
    }
    nearing.until_end =
        rounded_up(nearing.until_end + motion.nearing.until_end + of_base.until_end);
    nearing.until_middle +=
        rounded_down_if_finite(motion.nearing.until_middle + of_base.until_middle);
    nearing.until_begin += rounded_down_if_finite(motion.nearing.until_begin + of_base.until_begin);
    approach = &approach_;
  }
  const double loss =
      rounded_up(motion.moved + motion.error + approach->moved + approach->nearing.until_end);
  return {base, tip, *approach, std::isnan(loss) ? kInfinity : loss};
}

std::uint32_t MotionSearch::near_ones(const Bundle& bundle, std::uint32_t count,
                                      const TipMotion& motion, double enough) noexcept {
  if (posture_.any_free() || !(enough >= 0.0)) return count;
  const Sphere& tip = posture_.part(bundle.tip).sphere_in_world;
  const Vec3 centre = tip.centre;
  const double reach = tip.radius + motion.moved + motion.error + enough;
  std::uint32_t* const order = &order_[bundle.first];
  const std::span<const PartPair> pairs = pairs_.pairs();
  std::uint32_t near = 0;
  const auto sort_out = [&](const auto& sphere_of) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const Sphere& base = sphere_of(pairs[order[i]].base);
      const double apart = base.radius + reach;
      const bool is_far = (base.centre - centre).squaredNorm() > (1.0 + 0x1p-40) * (apart * apart);
      if (!is_far) std::swap(order[near++], order[i]);
    }
  };
  if (bundle.base_is_link) {
    sort_out(
        [&](std::uint32_t part) -> const Sphere& { return posture_.part(part).sphere_in_world; });
  } else {
    sort_out([swept = posture_.swept_spheres()](std::uint32_t part) -> const Sphere& {
      return swept[part];
    });
  }
  return near;
}

double MotionSearch::gap(const Pair& at, std::uint32_t pair, double enough) const noexcept {
  const PartPair& of = pairs_.pairs()[pair];
  const double apart = gap_at_least(at.base, pairs_.box(of.base), at.tip,
                                    pairs_.box(pairs_.bundles()[of.bundle].tip), enough);
  return std::isnan(apart) ? -kInfinity : apart;
}

PairAtMiddle MotionSearch::query(const Pair& at, std::uint32_t pair) noexcept {
  ++answer_->queries;
  const std::uint32_t seen = pairs_.pairs()[pair].seen;
  if (seen != PartPair::kNotSeen) {
    return query_seen(posture_.content(at.base.object), at.base, at.tip, pairs_.slab(),
                      pairs_.seen(seen));
  }
  return query_pair(at.base, at.tip, pairs_.tracking(pair));
}

void MotionSearch::note_pair(std::uint32_t pair, std::uint32_t& first,
                             std::uint32_t& second) const noexcept {
  const PartPair& of = pairs_.pairs()[pair];
  first = posture_.parts()[of.base].object;
  second = pairs_.bundles()[of.bundle].object_tip;
  if (of.swapped) std::swap(first, second);
}

void MotionSearch::note_upper(const PairAtMiddle& found, double upper, double at,
                              std::uint32_t pair) noexcept {
  if (only_stops_) return;
  const double open = 2.0 * bundle_of(pair).model_error;
  Least& least = least_of(pair);
  least.reached = std::min(least.reached, open == 0.0 ? upper : rounded_up(upper - open));
  if (!(upper < answer_->upper)) return;
  answer_->upper = upper;
  answer_->time = at;
  note_pair(pair, answer_->first, answer_->second);
  const bool swapped = pairs_.pairs()[pair].swapped;
  answer_->point_on_first = swapped ? found.on_tip : found.on_base;
  answer_->point_on_second = swapped ? found.on_base : found.on_tip;
}

}  // namespace clearance
