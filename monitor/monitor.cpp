#include "monitor/monitor.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "monitor/object_state.hpp"
#include "monitor/pair_summary.hpp"
#include "monitor/pair_table.hpp"
#include "monitor/placed_part.hpp"
#include "monitor/triage.hpp"
#include "monitor/zone_state.hpp"

namespace clearance {

struct Monitor::State {
  const Scene& scene;
  std::vector<ObjectState> objects;
  std::vector<PlacedPart> parts;
  PairTable table;
  Triage triage;
  std::vector<PairSummary> summaries;  // by object pair
  Report report;

  explicit State(const Scene& the_scene);

  void begin(std::int64_t now_ns) noexcept;
  void take_in(std::span<const PoseSample> samples) noexcept;
  void move() noexcept;
  void report_inputs() noexcept;
  void report_pairs() noexcept;
  void report_minimum() noexcept;
  void report_zones() noexcept;

  void refuse(std::uint32_t object, Reject cause) noexcept;
  [[nodiscard]] PairReport report_pair(std::uint32_t pair) const noexcept;
  [[nodiscard]] bool may_be_closer(const PairSummary& pair,
                                   const PairSummary& minimum) const noexcept;
};

Monitor::Monitor(const Scene& scene) : state_(std::make_unique<State>(scene)) {}
Monitor::~Monitor() = default;

const Report& Monitor::tick(std::span<const PoseSample> samples, std::int64_t now_ns) noexcept {
  State& s = *state_;
  s.begin(now_ns);
  s.take_in(samples);                  // samples  -> objects: the pose in use of each
  s.move();                            // objects  -> parts: where each is, how far it moved
  carry(s.objects, s.parts, s.table);  // parts    -> table: every bound true for these poses
  s.report.queries = s.triage.evaluate_due(s.objects, s.parts, s.report.cycle, s.table);
  s.report_inputs();  // table    -> report
  s.report_pairs();
  s.report_minimum();
  s.report_zones();
  return s.report;
}

void Monitor::refuse(std::uint32_t object, Reject cause) noexcept { state_->refuse(object, cause); }

PairReport Monitor::pair(std::uint32_t pair) const noexcept { return state_->report_pair(pair); }

InputAge Monitor::input_age(std::uint32_t object) const noexcept {
  const ObjectState& state = state_->objects[object];
  return {.age_ns = state.age_ns, .stale = state.late};
}

const std::array<std::uint64_t, kRejects>& Monitor::rejected(std::uint32_t object) const noexcept {
  return state_->objects[object].rejected;
}

std::int64_t Monitor::stamp_ns(std::uint32_t object) const noexcept {
  return state_->objects[object].stamp_ns;
}

Monitor::State::State(const Scene& the_scene)
    : scene(the_scene),
      parts(parts_of(the_scene)),
      table(the_scene, parts),
      triage(the_scene, parts, table),
      summaries(the_scene.pairs.size()) {
  for (const Object& object : scene.objects) objects.push_back(initial_state(object));
  report.scene_revision = scene.revision;
  report.pairs_total = static_cast<std::uint32_t>(scene.pairs.size());
  report.now_ns = std::numeric_limits<std::int64_t>::min();
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    if (scene.pairs[p].publish) report.pairs.push_back(report_pair(p));
  }
  report.zones.resize(scene.zones.size());
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
    ObjectState& object = objects[sample.object];
    const auto cause = refusal(sample, object, report.now_ns, scene.future_limit_ns);
    if (cause) {
      refuse(sample.object, *cause);
    } else {
      accept(sample, object);
    }
  }
}

void Monitor::State::refuse(std::uint32_t object, Reject cause) noexcept {
  const auto index = static_cast<std::size_t>(cause);
  ++report.rejected[index];
  if (object < objects.size()) ++objects[object].rejected[index];
}

void Monitor::State::move() noexcept {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    advance(scene.objects[i], report.now_ns, objects[i]);
  }
  for (PlacedPart& part : parts) {
    if (objects[part.object].seen) place(objects[part.object], part);
  }
}

void Monitor::State::report_inputs() noexcept {
  bool any = false;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (scene.objects[i].fixed || !objects[i].seen) continue;
    const std::int64_t stamp_ns = objects[i].stamp_ns;
    report.newest_pose_ns = any ? std::max(report.newest_pose_ns, stamp_ns) : stamp_ns;
    report.oldest_pose_ns = any ? std::min(report.oldest_pose_ns, stamp_ns) : stamp_ns;
    any = true;
  }
}

void Monitor::State::report_pairs() noexcept {
  std::array<std::uint32_t, kPairStatuses> with_status{};
  double lower_all = kInfinity;
  std::uint64_t oldest_cycle = report.cycle;
  std::size_t published = 0;
  for (std::uint32_t p = 0; p < summaries.size(); ++p) {
    PairSummary& pair = summaries[p];
    summarise(p, objects, report.cycle, table, pair);
    ++with_status[static_cast<std::size_t>(pair.status)];
    lower_all = std::min(lower_all, pair.lower);
    if (pair.status != PairStatus::kUnknown) {
      oldest_cycle = std::min(oldest_cycle, pair.evaluated_cycle);
    }
    if (scene.pairs[p].publish) report.pairs[published++] = report_pair(p);
  }
  const auto having = [&](PairStatus s) { return with_status[static_cast<std::size_t>(s)]; };
  report.carried = having(PairStatus::kCarried);
  report.stale = having(PairStatus::kStale);
  report.unknown = having(PairStatus::kUnknown);
  report.evaluated = report.pairs_total - report.carried - report.stale - report.unknown;
  report.lower_all = lower_all;
  report.oldest_evaluation_cycles = report.cycle - oldest_cycle;
}

void Monitor::State::report_minimum() noexcept {
  const PairSummary* minimum = nullptr;
  for (const PairSummary& pair : summaries) {
    if (pair.status == PairStatus::kUnknown || pair.evaluated_cycle == 0) continue;
    const bool closer = minimum == nullptr || pair.upper < minimum->upper ||
                        (pair.upper == minimum->upper && pair.lower < minimum->lower);
    if (closer) minimum = &pair;
  }
  report.minimum_known = minimum != nullptr;
  report.minimum_proved = report.minimum_known && report.stale == 0 && report.unknown == 0;
  if (!report.minimum_known) {
    report.minimum = unknown_report();
    return;
  }
  for (const PairSummary& pair : summaries) {
    if (may_be_closer(pair, *minimum)) report.minimum_proved = false;
  }
  report.minimum = report_pair(static_cast<std::uint32_t>(minimum - summaries.data()));
}

// Beyond what rounding leaves open between two pairs that were both evaluated.
bool Monitor::State::may_be_closer(const PairSummary& pair,
                                   const PairSummary& minimum) const noexcept {
  if (&pair == &minimum || pair.lower >= minimum.upper) return false;
  return !is_evaluated(pair.status) || pair.status == PairStatus::kLoose;
}

void Monitor::State::report_zones() noexcept {
  for (std::size_t z = 0; z < report.zones.size(); ++z) {
    update(scene, scene.zones[z], summaries, report.cycle, report.zones[z]);
  }
}

PairReport Monitor::State::report_pair(std::uint32_t pair) const noexcept {
  return report_on(scene, pair, summaries[pair], objects, parts, table);
}

}  // namespace clearance
