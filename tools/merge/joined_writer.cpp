#include "tools/merge/joined_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "monitor/publish/report_writer.hpp"
#include "monitor/wire/report_checksum.hpp"

namespace clearance::merge {
namespace {

constexpr std::int64_t kHealthEvery = 1'000'000'000;
constexpr std::size_t kDelays = 1 << 20;

constexpr double kUsPerNs = 1e-3;

std::string percentiles(std::vector<double> delays) {
  std::ranges::sort(delays);
  const auto at = [&delays](double share) {
    return delays.empty()
               ? 0.0
               : delays[static_cast<std::size_t>(share * static_cast<double>(delays.size() - 1))];
  };
  return fmt::format("p50 {:.0f} us, p99.9 {:.0f} us", at(0.5), at(0.999));
}

DaemonIdentity identity_of(std::uint64_t daemon) {
  DaemonIdentity identity = make_identity();
  identity.id = daemon;
  return identity;
}

}  // namespace

JoinedWriter::JoinedWriter(Participant& participant, const Cell& cell, std::uint64_t daemon,
                           OnHealth on_health)
    : participant_(participant),
      identity_(identity_of(daemon)),
      topics_(cell.topics),
      on_health_(std::move(on_health)),
      lease_ns_(lease_ns(cell.scene.rate_hz)),
      period_ns_(std::llround(1e9 / cell.scene.rate_hz)),
      distances_(participant.writer(TopicKind::kDistances, topics_.distances,
                                    {.lease_ns = lease_ns_, .user_data = to_user_data(identity_)})),
      catalogue_(participant.writer(TopicKind::kCatalogue, topics_.catalogue)),
      zones_(participant.writer(TopicKind::kZones, topics_.zones)),
      health_(participant.writer(TopicKind::kHealth, topics_.health)),
      messages_(cell, participant),
      others_(participant, topics_.distances, identity_),
      zone_check_(cell) {}

bool JoinedWriter::put(TopicKind kind, dds_entity_t writer, const void* sample) {
  if (others_.yields()) return false;
  const bool is_taken = dds_write(writer, sample) == DDS_RETCODE_OK;
  failed_ += is_taken ? 0 : 1;
  messages_.published(kind, sample);
  return is_taken;
}

template <class Message>
bool JoinedWriter::send(TopicKind kind, dds_entity_t writer, Message message) {
  seal(message, participant_.address(topics_.*topic(kind).name));
  return put(kind, writer, &message);
}

template <class Message>
void JoinedWriter::send_tick(TopicKind kind, dds_entity_t writer, Message message) {
  message.period_ns = period_ns_;
  send(kind, writer, message);
}

// The strings belong to the share's sample. Cycles are those of this program.
bool JoinedWriter::write_catalogue(const clearance_msg_Catalogue& catalogue) {
  clearance_msg_Catalogue whole = catalogue;
  whole.daemon = identity_.id;
  whole.share[0] = '\0';
  whole.began_after = whole.in_force_from = 0;
  return send(TopicKind::kCatalogue, catalogue_, whole);
}

// Ids that a changed cell no longer has are withdrawn, and all others are written again. So is a
// state that DDS has not taken.
void JoinedWriter::write_zones(const client::SharedCell& whole, bool again) {
  std::map<std::uint32_t, WrittenZone> now;
  for (const auto& [id, state] : whole.zones()) {
    const WrittenZone present = WrittenZone::of(state);
    const auto before = written_.find(id);
    const bool is_due = again || before == written_.end() || before->second != present;
    if (!is_due || send(TopicKind::kZones, zones_, state)) now[id] = present;
  }
  for (const auto& [id, state] : written_) {
    if (whole.zones().contains(id)) continue;
    clearance_msg_ZoneState gone{};
    gone.zone = id;
    dds_dispose(zones_, &gone);
  }
  written_ = std::move(now);
}

// Before the first catalogue, nothing is known of the cell.
void JoinedWriter::write(client::SharedCell& whole) {
  others_.poll();
  const clearance_msg_Catalogue* const catalogue = whole.catalogue();
  if (catalogue == nullptr) return;
  const bool is_new = catalogue->scene_revision != revision_ || others_.have_just_left();
  if (is_new) {
    revision_ = write_catalogue(*catalogue) ? catalogue->scene_revision : 0;
  }
  const std::int64_t oldest_ns = whole->publish_ns;
  send_tick(TopicKind::kDistances, distances_, *whole);
  ++reports_;
  not_whole_ += whole.is_whole() ? 0 : 1;
  if (delays_us_.merging.size() < kDelays) {
    const std::int64_t now = dds_time();
    delays_us_.merging.push_back(kUsPerNs * static_cast<double>(now - oldest_ns));
    if (const std::int64_t pose_ns = whole->oldest_pose_ns; pose_ns != 0) {
      delays_us_.published.push_back(kUsPerNs * static_cast<double>(oldest_ns - pose_ns));
      delays_us_.joined.push_back(kUsPerNs * static_cast<double>(now - pose_ns));
    }
  }
  if (const clearance_msg_Separation* const separation = whole.separation()) {
    if (separation_ == 0)
      separation_ = participant_.writer(TopicKind::kSeparation, topics_.separation);
    send_tick(TopicKind::kSeparation, separation_, *separation);
  }
  if (const clearance_msg_Gradients* const gradients = whole.gradients()) {
    if (gradients_ == 0) {
      gradients_ =
          participant_.writer(TopicKind::kGradients, topics_.gradients,
                              {.lease_ns = lease_ns_, .user_data = to_user_data(identity_)});
    }
    send_tick(TopicKind::kGradients, gradients_, *gradients);
  }
  write_zones(whole, is_new);
  if (!others_.yields()) messages_.report_ended();
  zone_check_.check(whole);
  if (client::monotonic_ns() - health_ns_ < kHealthEvery) return;
  health_ns_ = client::monotonic_ns();
  auto health = whole.health();
  health->dropped_reports += failed_;
  health->other_writers = others_.writers();
  health->foreign_reports = others_.reports();
  health->period_ns = kHealthEvery;
  send(TopicKind::kHealth, health_, *health);
  on_health_(std::move(health));
}

std::string JoinedWriter::summary(const client::SharedCell& whole) const {
  return fmt::format(
      "{} reports of the whole cell, {} of them with a share missing, late, of another revision or "
      "divided otherwise; "
      "{} cycles lost, {} zones active without a share, {} zones wrong, {} reports not taken by "
      "DDS\n"
      "from the oldest pose in use to the oldest share's report: {}; to that of the whole: {}\n"
      "delay from the oldest share's report to that of the whole: {}",
      reports_, not_whole_, whole.missed(), zone_check_.unheard(), zone_check_.wrong(), failed_,
      percentiles(delays_us_.published), percentiles(delays_us_.joined),
      percentiles(delays_us_.merging));
}

}  // namespace clearance::merge
