// Judges the bound over all pairs, which takes one comparison a tick. Single pairs are searched
// only to name the one that broke an expectation.
#include "monitor/replay/expectations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "config/text/sentences.hpp"
#include "monitor/pair_name.hpp"
#include "monitor/pairs/pair_bounds.hpp"
#include "monitor/replay/metres.hpp"

namespace clearance {
namespace {

// For a message about a zone that does not exist.
std::string zone_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Zone& zone : scene.zones) names.push_back(zone.name);
  return names.empty() ? "it has none" : fmt::format("its zones are {}", one_of(names));
}

// A recording ends at most this long after the driver of a robot, ns.
constexpr std::int64_t kMostLateEnd = 1'000'000'000;

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
  if (min_distance) expectations_.push_back({});
  for (const std::string& name : no_zone) {
    expectations_.push_back({.zone = name, .index = zone(name)});
    if (expectations_.back().index) continue;
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
  all_known_ = any_late_ = false;
  late_.clear();
  for (Expectation& expected : expectations_) {
    expected.index = zone(expected.zone);
    expected.late_then.clear();
  }
}

// Before every moving object is known, distances are unknown and zones active by definition.
bool Expectations::all_seen(const Monitor& monitor) {
  for (std::uint32_t i = 0; i < scene_->objects.size() && !all_known_; ++i) {
    if (!scene_->objects[i].fixed && monitor.input_age(i).age_ns < 0) return false;
  }
  return all_known_ = true;
}

// An object that is contradicted is not late: something of it was heard.
void Expectations::note_late(const Report& report, const Monitor& monitor) {
  any_late_ = false;
  late_.resize(scene_->objects.size());
  refused_ = std::accumulate(report.rejected.begin(), report.rejected.end(), std::uint64_t{0});
  for (std::uint32_t i = 0; i < scene_->objects.size(); ++i) {
    const InputAge input = monitor.input_age(i);
    if (scene_->objects[i].fixed || !input.stale || input.contradicted) {
      late_[i].reset();
      continue;
    }
    any_late_ = true;
    if (!late_[i]) late_[i] = Lateness{report.now_ns, refused_};
  }
}

bool Expectations::has_late_object(std::uint32_t pair) const {
  const ObjectPair& objects = scene_->pairs[pair];
  return late_[objects.first] || late_[objects.second];
}

std::optional<std::uint32_t> Expectations::longest_late(
    const std::vector<std::uint32_t>& objects) const {
  std::optional<std::uint32_t> longest;
  for (const std::uint32_t object : objects) {
    if (!late_[object]) return std::nullopt;
    if (!longest || late_[object]->since_ns < late_[*longest]->since_ns) longest = object;
  }
  return longest;
}

std::vector<Expectations::Broken> Expectations::check(const Report& report, const Monitor& monitor,
                                                      bool judge) {
  const bool known = all_seen(monitor);
  if (known) note_late(report, monitor);
  const bool late = known && any_late_;
  judged_ |= judge && known;
  judged_on_time_ |= judge && known && !late;
  std::vector<Broken> broken;
  for (Expectation& expected : expectations_) {
    if (expected.broken) continue;
    const auto tell = [&](Broken what) {
      expected.broken = true;
      broken.push_back(std::move(what));
    };
    const auto found = [&](Sentence& what) {
      return Broken{report.cycle, report.now_ns, std::move(*what)};
    };
    if (known && expected.while_late && !longest_late(expected.late_then)) {
      tell(std::move(*expected.while_late));
    } else if (!judge) {
      continue;
    } else if (!known) {
      if (Sentence near = certainly_near(report, monitor); near && expected.zone.empty())
        tell(found(near));
    } else if (!late) {
      if (Sentence what = broken_by(expected, report, monitor)) tell(found(what));
    } else if (Sentence surely = surely_broken_by(expected, report, monitor)) {
      tell(found(surely));
    } else if (!expected.while_late) {
      if (Sentence what = broken_by(expected, report, monitor)) {
        expected.while_late = found(what);
        for (std::uint32_t i = 0; i < late_.size(); ++i) {
          if (late_[i]) expected.late_then.push_back(i);
        }
      }
    }
  }
  return broken;
}

// A driver that still sends has not ended, though its samples are refused.
std::vector<Expectations::Broken> Expectations::finish(std::int64_t last_ns, std::string& note) {
  std::vector<Broken> broken;
  for (Expectation& expected : expectations_) {
    if (expected.broken || !expected.while_late) continue;
    Broken& what = broken.emplace_back(std::move(*expected.while_late));
    const auto object = all_known_ ? longest_late(expected.late_then) : std::nullopt;
    if (!object) {
      what.what += " (an object was late then; the cell has changed since)";
      continue;
    }
    const std::int64_t late_ns = last_ns - late_[*object]->since_ns;
    const std::string silence =
        fmt::format("'{}' was late for the last {:.3f} s of the recording",
                    scene_->objects[*object].name, static_cast<double>(late_ns) * 1e-9);
    if (late_ns <= kMostLateEnd && judged_on_time_ && refused_ == late_[*object]->refused) {
      note = silence + ", in which its pairs were not judged unless they were certainly too near";
      broken.pop_back();
    } else {
      what.what += fmt::format(" ({}; --end judges what is before)", silence);
    }
  }
  return broken;
}

Expectations::Sentence Expectations::broken_by(const Expectation& expected, const Report& report,
                                               const Monitor& monitor) const {
  if (expected.zone.empty()) return check_distance(report, monitor, true);
  if (!expected.index || !report.zones[*expected.index].active) return std::nullopt;
  return entered(*scene_, *expected.index, report.zones[*expected.index]);
}

Expectations::Sentence Expectations::surely_broken_by(const Expectation& expected,
                                                      const Report& report,
                                                      const Monitor& monitor) const {
  if (!expected.zone.empty())
    return expected.index ? entered_surely(*expected.index, report, monitor) : std::nullopt;
  if (Sentence near = certainly_near(report, monitor)) return near;
  return check_distance(report, monitor, false);
}

// The threshold of a zone with `separation` is the tick's. The pair that the tick names may have a
// late object and hide another one that is too near.
Expectations::Sentence Expectations::entered_surely(std::uint32_t id, const Report& report,
                                                    const Monitor& monitor) const {
  const Zone& zone = scene_->zones[id];
  const ZoneReport& in_tick = report.zones[id];
  if (zone.separation) {
    if (!in_tick.active) return std::nullopt;
    if (!has_late_object(in_tick.pair)) return entered(*scene_, id, in_tick);
    for (const PairSeparation& pair : report.separated_pairs) {
      if (pair.zone != id || has_late_object(pair.pair) || may_touch(report, pair.pair) ||
          !(pair.remaining < 0.0))
        continue;
      return fmt::format(
          "zone '{}' is active: {} has a clearance of {}, less than its protective separation "
          "distance",
          zone.name, pair_name(*scene_, pair.pair), metres(pair.clearance));
    }
    return std::nullopt;
  }
  for (const std::uint32_t p : zone.pairs) {
    const PairReport pair = monitor.pair(p);
    const ObjectPair& objects = scene_->pairs[p];
    const double margins =
        scene_->objects[objects.first].margin + scene_->objects[objects.second].margin;
    const bool late = has_late_object(p);
    const double decides = late ? pair.upper : std::min(pair.lower, pair.swept_lower);
    if (may_touch(report, p) || (late && !is_known(pair.status)) ||
        !(decides - margins < zone.enter_below))
      continue;
    return fmt::format(
        "zone '{}' is active: {} has a clearance of {} (its {} bound less both "
        "margins)",
        zone.name, pair_name(*scene_, p), metres(decides - margins), late ? "upper" : "lower");
  }
  return std::nullopt;
}

Expectations::Sentence Expectations::certainly_near(const Report& report,
                                                    const Monitor& monitor) const {
  if (!min_distance_) return std::nullopt;
  for (std::uint32_t p = 0; p < scene_->pairs.size(); ++p) {
    const PairReport pair = monitor.pair(p);
    if (!is_known(pair.status) || !(pair.upper < *min_distance_) || may_touch(report, p)) continue;
    return fmt::format("{} is {} apart, at least {} expected", pair_name(*scene_, p),
                       metres(pair.distance), metres(*min_distance_));
  }
  return std::nullopt;
}

// The bound over all pairs decides; only where it fails is a pair looked for to name it.
Expectations::Sentence Expectations::check_distance(const Report& report, const Monitor& monitor,
                                                    bool late_too) const {
  if (report.lower_all >= *min_distance_) return check_sweep(report, monitor, late_too);
  std::optional<std::uint32_t> nearest;
  for (std::uint32_t p = 0; p < scene_->pairs.size(); ++p) {
    if (may_touch(report, p) || (!late_too && has_late_object(p))) continue;
    if (!nearest || monitor.pair(p).lower < monitor.pair(*nearest).lower) nearest = p;
  }
  if (!nearest || monitor.pair(*nearest).lower >= *min_distance_)
    return check_sweep(report, monitor, late_too);
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
Expectations::Sentence Expectations::check_sweep(const Report& report, const Monitor& monitor,
                                                 bool late_too) const {
  if (report.swept_lower_all >= *min_distance_) return std::nullopt;
  for (std::uint32_t p = 0; p < scene_->pairs.size(); ++p) {
    if (may_touch(report, p) || (!late_too && has_late_object(p))) continue;
    // More expensive than the tick's own bound, hence only where that one does not suffice.
    const SweptBounds found = monitor.sweep(p, *min_distance_);
    if (found.lower >= *min_distance_) continue;
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
  if (judged_ || expectations_.empty()) return std::nullopt;
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
