#include "tools/watch/feed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "monitor/pair_name.hpp"
#include "monitor/report.hpp"

namespace clearance::watch {
namespace {

// A terminal may block the program for a second; the reader keeps the reports of that time.
constexpr std::int32_t kDistancesDepth = 2048;

template <class T>
bool take_one(dds_entity_t reader, T& sample) {
  void* pointer = &sample;
  dds_sample_info_t info;
  while (dds_take(reader, &pointer, &info, 1, 1) > 0) {
    if (info.valid_data) return true;
  }
  return false;
}

// Leaves `latest` as it is when there is nothing.
template <class T>
bool take_newer(dds_entity_t reader, Sample<T>& latest, Sample<T>& scratch) {
  if (!take_one(reader, *scratch)) return false;
  std::swap(*latest, *scratch);
  return true;
}

}  // namespace

Feed::Feed(Participant& participant, const Topics& topics)
    : distances_reader_(
          participant.reader(TopicKind::kDistances, topics.distances, kDistancesDepth)),
      catalogue_reader_(participant.reader(TopicKind::kCatalogue, topics.catalogue)),
      health_reader_(participant.reader(TopicKind::kHealth, topics.health)),
      zones_reader_(participant.reader(TopicKind::kZones, topics.zones)) {}

void Feed::take(std::int64_t now_ns) {
  while (take_newer(catalogue_reader_, catalogue_, next_catalogue_)) has_catalogue_ = true;
  while (take_newer(health_reader_, health_, next_health_)) has_health_ = true;
  take_distances(now_ns);
  clearance_msg_ZoneState zone{};
  while (take_one(zones_reader_, zone)) zones_[zone.zone] = zone;
}

void Feed::take_distances(std::int64_t now_ns) {
  while (take_newer(distances_reader_, distances_, next_distances_)) {
    last_ns_ = now_ns;
    note_report(now_ns);
  }
}

void Feed::note_report(std::int64_t now_ns) {
  check_ = checker_.check(*distances_, now_ns);
  if (check_.other_daemon) begin_again();
  daemons_.insert(distances_->daemon);
  missed_ += check_.missed;
  ++reports_;
  if (check_.is_old) {
    old_ = {.count = old_.count + 1,
            .oldest_ns = std::max(old_.oldest_ns, check_.age_ns),
            .last_ns = now_ns};
  }
  // A stale distance is that of an old pose.
  if (!distances_->minimum_known ||
      distances_->minimum.status >= static_cast<std::uint8_t>(PairStatus::kStale)) {
    return;
  }
  if (smallest_.known && !(distances_->minimum.distance < smallest_.pair.distance)) return;
  smallest_ = {.known = true, .pair = distances_->minimum, .cycle = distances_->cycle};
}

// Called when the daemon was started again, perhaps with another cell, whose ids mean other
// objects; or when two of them take turns, which is no restart. Zones of the new one may be here
// before its first report.
void Feed::begin_again() {
  const std::uint64_t daemon = distances_->daemon;
  if (daemon == 0 || !daemons_.contains(daemon)) ++restarts_;
  smallest_ = {};
  std::erase_if(zones_, [=](const auto& zone) { return zone.second.daemon != daemon; });
}

const clearance_msg_Catalogue* Feed::catalogue() const noexcept {
  return has_catalogue_ && (!any() || catalogue_->scene_revision == distances_->scene_revision)
             ? &*catalogue_
             : nullptr;
}

const clearance_msg_Health* Feed::health() const noexcept {
  return has_health_ && (!any() || health_->daemon == distances_->daemon) ? &*health_ : nullptr;
}

std::uint32_t Feed::publishers() const {
  dds_liveliness_changed_status_t status{};
  return dds_get_liveliness_changed_status(distances_reader_, &status) == DDS_RETCODE_OK
             ? status.alive_count
             : 0;
}

bool Feed::has_ended() const {
  dds_subscription_matched_status_t status{};
  return dds_get_subscription_matched_status(distances_reader_, &status) == DDS_RETCODE_OK &&
         status.current_count == 0;
}

std::string Feed::object_name(std::uint32_t object) const {
  if (catalogue() == nullptr || object >= catalogue_->objects._length) {
    return fmt::format("object {}", object);
  }
  return catalogue_->objects._buffer[object].name;
}

std::string Feed::part_name(std::uint32_t object, std::uint32_t part) const {
  const auto& objects = catalogue_->objects;
  if (object >= objects._length) return fmt::format("object {}", object);
  const clearance_msg_CatalogueObject& found = objects._buffer[object];
  if (found.parts._length < 2 || part >= found.parts._length) return found.name;
  return fmt::format("{}.{}", found.name, found.parts._buffer[part]);
}

std::string Feed::pair_name(const clearance_msg_PairDistance& pair) const {
  if (catalogue() == nullptr || pair.pair >= catalogue_->pairs._length) {
    return fmt::format("pair {}", pair.pair);
  }
  const clearance_msg_CataloguePair& objects = catalogue_->pairs._buffer[pair.pair];
  return clearance::pair_name(part_name(objects.object_a, pair.part_a),
                              part_name(objects.object_b, pair.part_b));
}

}  // namespace clearance::watch
