// Judges one tick. The bound over all pairs decides where an expectation is about all of them,
// which takes one comparison. Single pairs are searched only to name the one that broke it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "monitor/interface/pair_name.hpp"
#include "monitor/pairs/pair_bounds.hpp"
#include "monitor/replay/expectations.hpp"
#include "monitor/replay/metres.hpp"

namespace clearance {
namespace {

bool may_touch(const Report& report, std::uint32_t pair) {
  const auto found = std::ranges::lower_bound(report.contacts, pair, {}, &ContactReport::pair);
  return found != report.contacts.end() && found->pair == pair &&
         found->status == ContactStatus::kAllowed;
}

// Whether a pair counts for an expected distance.
bool counts(const PairReport& pair, const Report& report) {
  return pair.status != PairStatus::kAbsent && !may_touch(report, pair.pair);
}

}  // namespace

// Queries a pair only where it may be the nearest so far; a zone reports its own clearance.
void Expectations::note_least(Expectation& expectation, const Tick& tick) const {
  const auto note = [&](double least, std::string text) {
    expectation.least = least;
    expectation.outcome.least = std::move(text);
    expectation.outcome.cycle = tick.report.cycle;
    expectation.outcome.now_ns = tick.report.now_ns;
  };
  const auto is_open = [&](std::uint32_t pair) {
    return has_awaited_object(pair) || has_late_object(pair);
  };
  if (!expectation.distance) {
    if (!expectation.index) return;
    const ZoneReport& zone = tick.report.zones[*expectation.index];
    const bool is_pair = zone.pair < scene_->pairs.size() && !is_open(zone.pair);
    if (is_pair && std::isfinite(zone.clearance) && zone.clearance < expectation.least)
      note(zone.clearance,
           fmt::format("{} has a clearance of {} (its lower bound less both margins)",
                       pair_name(*scene_, zone.pair), metres(zone.clearance)));
    return;
  }
  if (expectation.all_pairs && tick.report.lower_all >= expectation.least) return;
  for (const std::uint32_t p : expectation.pairs) {
    const PairReport pair = tick.monitor.pair_at_least(p, expectation.least);
    if (!is_known(pair.status) || !(pair.upper < expectation.least) || is_open(p) ||
        !counts(pair, tick.report))
      continue;
    note(pair.upper, fmt::format("{} is {} apart (bounds {} to {})", pair_name(*scene_, p),
                                 metres(pair.distance), metres(pair.lower), metres(pair.upper)));
  }
}

Expectations::Found Expectations::found(const Expectation& expectation, const Tick& tick) const {
  if (is_late(expectation) || is_awaited(expectation)) {
    if (Found certain = found_certain(expectation, tick)) return certain;
  }
  return expectation.distance ? too_near(expectation, tick) : entered(expectation, tick);
}

Expectations::Found Expectations::found_certain(const Expectation& expectation,
                                                const Tick& tick) const {
  return expectation.distance ? certainly_near(expectation, tick)
                              : entered_by_pair(expectation, tick, true);
}

// A zone is active by the distance now, or by what may have happened between two ticks.
Expectations::Found Expectations::entered(const Expectation& expectation, const Tick& tick) const {
  if (!expectation.index || !tick.report.zones[*expectation.index].active) return std::nullopt;
  if (is_awaited(expectation)) return entered_by_pair(expectation, tick, false);
  const Zone& zone = scene_->zones[*expectation.index];
  const ZoneReport& in_tick = tick.report.zones[*expectation.index];
  const bool between =
      in_tick.clearance >= zone.enter_below && in_tick.swept_clearance < zone.enter_below;
  const std::string what =
      between ? fmt::format(" was between two ticks not certified to have more clearance than {}",
                            metres(in_tick.swept_clearance))
              : fmt::format(" has a clearance of {}", metres(in_tick.clearance));
  return Finding{fmt::format("zone '{}' is active: {}{} (its lower bound less both margins)",
                             zone.name, pair_name(*scene_, in_tick.pair), what),
                 !is_late(expectation) && (in_tick.pair >= scene_->pairs.size() ||
                                           is_known(tick.monitor.pair(in_tick.pair).status))};
}

// The threshold of a zone with `separation` is the tick's. The pair that the tick names may have a
// late object and hide another one that is too near.
Expectations::Found Expectations::entered_by_pair(const Expectation& expectation, const Tick& tick,
                                                  bool certain) const {
  if (!expectation.index || !tick.report.zones[*expectation.index].active) return std::nullopt;
  const Zone& zone = scene_->zones[*expectation.index];
  if (zone.separation) {
    for (const PairSeparation& pair : tick.report.separated_pairs) {
      if (pair.zone != *expectation.index || has_awaited_object(pair.pair) ||
          may_touch(tick.report, pair.pair) || !(pair.remaining < 0.0))
        continue;
      if (certain && (has_late_object(pair.pair) || !is_known(tick.monitor.pair(pair.pair).status)))
        continue;
      return Finding{fmt::format("zone '{}' is active: {} has a clearance of {}, less than its "
                                 "protective separation distance",
                                 zone.name, pair_name(*scene_, pair.pair), metres(pair.clearance)),
                     certain};
    }
    return std::nullopt;
  }
  for (const std::uint32_t p : expectation.pairs) {
    const PairReport pair = tick.monitor.pair(p);
    const ObjectPair& objects = scene_->pairs[p];
    const double margins =
        scene_->objects[objects.first].margin + scene_->objects[objects.second].margin;
    const bool awaited = has_awaited_object(p);
    const bool by_upper = certain && (awaited || has_late_object(p));
    const double decides = by_upper ? pair.upper : std::min(pair.lower, pair.swept_lower);
    const bool is_open = certain ? !is_known(pair.status) : awaited;
    if (!counts(pair, tick.report) || is_open || !(decides - margins < zone.enter_below)) continue;
    return Finding{
        fmt::format(
            "zone '{}' is active: {} has a clearance of {} (its {} bound less both margins)",
            zone.name, pair_name(*scene_, p), metres(decides - margins),
            by_upper ? "upper" : "lower"),
        certain};
  }
  return std::nullopt;
}

Expectations::Found Expectations::certainly_near(const Expectation& expectation,
                                                 const Tick& tick) const {
  if (!expectation.distance) return std::nullopt;
  const double expected = expectation.distance->metres;
  for (const std::uint32_t p : expectation.pairs) {
    const PairReport pair = tick.monitor.pair(p);
    if (!is_known(pair.status) || !(pair.upper < expected) || !counts(pair, tick.report)) continue;
    return Finding{fmt::format("{} is {} apart, at least {} expected", pair_name(*scene_, p),
                               metres(pair.distance), metres(expected))};
  }
  return std::nullopt;
}

// The bound over all pairs decides; only where it fails is a pair looked for to name it. Pairs with
// late objects come last: a pair without one decides for certain.
Expectations::Found Expectations::too_near(const Expectation& expectation, const Tick& tick) const {
  const double expected = expectation.distance->metres;
  if (expectation.all_pairs && tick.report.lower_all >= expected)
    return swept_too_near(expectation, tick);
  std::optional<PairReport> nearest;
  bool is_certain = false;
  for (const std::uint32_t p : expectation.pairs) {
    // Bounds that only certify the minimum may be lower than needed here.
    const PairReport pair = tick.monitor.pair_at_least(p, expected);
    if (!(pair.lower < expected) || !counts(pair, tick.report) || has_awaited_object(p)) continue;
    const bool certain = is_known(pair.status) && !has_late_object(p);
    if (!nearest || certain > is_certain ||
        (certain == is_certain && pair.lower < nearest->lower)) {
      nearest = pair;
      is_certain = certain;
    }
  }
  if (!nearest) return swept_too_near(expectation, tick);
  const std::string who = pair_name(*scene_, nearest->pair);
  if (nearest->upper < expected) {
    return Finding{fmt::format("{} is {} apart, at least {} expected", who,
                               metres(nearest->distance), metres(expected))};
  }
  return Finding{fmt::format("{} is not certified to be {} apart: {}, lower bound {}, at least {} "
                             "expected",
                             who, metres(expected), name(nearest->status), metres(nearest->lower),
                             metres(expected)),
                 is_certain};
}

// No pair is too near now, but one may have been since the last tick.
Expectations::Found Expectations::swept_too_near(const Expectation& expectation,
                                                 const Tick& tick) const {
  const double expected = expectation.distance->metres;
  if (expectation.all_pairs && tick.report.swept_lower_all >= expected) return std::nullopt;
  Found doubtful;
  for (const std::uint32_t p : expectation.pairs) {
    const PairReport pair = tick.monitor.pair(p);
    if (pair.swept_lower >= expected || !counts(pair, tick.report) || has_awaited_object(p))
      continue;
    // More expensive than the tick's own bound, hence only where that one does not suffice.
    const SweptBounds swept = tick.monitor.sweep(p, expected);
    if (swept.lower >= expected) continue;
    const std::string who = pair_name(*scene_, p);
    const bool late = has_late_object(p);
    if (swept.upper < expected && !late) {
      return Finding{fmt::format(
          "{} was no more than {} apart between this tick and the last, at least {} expected", who,
          metres(swept.upper), metres(expected))};
    }
    Finding finding{fmt::format("{} is not certified to have been {} apart between this tick and "
                                "the last: lower bound {}, at least {} expected",
                                who, metres(expected), metres(swept.lower), metres(expected)),
                    !late};
    if (!late) return finding;
    if (!doubtful) doubtful = std::move(finding);
  }
  return doubtful;
}

}  // namespace clearance
