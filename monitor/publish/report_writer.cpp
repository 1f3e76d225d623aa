// A thread empties the report queue in order: distances first, then separations and the zones that
// the report changed. Health is written when statistics arrive, once per second.
#include "monitor/publish/report_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "monitor/app/log_line.hpp"
#include "monitor/files/build_info.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/wire/report_checksum.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kAgainNs = 100'000'000;

std::int64_t monotonic_ns() noexcept { return SystemClock().monotonic_ns(); }

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

// Other shares learn within this time that a daemon is gone.
constexpr std::int64_t kShareLeaseNs = 1'000'000'000;

}  // namespace

std::int64_t lease_ns(double rate_hz) noexcept {
  return std::max<std::int64_t>(100'000'000, std::llround(10.0 * 1e9 / rate_hz));
}

ReportWriter::CellMessages::CellMessages(const Cell& the_cell, const SceneInForce& in_force,
                                         ReportQueue& the_queue, std::uint64_t daemon)
    : cell(the_cell),
      since(in_force),
      queue(the_queue),
      distances(make_distances(cell.scene)),
      separation(make_separation(cell.scene)),
      gradients(cell.scene),
      pairs(cell.shares.own_pairs()),
      changed(static_cast<std::uint64_t>(
          std::llround(std::ceil(cell.full_every_s * cell.scene.rate_hz)))),
      period_ns(std::llround(1e9 / cell.scene.rate_hz)) {
  distances->daemon = separation->daemon = daemon;
  distances->period_ns = separation->period_ns = period_ns;
}

// The catalogue is latched, so later clients get it as well.
ReportWriter::ReportWriter(const Cell& cell, Participant& participant, ReportQueue& queue,
                           const PoseReader& poses, const RecordingHealth& recording,
                           OnHealth on_health, PublishedSamples* also, DaemonIdentity identity,
                           PartnerPort* partner)
    : participant_(participant),
      topics_(cell.topics),
      poses_(poses),
      recording_(recording),
      on_health_(std::move(on_health)),
      also_(also),
      identity_(std::move(identity)),
      partner_(partner),
      distances_(make_writer(
          participant, topics_, TopicKind::kDistances,
          {.lease_ns = lease_ns(cell.scene.rate_hz), .user_data = to_user_data(identity_)})),
      catalogue_(make_writer(participant, topics_, TopicKind::kCatalogue,
                             {.process_lease_ns = cell.shares.is_one() ? kShareLeaseNs : 0})),
      health_(make_writer(participant, topics_, TopicKind::kHealth)),
      others_(participant, topics_.distances, identity_),
      now_(std::make_unique<CellMessages>(cell, SceneInForce(), queue, identity_.id)),
      zones_(make_writer(participant, topics_, TopicKind::kZones), cell.scene, identity_.id,
             [this](dds_entity_t writer, clearance_msg_ZoneState& state) {
               return send(TopicKind::kZones, writer, state, "zone state");
             }),
      contact_log_(cell.scene),
      health_log_(cell.scene),
      queue_(&queue),
      written_(&queue) {
  open_topics(cell.scene);
  leads_ = partner_ == nullptr;
  if (leads_) {
    const auto catalogue = own_catalogue();
    check_dds(dds_write(catalogue_, &*catalogue), "writing the catalogue");
    if (also_ != nullptr) also_->published(TopicKind::kCatalogue, &*catalogue);
  } else {
    zones_.set(ZoneWriter::Which::kNothing);
  }
  thread_ = std::thread([this] { run(); });
}

ReportWriter::~ReportWriter() { finish(); }

// May be called twice: the destructor calls it as well.
void ReportWriter::finish() {
  if (!thread_.joinable()) return;
  {
    const Lock lock(mutex_);
    queue_->close();
  }
  thread_.join();
}

void ReportWriter::continue_with(const Cell& cell, const SceneInForce& since, ReportQueue& queue) {
  auto next = std::make_unique<CellMessages>(cell, since, queue, identity_.id);
  const Lock lock(mutex_);
  next_ = std::move(next);
  queue_->close();
  queue_ = &queue;
}

bool ReportWriter::is_to_continue() const {
  const Lock lock(mutex_);
  return queue_ != written_;
}

// Topics that only some cells need.
void ReportWriter::open_topics(const Scene& scene) {
  if (separation_ == 0 && separated_count(scene).any())
    separation_ = make_writer(participant_, topics_, TopicKind::kSeparation);
  if (gradients_ == 0 && scene.gradients) {
    gradients_ = make_writer(participant_, topics_, TopicKind::kGradients,
                             {.lease_ns = lease_ns(scene.rate_hz)});
  }
}

// The number of matched readers.
std::uint32_t ReportWriter::distance_readers() const {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(distances_, &status) == DDS_RETCODE_OK
             ? status.current_count
             : 0;
}

Sample<clearance_msg_Catalogue> ReportWriter::own_catalogue() const {
  auto catalogue = make_catalogue(now_->cell, now_->since, CataloguePairs::kOfWholeCell);
  catalogue->daemon = identity_.id;
  seal(*catalogue, participant_.address(topics_.catalogue));
  return catalogue;
}

// A client keeps one value of a latched topic, that of the last writer. After another daemon has
// left, our values are written again.
void ReportWriter::look_for_others() {
  others_.poll();
  if (others_.have_just_left()) tell_again();
}

void ReportWriter::tell_again() {
  zones_.write_again();
  catalogue_is_due_ = true;
}

// Whoever has the catalogue expects the states of all zones behind it. DDS refuses where a reader
// does not keep up, and each attempt takes as long as a write may block.
void ReportWriter::settle_catalogue() {
  const bool is_due = catalogue_is_due_ && zones_.which() != ZoneWriter::Which::kNothing;
  if (!is_due && !takes_catalogue_back_) return;
  if (others_.yields() || monotonic_ns() - refused_ns_ < kAgainNs) return;
  const auto catalogue = own_catalogue();
  if (is_due) {
    catalogue_is_due_ = !write(TopicKind::kCatalogue, catalogue_, &*catalogue, "catalogue");
    takes_catalogue_back_ = false;
    zones_.write_again();
  } else {
    takes_catalogue_back_ = dds_unregister_instance(catalogue_, &*catalogue) == DDS_RETCODE_TIMEOUT;
  }
  if (catalogue_is_due_ || takes_catalogue_back_) refused_ns_ = monotonic_ns();
}

// Writes reports in order, then statistics. Ends when the queue is closed and empty, and no other
// follows.
void ReportWriter::run() {
  name_thread("reports");
  for (;;) {
    now_->queue.wait();
    const bool closed = now_->queue.closed();  // read before the queue, so that nothing remains
    write_all();
    if (closed && !change()) return;
  }
}

void ReportWriter::write_all() {
  look_for_others();
  if (partner_ == nullptr) settle_catalogue();
  while (const QueuedReport* queued = now_->queue.reports().front()) {
    write_report(*queued);
    now_->queue.reports().pop();
  }
  while (const LoopStatistics* statistics = now_->queue.statistics().front()) {
    write_health(*statistics);
    now_->queue.statistics().pop();
  }
}

// Returns false if no other cell follows. A partner writes its catalogue once it knows whether the
// other one has that cell, too.
bool ReportWriter::change() {
  std::unique_ptr<CellMessages> changed;
  {
    const Lock lock(mutex_);
    changed = std::move(next_);
  }
  if (changed == nullptr) return false;
  dropped_before_ += now_->queue.dropped_reports();
  zones_.change(changed->cell.scene, leads_);
  now_ = std::move(changed);
  contact_log_.change(now_->cell.scene);
  health_log_.change(now_->cell.scene);
  open_topics(now_->cell.scene);
  catalogue_is_due_ = true;
  if (partner_ == nullptr) settle_catalogue();
  const Lock lock(mutex_);
  written_ = &now_->queue;
  return true;
}

// The time of publishing is the only field of a report that the tick does not determine.
void ReportWriter::write_report(const QueuedReport& queued) {
  TickTag tag{.publishes = true};
  if (partner_ != nullptr) {
    tag = partner_->tag(queued.report.cycle);
    note_standing(tag.standing);
    settle_catalogue();
  }
  zones_.note(queued.report);
  if (!tag.publishes) {
    published_ = queued.report.cycle;
    return note_delay(queued, false);
  }
  const bool published = write_distances(queued, tag);
  if (separated_count(now_->cell.scene).any() && leads_now()) write_separation(queued.report);
  if (now_->cell.scene.gradients && leads_now()) {
    clearance_msg_Gradients& gradients = now_->gradients.of(queued.report, dds_time());
    gradients.daemon = identity_.id;
    gradients.period_ns = now_->period_ns;
    now_->pairs.in(gradients);
    send(TopicKind::kGradients, gradients_, gradients, "gradients");
  }
  zones_.write(queued.report, now_->pairs);
  note_delay(queued, published);
  if (also_ != nullptr && leads_) also_->report_ended();
  contact_log_.note(queued.report.contacts);
  if (published) published_ = queued.report.cycle;
}

// This process may have been stopped since it was asked last.
bool ReportWriter::leads_now() const {
  return leads_ && (partner_ == nullptr || partner_->leads());
}

// The time that clients need to receive the report is not in it.
void ReportWriter::note_delay(const QueuedReport& queued, bool published) {
  if (!published) return now_->queue.published(TickTime::kNotMeasured);
  const std::int64_t delay_ns = std::max<std::int64_t>(0, monotonic_ns() - queued.start.told_ns);
  now_->queue.published(delay_ns);
  responses_.add(queued.start, delay_ns);
}

bool ReportWriter::write_distances(const QueuedReport& queued, const TickTag& tag) {
  clearance_msg_Distances& message = *now_->distances;
  if (partner_ != nullptr) {
    identity_.partner.copy(message.partner, sizeof message.partner - 1);
    message.lineage = tag.lineage;
    message.state_checksum = checksum_of_rest(queued.report, tag.state_checksum);
  }
  to_wire(queued.report, queued.sources(), dds_time(), message);
  now_->pairs.in(message);
  if (partner_ != nullptr && now_->changed.reduces()) {
    Checksum sum;
    sum.add(message.state_checksum);
    sum.add(checksum_of(message));
    message.state_checksum = sum.value();
  }
  now_->changed.reduce(message);
  const bool published = send(TopicKind::kDistances, distances_, message, "distances");
  if (partner_ != nullptr) partner_->published(message);
  return published;
}

// A daemon that ticks apart still has clients, and its zones are true: ZoneWriter::Which. While
// partners do not agree, a zone that is active in one of them is written again and again, so that
// it is active for every reader, although the other one may write it as inactive once.
void ReportWriter::note_standing(PartnerStanding standing) {
  using enum ZoneWriter::Which;
  const std::uint64_t other = partner_->partner_revision();
  const bool is_other_scene = other != 0 && other != now_->cell.scene.revision;
  const bool is_apart = standing == PartnerStanding::kApart;
  const bool is_out = standing == PartnerStanding::kStarting || (is_apart && is_other_scene);
  const auto before = zones_.which(), now = is_out ? kNothing : is_apart ? kActive : kAll;
  zones_.set(now);
  if (now != before && now == kNothing) takes_catalogue_back_ = true;
  if (now != before && before == kNothing) catalogue_is_due_ = true;
  // Simple readers have the latched values of the leader before.
  const bool leads = partner_->leads();
  if (leads && !leads_) catalogue_is_due_ = true;
  leads_ = leads;
  if (monotonic_ns() - active_again_ns_ < kAgainNs || !partner_->disagrees()) return;
  active_again_ns_ = monotonic_ns();
  zones_.write_active_again();
}

void ReportWriter::write_separation(const Report& report) {
  to_wire(report, dds_time(), *now_->separation);
  now_->pairs.in(*now_->separation);
  send(TopicKind::kSeparation, separation_, *now_->separation, "separation");
}

// Failed writes count as dropped: in both cases the client got nothing. Another daemon, which ends
// because this one started first, may have left its catalogue with clients. It is taken for present
// until its lease ends.
void ReportWriter::write_health(const LoopStatistics& statistics) {
  if (others_.are_present()) tell_again();
  responses_.name(statistics, now_->cell.scene);
  auto sample = make_health(now_->cell.scene, statistics, poses_,
                            dropped_before_ + now_->queue.dropped_reports() + failed_writes_.load(),
                            recording_, &responses_);
  sample->daemon = identity_.id;
  sample->other_writers = others_.writers();
  sample->foreign_reports = others_.reports();
  if (partner_ != nullptr) partner_->fill(sample->partner);
  send(TopicKind::kHealth, health_, *sample, "health");
  if (on_health_) {
    on_health_({.scene = now_->cell.scene,
                .health = *sample,
                .report = now_->distances->cycle == 0 ? nullptr : &*now_->distances,
                .is_active = [this](std::uint32_t zone) { return zones_.is_active(zone); },
                .statistics = &statistics,
                .responses = &responses_});
  }
  zones_.end_second();
  contact_log_.end_second();
  health_log_.update(*sample, [this] { return poses_.senders_of_joints(); });
}

template <class Message>
bool ReportWriter::send(TopicKind kind, dds_entity_t writer, Message& message, const char* what) {
  seal(message, participant_.address(topics_.*topic(kind).name));
  return write(kind, writer, &message, what);
}

bool ReportWriter::write(TopicKind kind, dds_entity_t writer, const void* sample,
                         const char* what) {
  if (others_.yields()) return false;
  if (also_ != nullptr && leads_) also_->published(kind, sample);
  const dds_return_t result = dds_write(writer, sample);
  if (result == DDS_RETCODE_OK) return true;
  // Failures at the tick rate would flood the log, so only powers of two are logged.
  const std::uint64_t failed = failed_writes_.fetch_add(1) + 1;
  if ((failed & (failed - 1)) == 0) {
    log_line(lines::kWriteFailed, what, dds_strretcode(result), failed);
  }
  return false;
}

}  // namespace clearance
