// The scene and the division into shares that a joined report is of: those that most shares have.
#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "monitor/client/share_readers.hpp"
#include "monitor/client/shared_cell.hpp"

namespace clearance::client {

bool SharedCell::is_here(const ShareStreams& share) const {
  const clearance_msg_Distances& report = *share.current.latest;
  return report.scene_revision != 0 && joined_ns_ - report.publish_ns < late_ns_;
}

// SharedCellOptions::late_after if it is not set, ns; without a rate, its least value.
std::int64_t late_after(double rate_hz) {
  constexpr double kPeriods = 3.0, kMost = 60.0;  // kMost: s
  if (!(rate_hz > 0.0)) return kLeastLate;
  const double seconds = std::min(kPeriods / rate_hz, kMost);
  return std::max(kLeastLate, static_cast<std::int64_t>(1e9 * seconds));
}

// The scene that most shares have; among equally many, the one in use, or that of the first share.
std::uint64_t SharedCell::scene_of_most() const {
  std::map<std::uint64_t, int> counts;
  for (const auto& share : shares_) {
    const std::uint64_t revision = share->current.latest->scene_revision;
    if (is_here(*share) && catalogue_of(revision) != nullptr) ++counts[revision];
  }
  std::uint64_t best = map_.revision();
  for (const auto& share : shares_) {
    const std::uint64_t revision = share->current.latest->scene_revision;
    const bool is_first = best == 0 && catalogue_of(revision) != nullptr;
    if (is_first || counts[revision] > counts[best]) best = revision;
  }
  return best;
}

// The shares change one after another. Until all have the next scene, with its names and zones,
// each counts with its last report of this one. That is so only while none of these is late.
bool SharedCell::can_stay(std::uint64_t next) const {
  bool has_next = true, has_this = catalogue() != nullptr;
  for (const auto& share : shares_) {
    if (!is_here(*share)) continue;
    has_next = has_next && share->is_heard_in(next);
    has_this = has_this && share->report_of(map_.revision(), joined_ns_) != nullptr;
  }
  return has_this && !has_next;
}

// The division of that scene that most shares have; among equally many, the one in use, or that of
// the first share.
std::uint64_t SharedCell::division_of_most(std::uint64_t revision) const {
  std::map<std::uint64_t, int> counts;
  std::uint64_t best = revision == map_.revision() ? map_.division() : 0;
  for (const auto& share : shares_) {
    const std::uint64_t division = share->division(revision, share->current.latest->daemon);
    if (division == 0) continue;
    if (best == 0) best = division;
    ++counts[division];
  }
  for (const auto& [division, count] : counts) best = count > counts[best] ? division : best;
  return best;
}

// Returns false if the shares have other names in that scene: they are met anew.
bool SharedCell::follow_revision() {
  const std::uint64_t best = scene_of_most();
  const std::uint64_t division = division_of_most(best);
  const bool is_same = best == map_.revision();
  if (is_same && division == map_.division() && catalogue() != nullptr) return true;
  if (!is_same && can_stay(best)) return true;
  for (const auto& share : shares_) {
    const clearance_msg_Catalogue* const found =
        best == 0 ? share->catalogue.message() : share->catalogue.message(best);
    if (found == nullptr) continue;
    ShareMap map(*found);
    if (best != 0 && map.division() != division) continue;
    std::vector<std::string> names;
    for (const auto& each : shares_) names.push_back(each->name);
    if (map.names() != names) {
      if (map.names().empty()) return true;
      open(map.names());
      return false;
    }
    map_ = std::move(map);
    if (!options_.late_after) set_late(late_after(found->rate_hz));
    return true;
  }
  return true;
}

void SharedCell::set_late(std::int64_t late_ns) {
  late_ns_ = late_ns;
  for (const auto& share : shares_) share->late_ns = late_ns;
}

const clearance_msg_Catalogue* SharedCell::catalogue() const noexcept {
  return catalogue_of(map_.revision());
}

const clearance_msg_Catalogue* SharedCell::catalogue_of(std::uint64_t revision) const noexcept {
  for (const auto& share : shares_) {
    const auto* const found = share->catalogue.message(revision);
    if (found != nullptr) return found;
  }
  return nullptr;
}

// Daemons of two builds may divide one scene at different pairs. Each report is then true, but some
// pair may be in none of them.
bool SharedCell::is_divided_alike(std::size_t share) const {
  const clearance_msg_Distances& report = *shares_[share]->used;
  return share < map_.names().size() && report.pairs_total == map_.pairs(share) &&
         shares_[share]->division(map_.revision(), report.daemon) == map_.division();
}

}  // namespace clearance::client
