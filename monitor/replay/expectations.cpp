#include "monitor/replay/expectations.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "config/spelling.hpp"
#include "monitor/pair_name.hpp"

namespace clearance {
namespace {

std::string metres(double value) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%.9g m", value);
  return text.data();
}

std::string zone_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Zone& zone : scene.zones) names.push_back(zone.name);
  return names.empty() ? "it has none" : "its zones are " + one_of(names);
}

std::string entered(const Scene& scene, std::uint32_t id, const ZoneReport& report) {
  const Zone& zone = scene.zones[id];
  const bool between =
      report.clearance >= zone.enter_below && report.swept_clearance < zone.enter_below;
  const std::string what = between
                               ? " was between two ticks not proved to have more clearance than " +
                                     metres(report.swept_clearance)
                               : " has a clearance of " + metres(report.clearance);
  return "zone '" + zone.name + "' is active: " + pair_name(scene, report.pair) + what +
         " (its lower bound less both margins)";
}

}  // namespace

Expectations::Expectations(const Scene& scene, std::optional<double> min_distance,
                           const std::vector<std::string>& no_zone)
    : scene_(scene), min_distance_(min_distance) {
  for (const std::string& name : no_zone) {
    const auto found = std::ranges::find(scene.zones, name, &Zone::name);
    if (found == scene.zones.end()) {
      error_ = "the cell has no zone '" + name + "'; " + zone_names(scene);
      return;
    }
    no_zone_.push_back({.zone = static_cast<std::uint32_t>(found - scene.zones.begin())});
  }
}

bool Expectations::all_seen(const Monitor& monitor) {
  for (std::uint32_t i = 0; i < scene_.objects.size() && !all_seen_; ++i) {
    if (!scene_.objects[i].fixed && monitor.input_age(i).age_ns < 0) return false;
  }
  return all_seen_ = true;
}

std::vector<std::string> Expectations::check(const Report& report, const Monitor& monitor,
                                             bool judge) {
  std::vector<std::string> broken;
  if (!all_seen(monitor) || !judge) return broken;
  judged_ = true;
  if (const auto what = check_distance(report, monitor)) broken.push_back(*what);
  for (NoZone& expected : no_zone_) {
    const ZoneReport& zone = report.zones[expected.zone];
    if (expected.broken || !zone.active) continue;
    expected.broken = true;
    broken.push_back(entered(scene_, expected.zone, zone));
  }
  return broken;
}

std::optional<std::string> Expectations::check_distance(const Report& report,
                                                        const Monitor& monitor) {
  if (!min_distance_ || distance_broken_) return std::nullopt;
  if (report.lower_all >= *min_distance_) return check_passages(report, monitor);
  distance_broken_ = true;
  std::uint32_t nearest = 0;
  for (std::uint32_t p = 1; p < scene_.pairs.size(); ++p) {
    if (monitor.pair(p).lower < monitor.pair(nearest).lower) nearest = p;
  }
  const PairReport pair = monitor.pair(nearest);
  const std::string who = pair_name(scene_, nearest);
  const std::string expected = metres(*min_distance_) + " expected";
  if (pair.upper < *min_distance_) {
    return who + " is " + metres(pair.distance) + " apart, at least " + expected;
  }
  return who + " is not proved to be " + metres(*min_distance_) + " apart: " + name(pair.status) +
         ", lower bound " + metres(pair.lower) + ", at least " + expected;
}

// Nothing is too near now; was something since the last tick?
std::optional<std::string> Expectations::check_passages(const Report& report,
                                                        const Monitor& monitor) {
  if (report.swept_lower_all >= *min_distance_) return std::nullopt;
  for (std::uint32_t p = 0; p < scene_.pairs.size(); ++p) {
    const SweptBounds found = monitor.sweep(p, *min_distance_);
    if (found.lower >= *min_distance_) continue;
    distance_broken_ = true;
    const std::string who = pair_name(scene_, p);
    const std::string expected = ", at least " + metres(*min_distance_) + " expected";
    if (found.upper < *min_distance_) {
      return who + " was no more than " + metres(found.upper) +
             " apart between this tick and the last" + expected;
    }
    return who + " is not proved to have been " + metres(*min_distance_) +
           " apart between this tick and the last: lower bound " + metres(found.lower) + expected;
  }
  return std::nullopt;
}

std::optional<std::string> Expectations::never_judged(const Monitor& monitor) const {
  if (judged_ || (!min_distance_ && no_zone_.empty())) return std::nullopt;
  if (all_seen_) return "no tick could be judged";
  std::vector<std::string> unseen;
  for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
    if (!scene_.objects[i].fixed && monitor.input_age(i).age_ns < 0) {
      unseen.push_back(scene_.objects[i].name);
    }
  }
  return "no tick could be judged: the recording never gives a usable pose of " + one_of(unseen);
}

}  // namespace clearance
