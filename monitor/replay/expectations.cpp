// Counts the ticks in which an expectation is judged, and how many of them are doubtful.
#include "monitor/replay/expectations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

#include "config/scene/pairs_between.hpp"
#include "config/text/sentences.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/pairs/kept_near.hpp"
#include "monitor/replay/metres.hpp"

namespace clearance {
namespace {

// Of an object that is awaited, before the first tick of its scene.
constexpr std::int64_t kNotYet = std::numeric_limits<std::int64_t>::max();
// A recording ends at most this long after the driver of a robot, ns.
constexpr std::int64_t kMostLateEnd = 1'000'000'000;

std::optional<std::uint32_t> zone_index(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.zones, name, &Zone::name);
  if (found == scene.zones.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - scene.zones.begin());
}

std::string subject_of(const std::optional<ExpectedDistance>& distance, const std::string& zone) {
  if (!distance) return fmt::format("zone '{}'", zone);
  if (distance->a.empty()) return fmt::format("at least {}", metres(distance->metres));
  return fmt::format("at least {} of {}", metres(distance->metres),
                     distance->b.empty() ? fmt::format("zone '{}'", distance->a)
                                         : distance->a + " - " + distance->b);
}

}  // namespace

// A name that does not exist is an error: an expectation about it could never fail.
Expectations::Expectations(const Scene& scene, const Expected& expected)
    : scene_(&scene),
      allow_unknown_(expected.allow_unknown),
      awaited_ns_(scene.objects.size(), kNotYet) {
  for (const ExpectedDistance& distance : expected.distances)
    expectations_.emplace_back().distance = distance;
  for (const std::string& name : expected.no_zone) expectations_.emplace_back().zone = name;
  for (Expectation& expectation : expectations_) {
    rest_on(expectation);
    expectation.outcome.expectation = subject_of(expectation.distance, expectation.zone);
    if (error_.empty()) error_ = unknown_name(expectation);
  }
}

void Expectations::rest_on(Expectation& expectation) {
  const bool is_zone = !expectation.distance;
  expectation.index = is_zone ? zone_index(*scene_, expectation.zone) : std::nullopt;
  expectation.all_pairs = !is_zone && expectation.distance->a.empty();
  if (is_zone) {
    expectation.pairs = pairs_between(*scene_, expectation.zone, "");
  } else if (expectation.all_pairs) {
    const double metres = expectation.distance->metres;
    const std::vector<std::uint32_t> kept = kept_nearer(*scene_, metres);
    expectation.pairs.resize(scene_->pairs.size());
    std::iota(expectation.pairs.begin(), expectation.pairs.end(), 0u);
    std::erase_if(expectation.pairs,
                  [&](std::uint32_t pair) { return std::ranges::binary_search(kept, pair); });
    if (!kept.empty()) {
      std::string note = kept_nearer_text(*scene_, metres, kept);
      if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(std::move(note));
    }
  } else {
    expectation.pairs = pairs_between(*scene_, expectation.distance->a, expectation.distance->b);
  }
  std::vector<bool> is_part(scene_->objects.size(), false);
  for (const std::uint32_t p : expectation.pairs)
    is_part[scene_->pairs[p].first] = is_part[scene_->pairs[p].second] = true;
  expectation.objects.clear();
  for (std::uint32_t i = 0; i < is_part.size(); ++i) {
    if (is_part[i] && !scene_->objects[i].fixed) expectation.objects.push_back(i);
  }
}

std::string Expectations::unknown_name(const Expectation& expectation) const {
  if (!expectation.distance) {
    if (expectation.index) return {};
    return why_no_pairs_between(*scene_, expectation.zone, "");
  }
  if (!expectation.pairs.empty()) return {};
  if (expectation.all_pairs)
    return "no pair is left to expect a distance of; expected a smaller distance, or pairs of two "
           "objects or groups (--between)";
  return why_no_pairs_between(*scene_, expectation.distance->a, expectation.distance->b);
}

void Expectations::change(const Scene& scene) {
  std::map<std::string_view, std::optional<std::int64_t>> before;
  for (std::size_t i = 0; i < awaited_ns_.size(); ++i)
    before.emplace(scene_->objects[i].name, awaited_ns_[i]);
  awaited_ns_.clear();
  for (const Object& object : scene.objects) {
    const auto known = before.find(object.name);
    awaited_ns_.push_back(known == before.end() ? kNotYet : known->second);
  }
  scene_ = &scene;
  late_.clear();
  for (Expectation& expectation : expectations_) {
    end_lateness(expectation, " (an object was late then; the cell has changed since)");
    rest_on(expectation);
  }
}

// An object that is contradicted is not late: something of it was heard. One that a change has made
// unknown is not late either: no driver has ended.
void Expectations::note_late(const Report& report, const Monitor& monitor) {
  late_.resize(scene_->objects.size());
  lost_.resize(scene_->objects.size());
  refused_ = std::accumulate(report.rejected.begin(), report.rejected.end(), std::uint64_t{0});
  for (std::uint32_t i = 0; i < scene_->objects.size(); ++i) {
    const InputAge input = monitor.input_age(i);
    const bool is_there = scene_->objects[i].fixed || input.absent;
    const bool is_on_time = !input.stale || input.contradicted;
    auto& awaited_ns = awaited_ns_[i];
    if (awaited_ns) awaited_ns = std::min(*awaited_ns, report.now_ns);
    if (is_there || (input.age_ns >= 0 && is_on_time)) awaited_ns.reset();
    lost_[i] = !is_there && !awaited_ns && input.age_ns < 0;
    if (is_there || is_on_time || lost_[i] || awaited_ns) {
      late_[i].reset();
    } else if (!late_[i]) {
      late_[i] = Lateness{report.now_ns, refused_};
    }
  }
}

// Before every moving object is known, distances are unknown and zones active by definition.
bool Expectations::begins(const Expectation& expectation, const Monitor& monitor) const {
  return std::ranges::all_of(expectation.objects, [&](std::uint32_t object) {
    const InputAge input = monitor.input_age(object);
    return input.absent || (input.age_ns >= 0 && !late_[object] && !awaited_ns_[object]);
  });
}

bool Expectations::is_awaited(const Expectation& expectation) const {
  return std::ranges::any_of(expectation.objects,
                             [&](std::uint32_t object) { return awaited_ns_[object].has_value(); });
}

bool Expectations::has_awaited_object(std::uint32_t pair) const {
  const ObjectPair& objects = scene_->pairs[pair];
  return awaited_ns_[objects.first] || awaited_ns_[objects.second];
}

bool Expectations::is_late(const Expectation& expectation) const {
  return std::ranges::any_of(expectation.objects,
                             [&](std::uint32_t object) { return late_[object].has_value(); });
}

bool Expectations::has_late_object(std::uint32_t pair) const {
  const ObjectPair& objects = scene_->pairs[pair];
  return late_[objects.first] || late_[objects.second];
}

std::optional<std::uint32_t> Expectations::longest_late(
    const std::vector<std::uint32_t>& objects) const {
  std::optional<std::uint32_t> longest;
  for (const std::uint32_t object : objects) {
    if (object >= late_.size() || !late_[object]) return std::nullopt;
    if (!longest || late_[object]->since_ns < late_[*longest]->since_ns) longest = object;
  }
  return longest;
}

std::vector<Expectations::Broken> Expectations::check(const Report& report, const Monitor& monitor,
                                                      bool judge) {
  if (!first_ns_) first_ns_ = report.now_ns;
  note_late(report, monitor);
  std::vector<Broken> broken;
  for (Expectation& expectation : expectations_) {
    if (!expectation.begun && begins(expectation, monitor)) {
      expectation.begun = true;
      expectation.begun_after_ns = report.now_ns - *first_ns_;
    }
    if (!expectation.late_then.empty() && !longest_late(expectation.late_then))
      end_lateness(expectation, "");
    if (!judge) continue;
    note_least(expectation, {report, monitor});
    if (expectation.broken) continue;
    if (!expectation.begun) ++expectation.before;
    if (expectation.begun) ++expectation.judged;
    const bool late = is_late(expectation);
    expectation.judged_on_time |= expectation.begun && !late;
    Found why = expectation.begun ? found(expectation, {report, monitor})
                                  : found_certain(expectation, {report, monitor});
    if (!why) continue;
    Broken what{report.cycle, report.now_ns, std::move(why->what), expectation.outcome.expectation};
    if (!why->certain) {
      doubt(expectation, std::move(what));
      continue;
    }
    expectation.broken = true;
    broken.push_back(std::move(what));
  }
  return broken;
}

void Expectations::doubt(Expectation& expectation, Broken broken) const {
  std::vector<std::uint32_t> late;
  std::ranges::copy_if(expectation.objects, std::back_inserter(late),
                       [&](std::uint32_t object) { return late_[object].has_value(); });
  const bool is_lost =
      std::ranges::any_of(expectation.objects, [&](std::uint32_t object) { return lost_[object]; });
  if (late.empty() || is_lost) {
    if (!expectation.first_doubt) expectation.first_doubt = std::move(broken);
    ++expectation.doubtful;
    return;
  }
  if (expectation.late_then.empty()) {
    expectation.late_then = std::move(late);
    expectation.first_late_doubt = std::move(broken);
  }
  ++expectation.late_doubts;
}

// What was doubtful while objects were late counts.
void Expectations::end_lateness(Expectation& expectation, const std::string& why) const {
  if (expectation.first_late_doubt && !expectation.first_doubt) {
    expectation.first_doubt = std::move(expectation.first_late_doubt);
    expectation.first_doubt->what += why;
  }
  expectation.doubtful += std::exchange(expectation.late_doubts, 0);
  expectation.first_late_doubt.reset();
  expectation.late_then.clear();
}

// A driver that still sends has not ended, though its samples are refused.
void Expectations::finish_lateness(Expectation& expectation, std::int64_t last_ns) {
  if (expectation.late_then.empty()) return;
  const auto object = longest_late(expectation.late_then);
  if (!object) {
    end_lateness(expectation, "");
    return;
  }
  const std::int64_t late_ns = last_ns - late_[*object]->since_ns;
  const std::string silence = fmt::format("'{}' was late for the last {:.3f} s of the recording",
                                          scene_->objects[*object].name, seconds(late_ns));
  if (late_ns > kMostLateEnd || !expectation.judged_on_time ||
      refused_ != late_[*object]->refused) {
    end_lateness(expectation, fmt::format(" ({}; --end judges what is before)", silence));
    return;
  }
  expectation.judged -= expectation.late_doubts;
  const std::string note =
      silence + ", in which its pairs were not judged unless they were certainly too near";
  if (std::ranges::count(notes_, note) == 0) notes_.push_back(note);
}

std::vector<Expectations::Broken> Expectations::finish(const Monitor& monitor,
                                                       std::int64_t last_ns) {
  std::vector<Broken> broken;
  for (Expectation& expectation : expectations_) {
    if (expectation.broken) continue;
    finish_lateness(expectation, last_ns);
    const auto allowed = allow_unknown_ * static_cast<double>(expectation.judged);
    const std::string& subject = expectation.outcome.expectation;
    const std::size_t before = broken.size();
    if (static_cast<double>(expectation.doubtful) > allowed) {
      Broken& what = broken.emplace_back(std::move(*expectation.first_doubt));
      what.what += fmt::format("; so in {} of {} judged", expectation.doubtful,
                               counted(expectation.judged, "tick"));
    } else if (expectation.judged == 0) {
      std::vector<std::string> never;
      bool is_seen = false;
      for (const std::uint32_t i : expectation.objects) {
        if (monitor.input_age(i).age_ns >= 0) continue;
        never.push_back(scene_->objects[i].name);
        is_seen = is_seen || scene_->objects[i].is_seen();
      }
      broken.push_back({0, last_ns,
                        never.empty() ? fmt::format("{}: no tick could be judged", subject)
                                      : fmt::format("{}: no tick could be judged, since the "
                                                    "recording never tells {} {}{}",
                                                    subject, is_seen ? "what is seen by" : "where",
                                                    one_of(never), is_seen ? "" : " is")});
    } else if (auto awaited = never_known(expectation, last_ns)) {
      broken.push_back(*std::move(awaited));
    } else {
      note_ticks(expectation);
    }
    if (broken.size() > before) broken.back().expectation = subject;
  }
  return broken;
}

std::optional<Expectations::Broken> Expectations::never_known(const Expectation& expectation,
                                                              std::int64_t last_ns) {
  for (const std::uint32_t i : expectation.objects) {
    if (!awaited_ns_[i]) continue;
    const std::int64_t awaited_ns = last_ns - *awaited_ns_[i];
    std::string what = fmt::format(
        "{}: the pairs of '{}' could not be judged, since a change brought it {:.3f} s before the "
        "end and the recording does not tell where it is",
        expectation.outcome.expectation, scene_->objects[i].name, seconds(awaited_ns));
    if (awaited_ns > kMostLateEnd) return Broken{0, last_ns, std::move(what)};
    notes_.push_back(std::move(what));
  }
  return std::nullopt;
}

void Expectations::note_ticks(const Expectation& expectation) {
  const std::string& subject = expectation.outcome.expectation;
  const std::uint64_t ticks = expectation.judged + expectation.before;
  if (expectation.before > 0) {
    notes_.push_back(fmt::format(
        "{}: not judged in the first {} of {} ({:.3f} s), before all of its objects were known and "
        "on time",
        subject, expectation.before, counted(ticks, "tick"), seconds(expectation.begun_after_ns)));
  }
  if (expectation.doubtful > 0) {
    notes_.push_back(fmt::format("{}: unknown in {} of {} judged, as allowed", subject,
                                 expectation.doubtful, counted(expectation.judged, "tick")));
  }
}

std::vector<Expectations::Outcome> Expectations::outcomes() const {
  std::vector<Outcome> all;
  for (const Expectation& expectation : expectations_) all.push_back(expectation.outcome);
  return all;
}

std::uint64_t Expectations::not_judged() const noexcept {
  std::uint64_t most = 0;
  for (const Expectation& expectation : expectations_)
    most = std::max(most, expectation.before + expectation.late_doubts);
  return most;
}

}  // namespace clearance
