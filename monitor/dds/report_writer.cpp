// A thread empties the report queue in order: distances first, then separations and the zones that
// the report changed. Health is written when statistics arrive, once a second.
#include "monitor/dds/report_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "monitor/app/log_lines.hpp"
#include "monitor/files/build_info.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/pair_name.hpp"
#include "monitor/wire/convert.hpp"
#include "monitor/zone_cause.hpp"

namespace clearance {
namespace {

// A reader with other QoS gets nothing; only this line tells.
void log_incompatible(dds_entity_t writer, const dds_offered_incompatible_qos_status_t status,
                      void*) {
  if (status.last_policy_id == DDS_PARTITION_QOS_POLICY_ID) return;  // another cell's reader
  char topic[128] = "?";
  dds_get_name(dds_get_topic(writer), topic, sizeof topic);
  if (status.last_policy_id == DDS_TYPE_CONSISTENCY_ENFORCEMENT_QOS_POLICY_ID) {
    log_line(lines::kOlderReader, topic, kBuild);
  } else {
    log_line(lines::kIncompatibleReader, topic, status.last_policy_id);
  }
}

// Logs that a zone was entered, and why, or that it was left. Only near and late zones have bounds.
void log_zone(const Scene& scene, std::uint32_t index, const ZoneReport& zone,
              std::uint64_t cycle) {
  const std::string& name = scene.zones[index].name;
  if (!zone.active) return log_line(lines::kZoneLeft, name, cycle);
  const std::string pair = pair_name(scene, zone.pair);
  const std::string cause = cause_text(scene, zone);
  switch (zone.cause) {
    case ZoneCause::kLate:
      return log_line(lines::kZoneLate, name, cycle, cause, pair, zone.clearance,
                      zone.swept_clearance);
    case ZoneCause::kUnknown:
      return log_line(lines::kZoneUnknown, name, cycle, cause, pair);
    case ZoneCause::kContradicted:
      return log_line(lines::kZoneContradicted, name, cycle, cause, pair);
    case ZoneCause::kDiscontinuous:
      return log_line(lines::kZoneDiscontinuous, name, cycle, cause, pair);
    default:
      return log_line(lines::kZoneNear, name, cycle, cause, pair, zone.clearance,
                      zone.swept_clearance);
  }
}

// The table points to the cell's name of the topic.
dds_entity_t make_writer(Participant& participant, const Topics& topics, TopicKind kind,
                         WriterOptions options = {}) {
  dds_listener_t* listener = dds_create_listener(nullptr);
  dds_lset_offered_incompatible_qos(listener, log_incompatible);
  options.listener = listener;
  const dds_entity_t writer = participant.writer(kind, topics.*topic(kind).name, options);
  dds_delete_listener(listener);
  return writer;
}

}  // namespace

std::int64_t lease_ns(double rate_hz) noexcept {
  return std::max<std::int64_t>(100'000'000, std::llround(10.0 * 1e9 / rate_hz));
}

// The catalogue is latched, so later clients get it as well.
ReportWriter::ReportWriter(const Cell& cell, Participant& participant, ReportQueue& queue,
                           const PoseReader& poses, const RecordingHealth& recording)
    : cell_(cell),
      scene_(cell.scene),
      queue_(queue),
      poses_(poses),
      recording_(recording),
      identity_(make_identity()),
      distances_(make_writer(
          participant, cell.topics, TopicKind::kDistances,
          {.lease_ns = lease_ns(cell.scene.rate_hz), .user_data = to_user_data(identity_)})),
      catalogue_(make_writer(participant, cell.topics, TopicKind::kCatalogue)),
      zones_(make_writer(participant, cell.topics, TopicKind::kZones)),
      health_(make_writer(participant, cell.topics, TopicKind::kHealth)),
      separation_(separated_count(cell.scene).zones == 0
                      ? 0
                      : make_writer(participant, cell.topics, TopicKind::kSeparation)),
      gradients_(cell.scene.gradients ? make_writer(participant, cell.topics, TopicKind::kGradients,
                                                    {.lease_ns = lease_ns(cell.scene.rate_hz)})
                                      : 0),
      others_(participant, cell.topics.distances, identity_),
      distances_sample_(make_distances(cell.scene)),
      separation_sample_(make_separation(cell.scene)),
      gradient_message_(cell.scene),
      written_zones_(cell.scene.zones.size()),
      health_log_(cell.scene) {
  distances_sample_->daemon = separation_sample_->daemon = identity_.id;
  check_dds(dds_write(catalogue_, &*own_catalogue()), "writing the catalogue");
  thread_ = std::thread([this] { run(); });
}

ReportWriter::~ReportWriter() { finish(); }

// May be called twice: the destructor calls it as well.
void ReportWriter::finish() {
  if (!thread_.joinable()) return;
  queue_.close();
  thread_.join();
}

// The number of matched readers.
std::uint32_t ReportWriter::distance_readers() const {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(distances_, &status) == DDS_RETCODE_OK
             ? status.current_count
             : 0;
}

Sample<clearance_msg_Catalogue> ReportWriter::own_catalogue() const {
  auto catalogue = make_catalogue(cell_);
  catalogue->daemon = identity_.id;
  return catalogue;
}

// A client keeps one value of a latched topic, that of the last writer. After another daemon has
// left, our values are written again.
void ReportWriter::look_for_others() {
  others_.look();
  if (!others_.have_just_left()) return;
  write_zones_again_ = true;
  write(catalogue_, &*own_catalogue(), "catalogue");
}

// Writes reports in order, then statistics. Ends when the queue is closed and empty.
void ReportWriter::run() {
  name_thread("reports");
  for (bool closed = false; !closed;) {
    queue_.wait();
    closed = queue_.closed();  // read before the queue, so that nothing remains in it
    look_for_others();
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
  if (separation_ != 0) write_separation(queued.report);
  if (gradients_ != 0) {
    clearance_msg_Gradients& gradients = gradient_message_.of(queued.report, dds_time());
    gradients.daemon = identity_.id;
    write(gradients_, &gradients, "gradients");
  }
  write_zones(queued.report);
}

void ReportWriter::write_separation(const Report& report) {
  to_wire(report, dds_time(), *separation_sample_);
  write(separation_, &*separation_sample_, "separation");
}

// Writes a zone at the start, after each change, and again after another daemon may have written
// it.
void ReportWriter::write_zones(const Report& report) {
  const bool again = std::exchange(write_zones_again_, false);
  for (std::uint32_t zone = 0; zone < report.zones.size(); ++zone) {
    const bool active = report.zones[zone].active;
    const bool is_written = written_zones_.is(zone, active);
    if (is_written && !again) continue;
    clearance_msg_ZoneState state{};
    state.daemon = identity_.id;
    to_wire(scene_, report, zone, state);
    write(zones_, &state, "zone state");
    if (!is_written && (written_zones_.any(zone) || active)) {
      log_zone(scene_, zone, report.zones[zone], report.cycle);
    }
    written_zones_.set(zone, active);
  }
}

// Failed writes count as dropped: in both cases the client got nothing.
void ReportWriter::write_health(const LoopStatistics& statistics) {
  auto sample = make_health(scene_, statistics, poses_,
                            queue_.dropped_reports() + failed_writes_.load(), recording_);
  sample->daemon = identity_.id;
  sample->other_writers = others_.writers();
  sample->foreign_reports = others_.reports();
  write(health_, &*sample, "health");
  health_log_.update(*sample, [this] { return poses_.senders_of_joints(); });
}

void ReportWriter::write(dds_entity_t writer, const void* sample, const char* what) {
  if (others_.give_way()) return;
  const dds_return_t result = dds_write(writer, sample);
  if (result == DDS_RETCODE_OK) return;
  // Failures at the tick rate would flood the log, so only powers of two are logged.
  const std::uint64_t failed = failed_writes_.fetch_add(1) + 1;
  if ((failed & (failed - 1)) == 0) {
    log_line(lines::kWriteFailed, what, dds_strretcode(result), failed);
  }
}

}  // namespace clearance
