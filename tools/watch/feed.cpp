#include "tools/watch/feed.hpp"

#include <fmt/format.h>

#include "monitor/pair_name.hpp"

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

}  // namespace

Feed::Feed(Participant& participant, const Topics& topics)
    : distances_reader_(
          participant.reader(TopicKind::kDistances, topics.distances, kDistancesDepth)),
      catalogue_reader_(participant.reader(TopicKind::kCatalogue, topics.catalogue)),
      health_reader_(participant.reader(TopicKind::kHealth, topics.health)),
      zones_reader_(participant.reader(TopicKind::kZones, topics.zones)) {}

void Feed::take(std::int64_t now_ns) {
  while (take_one(catalogue_reader_, *catalogue_)) has_catalogue_ = true;
  while (take_one(health_reader_, *health_)) has_health_ = true;
  take_distances(now_ns);
  clearance_msg_ZoneState zone{};
  while (take_one(zones_reader_, zone)) zones_[zone.zone] = zone;
}

void Feed::take_distances(std::int64_t now_ns) {
  while (take_one(distances_reader_, *distances_)) {
    last_ns_ = now_ns;
    note_report();
  }
}

void Feed::note_report() {
  if (any() && (distances_->cycle <= cycle_ || distances_->scene_revision != revision_))
    begin_again();
  if (cycle_ != 0 && distances_->cycle > cycle_ + 1) missed_ += distances_->cycle - cycle_ - 1;
  cycle_ = distances_->cycle;
  revision_ = distances_->scene_revision;
  ++reports_;
  if (!distances_->minimum_known) return;
  if (smallest_.known && !(distances_->minimum.distance < smallest_.pair.distance)) return;
  smallest_ = {.known = true, .pair = distances_->minimum, .cycle = cycle_};
}

// Called when the daemon was started again, perhaps with another cell, whose ids mean other
// objects.
void Feed::begin_again() {
  ++restarts_;
  cycle_ = 0;
  smallest_ = {};
  zones_.clear();
}

const clearance_msg_Catalogue* Feed::catalogue() const noexcept {
  return has_catalogue_ && (!any() || catalogue_->scene_revision == revision_) ? &*catalogue_
                                                                               : nullptr;
}

const clearance_msg_Health* Feed::health() const noexcept {
  return has_health_ && (!any() || health_->scene_revision == revision_) ? &*health_ : nullptr;
}

std::uint32_t Feed::publishers() const {
  dds_subscription_matched_status_t status{};
  return dds_get_subscription_matched_status(distances_reader_, &status) == DDS_RETCODE_OK
             ? status.current_count
             : 0;
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
