// The readers of one share of a cell: the inside of SharedCell.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "config/cell/share_topics.hpp"
#include "monitor/client/sequence_view.hpp"
#include "monitor/client/shared_cell.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance::client {

// A zone's state that a daemon wrote holds for this long after the last report of that daemon,
// since its partner may have written nothing since.
inline constexpr std::int64_t kHeardFor = 1'000'000'000;

// A share with all its readers.
struct SharedCell::OfShare {
  OfShare(Connection& whole, std::string of, const SharedCellOptions& options)
      : name(std::move(of)),
        connection(whole.participant().handle(), whole.participant().partition(),
                   topics_of_share(whole.topics(), name)),
        reports(connection, {.old_after = options.late_after}),
        separations(connection),
        catalogue(connection),
        health(connection),
        zones(connection.participant().reader_of_several(TopicKind::kZones,
                                                         connection.topics().zones)) {
    if (options.gradients) gradients.emplace(connection);
  }
  ~OfShare() { dds_delete(zones); }

  // Up to two reports: the second one waits while the first one is not used yet.
  void take(std::int64_t now_ns) {
    while (!has_ahead && reports.next()) {
      reports.exchange(is_new ? ahead : current);
      (is_new ? has_ahead : is_new) = true;
      missed += reports.check().missed;
      heard[(has_ahead ? ahead : current)->daemon] = now_ns;
    }
    std::erase_if(heard, [now_ns](const auto& one) { return one.second + kHeardFor < now_ns; });
    while (separations.next()) {
    }
    while (gradients && gradients->next()) {
    }
    catalogue.update();
    clearance_msg_ZoneState state{};
    void* pointer = &state;
    dds_sample_info_t info;
    while (dds_take(zones, &pointer, &info, 1, 1) > 0) {
      if (info.valid_data) states[{state.zone, state.daemon}] = state;
    }
  }
  void use() {
    is_new = false;
    if (!has_ahead) return;
    std::swap(*current, *ahead);
    is_new = true;
    has_ahead = false;
  }
  // The last state that was written by a daemon whose reports come now. Partners tick the same
  // times.
  [[nodiscard]] const clearance_msg_ZoneState* zone(std::uint32_t id,
                                                    std::string_view zone_name) const {
    const clearance_msg_ZoneState* latest = nullptr;
    for (auto at = states.lower_bound({id, 0}); at != states.end() && at->first.first == id; ++at) {
      const clearance_msg_ZoneState& state = at->second;
      const bool counts = *current->partner != '\0' ? heard.contains(state.daemon)
                                                    : state.daemon == current->daemon;
      if (!counts || zone_name.substr(0, sizeof state.name - 1) != state.name) continue;
      if (latest == nullptr || state.now_ns > latest->now_ns ||
          (state.now_ns == latest->now_ns && state.active)) {
        latest = &state;
      }
    }
    return latest;
  }

  // A report has come, and the states of all zones that have a pair of this share.
  [[nodiscard]] bool is_heard() const {
    const clearance_msg_Catalogue* const names = catalogue.message();
    if (current->cycle == 0 || names == nullptr) return false;
    for (const clearance_msg_CatalogueShare& share : list(names->shares)) {
      if (name != share.name) continue;
      const bool has_all = std::ranges::all_of(list(names->zones), [&](const auto& of) {
        const auto ids = list(share.zones);
        return std::ranges::find(ids, of.id) == ids.end() || zone(of.id, of.name) != nullptr;
      });
      if (!has_all) return false;
    }
    return true;
  }

  std::string name;
  Connection connection;
  Reports reports;
  client::Separation separations;
  std::optional<Gradients> gradients;  // none: they are not asked for
  Catalogue catalogue;
  client::Health health;
  dds_entity_t zones;
  Sample<clearance_msg_Distances> current, ahead;
  bool is_new = false, has_ahead = false;
  std::uint64_t missed = 0;
  std::map<std::uint64_t, std::int64_t> heard;  // daemons, and when their last report came
  std::map<std::pair<std::uint32_t, std::uint64_t>, clearance_msg_ZoneState> states;
};

}  // namespace clearance::client
