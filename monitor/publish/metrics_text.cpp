#include "monitor/publish/metrics_text.hpp"

#include <fmt/format.h>
#include <prometheus/text_serializer.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "monitor/files/build_info.hpp"

namespace clearance {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

constexpr double kSecondsPerNs = 1e-9;
// ns; those of a tick and of a wake-up.
constexpr std::array<std::int64_t, 14> kBuckets = {
    5'000,     10'000,    20'000,    50'000,     100'000,    200'000,     500'000,
    1'000'000, 2'000'000, 5'000'000, 10'000'000, 20'000'000, 100'000'000, 1'000'000'000};

class Families {
 public:
  // A family of one type; values follow by value().
  void open(std::string name, std::string help, MetricType type) {
    families_.push_back({"clearance_" + std::move(name), std::move(help), type, {}});
  }
  void value(double value, Labels labels = {}) {
    MetricFamily& family = families_.back();
    ClientMetric metric;
    metric.label = std::move(labels);
    metric.counter.value = metric.gauge.value = value;
    family.metric.push_back(std::move(metric));
  }
  void counter(std::string name, std::string help, std::uint64_t count) {
    open(std::move(name), std::move(help), MetricType::Counter);
    value(static_cast<double>(count));
  }
  void gauge(std::string name, std::string help, double number) {
    open(std::move(name), std::move(help), MetricType::Gauge);
    value(number);
  }
  void histogram(std::string name, std::string help, const Histogram& of) {
    open(std::move(name), std::move(help), MetricType::Histogram);
    ClientMetric metric;
    metric.histogram.sample_count = of.count();
    metric.histogram.sample_sum = kSecondsPerNs * static_cast<double>(of.sum_ns());
    for (const std::int64_t ns : kBuckets) {
      metric.histogram.bucket.push_back(
          {of.count_up_to(ns), kSecondsPerNs * static_cast<double>(ns)});
    }
    metric.histogram.bucket.push_back({of.count(), std::numeric_limits<double>::infinity()});
    families_.back().metric.push_back(std::move(metric));
  }
  [[nodiscard]] std::string text() const {
    return prometheus::TextSerializer().Serialize(families_);
  }

 private:
  std::vector<MetricFamily> families_;
};

template <class Sequence>
std::span<const std::remove_pointer_t<decltype(Sequence::_buffer)>> items(const Sequence& of) {
  return {of._buffer, of._length};
}

void add_loop(const MetricsSource& source, Families& out) {
  const clearance_msg_Health& health = source.health;
  out.open("info", "The cell and the build; the value is 1.", MetricType::Gauge);
  out.value(1.0, {{"cell", source.scene.name},
                  {"revision", fmt::format("{:016x}", health.scene_revision)},
                  {"build", kBuild}});
  out.gauge("time_seconds", "The time of the last tick; CLOCK_REALTIME unless it was stepped.",
            kSecondsPerNs * static_cast<double>(health.now_ns));
  out.counter("ticks_total", "Ticks since the start.", health.cycle);
  out.counter("overruns_total", "Ticks that ended after the next deadline.", health.overruns);
  out.counter("skipped_cycles_total", "Deadlines that passed without a tick.",
              health.skipped_cycles);
  out.counter("late_responses_total", "Ticks with an input beyond response_limit_ms.",
              health.late_responses);
  out.open("input_response_max_seconds",
           "The longest from the stamp of an input to the handing over of a report that uses it.",
           MetricType::Gauge);
  for (const clearance_msg_InputResponse& of : items(health.responses))
    out.value(1e-6 * of.max_us, {{"input", of.input}});
  if (source.statistics == nullptr) return;
  out.histogram("tick_seconds", "From the wake-up to the handing over of the report.",
                source.statistics->tick);
  out.histogram("wakeup_delay_seconds", "Delays of the tick thread's wake-ups.",
                source.statistics->wakeup);
  if (source.responses == nullptr) return;
  out.histogram("response_seconds",
                "From the stamp of the slowest input of a tick to the handing over of its report.",
                source.responses->slowest());
}

// An input that has never come has no age. Links follow from joints.
void add_inputs(const MetricsSource& source, Families& out) {
  const clearance_msg_Health& health = source.health;
  std::set<std::uint32_t> links;
  for (const Robot& robot : source.scene.robots) {
    for (const RobotLink& link : robot.links) links.insert(link.object);
  }
  const auto each = [&](const auto& add) {
    for (const auto& input : items(health.inputs)) {
      if (!links.contains(input.object)) add(input, std::string(input.name));
    }
    for (const auto& joint : items(health.joints)) add(joint, "joint " + std::string(joint.name));
  };
  out.open("input_age_seconds", "Age of the pose or joint position in use.", MetricType::Gauge);
  each([&](const auto& input, const std::string& name) {
    if (input.age_ns >= 0)
      out.value(kSecondsPerNs * static_cast<double>(input.age_ns),
                {{"input", name}, {"source", input.source}});
  });
  out.open("input_usable", "1: in use; 0: unknown, late or contradicted.", MetricType::Gauge);
  each([&](const auto& input, const std::string& name) {
    out.value(input.stale || input.contradicted || input.age_ns < 0 ? 0.0 : 1.0, {{"input", name}});
  });
  out.open("refused_total", "Samples that were not used.", MetricType::Counter);
  for (const clearance_msg_RejectCount& refused : items(health.rejected))
    out.value(static_cast<double>(refused.count),
              {{"input", refused.object}, {"cause", refused.cause}});
  out.open("batches_total", "Batches that were handed to the tick.", MetricType::Counter);
  for (const clearance_msg_SourceHealth& of : items(health.sources))
    out.value(static_cast<double>(of.batches), {{"source", of.source}});
  out.open("lost_batches_total", "Gaps in the sequence numbers, and no room to wait in.",
           MetricType::Counter);
  for (const clearance_msg_SourceHealth& of : items(health.sources))
    out.value(static_cast<double>(of.lost_batches), {{"source", of.source}});
  out.counter("undecodable_samples_total", "Messages that could not be read.",
              health.undecodable_samples);
}

void add_outputs(const clearance_msg_Health& health, Families& out) {
  out.counter("dropped_reports_total", "Reports that did not reach DDS.", health.dropped_reports);
  out.counter("recording_missing_total", "Reports and batches that are not in the recording.",
              health.recording_missing);
  out.counter("foreign_reports_total", "Reports of other daemons that were heard.",
              health.foreign_reports);
}

void add_distances(const MetricsSource& source, Families& out) {
  if (source.report != nullptr) {
    const clearance_msg_Distances& report = *source.report;
    out.open("minimum_distance_meters",
             "The least distance of the last report; its bounds as other labels.",
             MetricType::Gauge);
    if (report.minimum_known) {
      out.value(report.minimum.distance, {{"bound", "distance"}});
      out.value(report.minimum.lower, {{"bound", "lower"}});
      out.value(report.minimum.upper, {{"bound", "upper"}});
    }
    out.gauge("minimum_certified", "1: no pair is nearer than the lower bound.",
              report.minimum_certified ? 1.0 : 0.0);
    out.open("pairs", "Pairs by what is known of them.", MetricType::Gauge);
    out.value(report.pairs_total, {{"state", "all"}});
    out.value(report.stale, {{"state", "stale"}});
    out.value(report.unknown, {{"state", "unknown"}});
  }
  if (!source.is_active) return;
  out.open("zone_active", "1: the zone is active.", MetricType::Gauge);
  for (std::uint32_t zone = 0; zone < source.scene.zones.size(); ++zone)
    out.value(source.is_active(zone) ? 1.0 : 0.0, {{"zone", source.scene.zones[zone].name}});
}

}  // namespace

std::string metrics_text(const MetricsSource& source) {
  Families out;
  add_loop(source, out);
  add_inputs(source, out);
  add_outputs(source.health, out);
  add_distances(source, out);
  return out.text();
}

}  // namespace clearance
