// A thread empties the report queue in order: distances first, then the zones that the report
// changed. Health is written when statistics arrive, once a second.
#include "monitor/dds/report_writer.hpp"

#include <fmt/format.h>

#include <spdlog/spdlog.h>

#include <string>

#include "monitor/loop/realtime.hpp"
#include "monitor/pair_name.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

// A reader with other QoS gets nothing, which nobody would notice without this line.
void log_incompatible(dds_entity_t writer, const dds_offered_incompatible_qos_status_t status,
                      void*) {
  if (status.last_policy_id == DDS_PARTITION_QOS_POLICY_ID) return;  // somebody else's cell
  char topic[128] = "?";
  dds_get_name(dds_get_topic(writer), topic, sizeof topic);
  spdlog::warn(
      "a reader of {} asks for QoS that is not offered (policy {}): it gets nothing. Policy 2: "
      "only catalogue, "
      "zones and health are latched; 24: another type; idl/README.md has the whole contract",
      topic, status.last_policy_id);
}

// "entered at cycle 12: hand - box, 0.043 m clear, 0.041 m since the tick before".
std::string change_of_zone(const Scene& scene, const ZoneReport& zone, std::uint64_t cycle) {
  const std::string at_cycle = fmt::format("at cycle {}", cycle);
  if (!zone.active) return fmt::format("left {}", at_cycle);
  const std::string pair = fmt::format("entered {}: {}", at_cycle, pair_name(scene, zone.pair));
  if (zone.clearance == -kInfinity)
    return fmt::format("{} unknown: no pose of one of them, or too old", pair);
  if (zone.swept_clearance == -kInfinity)
    return fmt::format("{}, unknown since the last tick: the pose of one is discontinuous", pair);
  return fmt::format("{}, {:.3f} m clear, {:.3f} m since the tick before", pair, zone.clearance,
                     zone.swept_clearance);
}

// The name of the topic is the cell's, which the table points to.
dds_entity_t make_writer(Participant& participant, const Scene& scene, TopicKind kind) {
  dds_listener_t* listener = dds_create_listener(nullptr);
  dds_lset_offered_incompatible_qos(listener, log_incompatible);
  const dds_entity_t writer = participant.writer(kind, scene.topics.*topic(kind).name, listener);
  dds_delete_listener(listener);
  return writer;
}

}  // namespace

// The catalogue is latched: clients that come later get it as well.
ReportWriter::ReportWriter(const Scene& scene, Participant& participant, ReportQueue& queue,
                           const PoseReader& poses, const RecordingHealth& recording)
    : scene_(scene),
      queue_(queue),
      poses_(poses),
      recording_(recording),
      distances_(make_writer(participant, scene, TopicKind::kDistances)),
      catalogue_(make_writer(participant, scene, TopicKind::kCatalogue)),
      zones_(make_writer(participant, scene, TopicKind::kZones)),
      health_(make_writer(participant, scene, TopicKind::kHealth)),
      distances_sample_(make_distances(scene)),
      written_zones_(scene.zones.size()),
      health_log_(scene) {
  const auto catalogue = make_catalogue(scene);
  check_dds(dds_write(catalogue_, &*catalogue), "writing the catalogue");
  thread_ = std::thread([this] { run(); });
}

ReportWriter::~ReportWriter() { finish(); }

// Safe to call twice: the destructor calls it as well.
void ReportWriter::finish() {
  if (!thread_.joinable()) return;
  queue_.close();
  thread_.join();
}

// Matched readers, as Cyclone counts them.
std::uint32_t ReportWriter::distance_readers() const {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(distances_, &status) == DDS_RETCODE_OK
             ? status.current_count
             : 0;
}

// Reports in order, then statistics; ends when the queue is closed and empty.
void ReportWriter::run() {
  name_thread("reports");
  for (bool closed = false; !closed;) {
    queue_.wait();
    closed = queue_.closed();  // asked before the last look, so that nothing is left behind
    while (const QueuedReport* queued = queue_.reports().front()) {
      write_report(*queued);
      queue_.reports().pop();
    }
    while (const LoopStatistics* statistics = queue_.statistics().front()) {
      write_health(*statistics);
      queue_.statistics().pop();
    }
  }
}

// The time of publishing is the only field of a report that the tick does not determine.
void ReportWriter::write_report(const QueuedReport& queued) {
  to_wire(queued.report, queued.sources(), dds_time(), *distances_sample_);
  write(distances_, &*distances_sample_, "distances");
  write_zones(queued.report);
}

// A zone is written at the start, and whenever it changes from what was written last.
void ReportWriter::write_zones(const Report& report) {
  for (std::uint32_t zone = 0; zone < report.zones.size(); ++zone) {
    const bool active = report.zones[zone].active;
    if (written_zones_.is(zone, active)) continue;
    clearance_msg_ZoneState state{};
    to_wire(scene_, report, zone, state);
    write(zones_, &state, "zone state");
    if (written_zones_.any(zone) || active) {
      spdlog::info("zone '{}' {}", scene_.zones[zone].name,
                   change_of_zone(scene_, report.zones[zone], report.cycle));
    }
    written_zones_.set(zone, active);
  }
}

// Failed writes count as dropped: the client got neither.
void ReportWriter::write_health(const LoopStatistics& statistics) {
  const auto sample = make_health(scene_, statistics, poses_,
                                  queue_.dropped_reports() + failed_writes_.load(), recording_);
  write(health_, &*sample, "health");
  health_log_.update(*sample);
}

void ReportWriter::write(dds_entity_t writer, const void* sample, const char* what) {
  const dds_return_t result = dds_write(writer, sample);
  if (result == DDS_RETCODE_OK) return;
  // At a tick rate the log would be flooded: powers of two say it often enough.
  const std::uint64_t failed = failed_writes_.fetch_add(1) + 1;
  if ((failed & (failed - 1)) == 0) {
    spdlog::error("writing {} failed: {} ({} failed so far)", what, dds_strretcode(result), failed);
  }
}

}  // namespace clearance
