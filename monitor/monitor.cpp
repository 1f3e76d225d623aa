#include "monitor/monitor.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "monitor/geometry/bounding_sphere.hpp"
#include "monitor/geometry/posed_part.hpp"
#include "monitor/motion/directed_rounding.hpp"
#include "monitor/objects/input_summary.hpp"
#include "monitor/objects/tracked_object.hpp"
#include "monitor/pairs/global_minimum.hpp"
#include "monitor/pairs/pair_bounds.hpp"
#include "monitor/pairs/pair_table.hpp"
#include "monitor/pairs/worker_pool.hpp"
#include "monitor/schedule/scheduler.hpp"
#include "monitor/zones/zones.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kNoLimit = std::numeric_limits<std::uint32_t>::max();  // of queries

}  // namespace

struct Monitor::State {
  const Scene& scene;
  std::vector<TrackedObject> objects;
  std::vector<PosedPart> parts;
  std::vector<std::uint32_t> first_part;  // object i: parts first_part[i] .. first_part[i + 1]
  std::vector<std::uint32_t> moving;      // objects that are not fixed
  std::vector<std::uint32_t> changed;     // objects of which this tick knows something else
  InputSummary inputs;                    // of this tick
  PairTable table;
  WorkerPool pool;
  Scheduler triage;
  Zones zones;
  GlobalMinimum closest;  // of this tick
  Report report;

  State(const Scene& the_scene, const MonitorOptions& options);

  void begin(std::int64_t now_ns) noexcept;
  void take_in(std::span<const PoseSample> samples) noexcept;
  void move() noexcept;
  void report_pairs() noexcept;
  void report_counts() noexcept;
  void report_whole() noexcept;
  void count_in(std::uint32_t pair, const PairBounds& state) noexcept;

  void refuse(std::uint32_t object, Reject cause) noexcept;
  [[nodiscard]] PairReport report_pair(std::uint32_t pair) const noexcept;
  void write_report(std::uint32_t pair, const PairBounds& state,
                    PairReport& written) const noexcept;
  [[nodiscard]] PairBounds summary(std::uint32_t pair, bool published) const noexcept;
  [[nodiscard]] Clearance rest() const noexcept;
  [[nodiscard]] Clearance pending() const noexcept;
};

Monitor::Monitor(const Scene& scene, const MonitorOptions& options)
    : state_(std::make_unique<State>(scene, options)) {}
Monitor::~Monitor() = default;

const Report& Monitor::tick(std::span<const PoseSample> samples, std::int64_t now_ns) noexcept {
  State& s = *state_;
  s.begin(now_ns);
  s.take_in(samples);  // samples  -> objects: the pose in use of each
  s.move();            // objects  -> parts: where each is, how far it moved
  s.inputs = look_at_inputs(s.objects, s.moving, s.report);
  // parts    -> table: every bound true for these poses, or provably not worth a look
  s.zones.begin(s.report.zones);
  s.report.queries =
      s.triage.evaluate_due(s.objects, s.changed, s.parts, s.report.cycle, s.zones, s.table);
  s.report_pairs();  // table    -> report
  s.report_counts();
  s.report_whole();
  return s.report;
}

void Monitor::refuse(std::uint32_t object, Reject cause) noexcept { state_->refuse(object, cause); }

PairReport Monitor::pair(std::uint32_t pair) const noexcept { return state_->report_pair(pair); }

SweptBounds Monitor::passage(std::uint32_t pair, double level) const noexcept {
  State& s = *state_;
  const PairBounds known = s.summary(pair, s.scene.pairs[pair].publish);
  SweptBounds bounds{known.swept_lower, known.swept_upper};
  if (known.status == PairStatus::kUnknown || bounds.lower >= level) return bounds;
  Evaluation evaluation{s.objects, s.parts, s.report.cycle, s.table, kNoLimit};
  const SweptBounds found = passage_of(pair, level, evaluation);
  bounds.lower = std::min(known.lower, std::max(bounds.lower, found.lower));
  bounds.upper = std::min(bounds.upper, found.upper);
  return bounds;
}

InputAge Monitor::input_age(std::uint32_t object) const noexcept {
  const TrackedObject& state = state_->objects[object];
  return {.age_ns = state.age_ns, .stale = state.late};
}

const std::array<std::uint64_t, kRejects>& Monitor::rejected(std::uint32_t object) const noexcept {
  return state_->objects[object].rejected;
}

std::int64_t Monitor::stamp_ns(std::uint32_t object) const noexcept {
  return state_->objects[object].stamp_ns;
}

Monitor::State::State(const Scene& the_scene, const MonitorOptions& options)
    : scene(the_scene),
      parts(parts_of(the_scene)),
      first_part(the_scene.objects.size() + 1, 0),
      table(the_scene, parts),
      pool(options.workers, options.on_worker_start),
      triage(the_scene, parts, table, pool),
      zones(the_scene) {
  const std::vector<BoundingSphere> balls = bounding_spheres(scene.objects.size(), parts);
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    objects.push_back(initial_state(scene.objects[i]));
    objects[i].reach = balls[i].reach;
    if (!scene.objects[i].fixed) moving.push_back(i);
    first_part[i + 1] = first_part[i] + static_cast<std::uint32_t>(scene.objects[i].parts.size());
  }
  changed.reserve(objects.size());
  report.scene_revision = scene.revision;
  report.pairs_total = static_cast<std::uint32_t>(scene.pairs.size());
  report.now_ns = std::numeric_limits<std::int64_t>::min();
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    if (scene.pairs[p].publish) report.pairs.push_back(report_pair(p));
  }
  report.zones.resize(scene.zones.size());
  for (std::size_t z = 0; z < scene.zones.size(); ++z) {
    if (!scene.zones[z].pairs.empty()) report.zones[z].pair = scene.zones[z].pairs.front();
  }
}

void Monitor::State::begin(std::int64_t now_ns) noexcept {
  ++report.cycle;
  report.now_ns = std::max(report.now_ns, now_ns);
}

void Monitor::State::take_in(std::span<const PoseSample> samples) noexcept {
  for (const PoseSample& sample : samples) {
    if (sample.object >= objects.size() || scene.objects[sample.object].fixed) {
      refuse(sample.object, Reject::kUnknownObject);
      continue;
    }
    TrackedObject& object = objects[sample.object];
    const auto cause = refusal(sample, object, report.now_ns, scene.future_limit_ns);
    if (cause) {
      refuse(sample.object, *cause);
    } else {
      accept(scene.objects[sample.object], sample, object);
    }
  }
}

void Monitor::State::refuse(std::uint32_t object, Reject cause) noexcept {
  const auto index = static_cast<std::size_t>(cause);
  ++report.rejected[index];
  if (object < objects.size()) ++objects[object].rejected[index];
}

void Monitor::State::move() noexcept {
  changed.clear();
  if (report.cycle == 1) {
    for (std::uint32_t i = 0; i < objects.size(); ++i) changed.push_back(i);
  }
  // One loop for each step: no object has to wait for the roots and quotients of the one before.
  for (const std::uint32_t i : moving) {
    TrackedObject& object = objects[i];
    const bool was_late = object.late;
    const double might_have_moved = object.may_have_moved;
    advance(scene.objects[i], report.now_ns, object);
    const bool stirs =
        object.moved || object.late != was_late || object.may_have_moved != might_have_moved;
    if (stirs && report.cycle > 1) changed.push_back(i);
  }
  for (const std::uint32_t i : moving) travel(objects[i].reach, objects[i]);
  for (const std::uint32_t i : changed) {
    if (!objects[i].seen) continue;
    for (std::uint32_t part = first_part[i]; part < first_part[i + 1]; ++part) {
      place(objects[i], parts[part]);
    }
  }
}

// Every pair that was looked at is summed up once.
void Monitor::State::report_pairs() noexcept {
  closest = {};
  report.evaluated = 0;
  for (PairReport& published : report.pairs) {
    const std::uint32_t pair = published.pair;
    const PairBounds state = summary(pair, true);
    write_report(pair, state, published);
    if (table.entries[pair].carried_cycle == report.cycle) count_in(pair, state);
  }
  for (const std::uint32_t pair : triage.current()) {
    if (!scene.pairs[pair].publish) count_in(pair, summary(pair, false));
  }
}

void Monitor::State::count_in(std::uint32_t pair, const PairBounds& state) noexcept {
  closest.add(pair, state);
  zones.add(pair, state);
  report.evaluated += is_evaluated(state.status);
}

void Monitor::State::report_counts() noexcept {
  const auto known = static_cast<std::uint32_t>(triage.counts().known());
  const auto fresh = static_cast<std::uint32_t>(triage.counts().fresh());
  report.unknown = report.pairs_total - known;
  report.stale = known - fresh;
  report.carried = fresh - report.evaluated;
  report.oldest_evaluation_cycles = report.cycle - triage.oldest_refresh();
}

void Monitor::State::report_whole() noexcept {
  if (triage.current().size() < triage.counts().known()) {
    const Clearance others = rest();
    closest.add_rest(others.now, others.since);
  }
  zones.finish(
      inputs.any_lost ? std::span<const TrackedObject>(objects) : std::span<const TrackedObject>(),
      pending(), report.cycle, report.zones);

  report.lower_all = report.unknown > 0 ? -kInfinity : closest.lower();
  report.swept_lower_all = report.unknown > 0 ? -kInfinity : closest.swept_lower();
  report.minimum_known = closest.known();
  report.minimum_proved = closest.proved() && report.stale == 0 && report.unknown == 0;
  report.minimum = closest.known() ? report_pair(closest.pair()) : unknown_report();
}

// How far apart the pairs that are asleep, or that wait to be looked at, are for where their
// objects may be; no margins subtracted.
Clearance Monitor::State::rest() const noexcept {
  const Clearance waiting = pending();
  const double asleep = triage.horizon();
  return {.now = std::min(rounded_down(asleep - inputs.most_unseen), waiting.now),
          .since = std::min(rounded_down(asleep - inputs.most_strayed), waiting.since)};
}

Clearance Monitor::State::pending() const noexcept {
  if (!triage.pending()) return {};
  const double lower = triage.pending_lower();
  return {.now = rounded_down(lower - inputs.most_unseen),
          .since = rounded_down(lower - inputs.most_strayed)};
}

PairBounds Monitor::State::summary(std::uint32_t pair, bool published) const noexcept {
  // Of other pairs nobody asks how near they came, but for the least of all.
  const bool closely = published || zones.has(pair);
  PairBounds summary = summary_of(pair, objects, parts, report.cycle, table,
                                  closely ? Since::kByRelative : Since::kByTravel);
  if (!triage.any_passage()) return summary;
  const SweptBounds passage = triage.passage(pair);
  summary.swept_lower = std::min(summary.lower, std::max(summary.swept_lower, passage.lower));
  summary.swept_upper = std::min(summary.swept_upper, passage.upper);
  return summary;
}

void Monitor::State::write_report(std::uint32_t pair, const PairBounds& state,
                                  PairReport& written) const noexcept {
  report_on(pair, state, objects, parts, table, written);
  written.refresh_age_cycles = report.cycle - triage.refreshed_cycle(pair, table);
}

PairReport Monitor::State::report_pair(std::uint32_t pair) const noexcept {
  PairReport written;
  write_report(pair, summary(pair, scene.pairs[pair].publish), written);
  return written;
}

}  // namespace clearance
