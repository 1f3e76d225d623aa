// Judges the bound over all pairs, which takes one comparison a tick. Single pairs are searched
// only to name the one that broke an expectation.
#include "monitor/replay/expectations.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/text/sentences.hpp"
#include "monitor/pair_name.hpp"
#include "monitor/replay/metres.hpp"

namespace clearance {
namespace {

// For a message about a zone that does not exist.
std::string zone_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Zone& zone : scene.zones) names.push_back(zone.name);
  return names.empty() ? "it has none" : fmt::format("its zones are {}", one_of(names));
}

bool may_touch(const Report& report, std::uint32_t pair) {
  const auto found = std::ranges::lower_bound(report.contacts, pair, {}, &ContactReport::pair);
  return found != report.contacts.end() && found->pair == pair &&
         found->status == ContactStatus::kAllowed;
}

// Why a zone is active: by the distance now, or by what may have happened between two ticks.
std::string entered(const Scene& scene, std::uint32_t id, const ZoneReport& report) {
  const Zone& zone = scene.zones[id];
  const bool between =
      report.clearance >= zone.enter_below && report.swept_clearance < zone.enter_below;
  const std::string what =
      between ? fmt::format(" was between two ticks not certified to have more clearance than {}",
                            metres(report.swept_clearance))
              : fmt::format(" has a clearance of {}", metres(report.clearance));
  return fmt::format("zone '{}' is active: {}{} (its lower bound less both margins)", zone.name,
                     pair_name(scene, report.pair), what);
}

}  // namespace

// A zone that does not exist is an error: an expectation about it could never fail.
Expectations::Expectations(const Scene& scene, std::optional<double> min_distance,
                           const std::vector<std::string>& no_zone)
    : scene_(&scene), min_distance_(min_distance) {
  for (const std::string& name : no_zone) {
    no_zone_.push_back({.name = name, .zone = zone(name)});
    if (no_zone_.back().zone) continue;
    error_ = fmt::format("the cell has no zone '{}'; {}", name, zone_names(scene));
    return;
  }
}

std::optional<std::uint32_t> Expectations::zone(const std::string& name) const {
  const auto found = std::ranges::find(scene_->zones, name, &Zone::name);
  if (found == scene_->zones.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - scene_->zones.begin());
}

void Expectations::change(const Scene& scene) {
  scene_ = &scene;
  all_known_ = false;
  for (NoZone& expected : no_zone_) expected.zone = zone(expected.name);
}

// Before every moving object is known, distances are unknown and zones active by definition.
bool Expectations::all_seen(const Monitor& monitor) {
  for (std::uint32_t i = 0; i < scene_->objects.size() && !all_known_; ++i) {
    if (!scene_->objects[i].fixed && monitor.input_age(i).age_ns < 0) return false;
  }
  return all_known_ = true;
}

// Each expectation is reported once, at the first tick that breaks it.
std::vector<std::string> Expectations::check(const Report& report, const Monitor& monitor,
                                             bool judge) {
  std::vector<std::string> broken;
  if (!judge) return broken;
  if (!all_seen(monitor)) {
    if (const auto what = certainly_near(report, monitor)) broken.push_back(*what);
    return broken;
  }
  judged_ = true;
  if (const auto what = check_distance(report, monitor)) broken.push_back(*what);
  for (NoZone& expected : no_zone_) {
    if (expected.broken || !expected.zone) continue;
    const ZoneReport& zone = report.zones[*expected.zone];
    if (!zone.active) continue;
    expected.broken = true;
    broken.push_back(entered(*scene_, *expected.zone, zone));
  }
  return broken;
}

// Judges the pairs that are known.
std::optional<std::string> Expectations::certainly_near(const Report& report,
                                                        const Monitor& monitor) {
  if (!min_distance_ || distance_broken_) return std::nullopt;
  for (std::uint32_t p = 0; p < scene_->pairs.size(); ++p) {
    const PairReport pair = monitor.pair(p);
    if (!(pair.upper < *min_distance_) || may_touch(report, p)) continue;
    distance_broken_ = true;
    return fmt::format("{} is {} apart, at least {} expected", pair_name(*scene_, p),
                       metres(pair.distance), metres(*min_distance_));
  }
  return std::nullopt;
}

// The bound over all pairs decides; only where it fails is a pair looked for to name it.
std::optional<std::string> Expectations::check_distance(const Report& report,
                                                        const Monitor& monitor) {
  if (!min_distance_ || distance_broken_) return std::nullopt;
  if (report.lower_all >= *min_distance_) return check_sweep(report, monitor);
  std::optional<std::uint32_t> nearest;
  for (std::uint32_t p = 0; p < scene_->pairs.size(); ++p) {
    if (may_touch(report, p)) continue;
    if (!nearest || monitor.pair(p).lower < monitor.pair(*nearest).lower) nearest = p;
  }
  if (!nearest || monitor.pair(*nearest).lower >= *min_distance_)
    return check_sweep(report, monitor);
  distance_broken_ = true;
  const PairReport pair = monitor.pair(*nearest);
  const std::string who = pair_name(*scene_, *nearest);
  const std::string expected = fmt::format("{} expected", metres(*min_distance_));
  if (pair.upper < *min_distance_) {
    return fmt::format("{} is {} apart, at least {}", who, metres(pair.distance), expected);
  }
  return fmt::format("{} is not certified to be {} apart: {}, lower bound {}, at least {}", who,
                     metres(*min_distance_), name(pair.status), metres(pair.lower), expected);
}

// No pair is too near now, but one may have been since the last tick.
std::optional<std::string> Expectations::check_sweep(const Report& report, const Monitor& monitor) {
  if (report.swept_lower_all >= *min_distance_) return std::nullopt;
  for (std::uint32_t p = 0; p < scene_->pairs.size(); ++p) {
    if (may_touch(report, p)) continue;
    // More expensive than the tick's own bound, hence only where that one does not suffice.
    const SweptBounds found = monitor.sweep(p, *min_distance_);
    if (found.lower >= *min_distance_) continue;
    distance_broken_ = true;
    const std::string who = pair_name(*scene_, p);
    const std::string expected = fmt::format(", at least {} expected", metres(*min_distance_));
    if (found.upper < *min_distance_) {
      return fmt::format("{} was no more than {} apart between this tick and the last{}", who,
                         metres(found.upper), expected);
    }
    return fmt::format(
        "{} is not certified to have been {} apart between this tick and the last: lower bound "
        "{}{}",
        who, metres(*min_distance_), metres(found.lower), expected);
  }
  return std::nullopt;
}

// A replay that judged nothing must not pass for one that found nothing wrong.
std::optional<std::string> Expectations::never_judged(const Monitor& monitor) const {
  if (judged_ || (!min_distance_ && no_zone_.empty())) return std::nullopt;
  if (all_known_) return "no tick could be judged";
  std::vector<std::string> unknown;
  for (std::uint32_t i = 0; i < scene_->objects.size(); ++i) {
    if (!scene_->objects[i].fixed && monitor.input_age(i).age_ns < 0) {
      unknown.push_back(scene_->objects[i].name);
    }
  }
  return fmt::format("no tick could be judged: the recording never tells where {} is",
                     one_of(unknown));
}

}  // namespace clearance
