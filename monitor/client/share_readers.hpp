// The readers of one share of a cell: the inside of SharedCell.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "config/cell/share_topics.hpp"
#include "monitor/client/sequence_view.hpp"
#include "monitor/client/shared_cell.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance::client {

// A zone's state that a daemon wrote holds for this long after the last report of that daemon,
// since its partner may have written nothing since.
inline constexpr std::int64_t kHeardFor = 1'000'000'000;

// The least time after which a share is late, ns, unless the caller states one.
inline constexpr std::int64_t kLeastLate = 20'000'000;

// The last message of each of two scenes: while the shares change one after another, the former one
// still counts.
template <class Message>
struct OfTwoScenes {
  Sample<Message> latest, former;

  // Makes room for the next message, which is of this scene.
  void before_next(std::uint64_t revision) {
    if (latest->scene_revision != revision) std::swap(*latest, *former);
  }
  // Null: neither is of that scene.
  [[nodiscard]] const Message* of(std::uint64_t revision) const {
    if (revision == 0) return nullptr;
    if (latest->scene_revision == revision) return &*latest;
    return former->scene_revision == revision ? &*former : nullptr;
  }
  template <class Stream>
  void take_all(Stream& stream) {
    while (stream.next()) {
      before_next(stream->scene_revision);
      stream.exchange(latest);
    }
  }
};

// A share with all its readers.
struct SharedCell::ShareStreams {
  ShareStreams(Connection& whole, std::string of, std::int64_t late, bool has_gradients)
      : name(std::move(of)),
        late_ns(late),
        connection(whole.participant().handle(), whole.participant().partition(),
                   topics_of_share(whole.topics(), name)),
        reports(connection),
        separations(connection),
        catalogue(connection),
        health(connection),
        zones(connection.participant(), TopicKind::kZones, connection.topics().zones, true) {
    if (has_gradients) gradients.emplace(connection);
  }
  ~ShareStreams() { dds_delete(zones.entity()); }

  [[nodiscard]] bool is_held() const noexcept {
    return reports.is_held() || separations.is_held() || (gradients && gradients->is_held());
  }
  void acknowledge() noexcept {
    reports.acknowledge();
    separations.acknowledge();
    if (gradients) gradients->acknowledge();
  }
  // Up to two reports: the second one waits while the first one is not used yet.
  void take(std::int64_t now_ns) {
    while (!has_ahead && reports.next()) {
      came_at = heard[reports->daemon] = monotonic_ns();
      missed += reports.check().missed;
      const PartnerCheck& now = reports.partner();
      partner = std::exchange(partner_is_old, false) ? now : worse(partner, now);
      if (!is_new) current.before_next(reports->scene_revision);
      reports.exchange(is_new ? ahead : current.latest);
      (is_new ? has_ahead : is_new) = true;
    }
    taken_at = monotonic_ns();
    // The zones of a partner count whose reports come, although those of the other one come first.
    for (const PartnerMerge::Sender& sender : reports.senders()) {
      std::int64_t& before_ns = sender_heard_ns[sender.daemon];
      if (std::exchange(before_ns, sender.heard_ns) != sender.heard_ns)
        heard[sender.daemon] = taken_at;
    }
    std::erase_if(sender_heard_ns, [this](const auto& one) {
      return std::ranges::count(reports.senders(), one.first, &PartnerMerge::Sender::daemon) == 0;
    });
    std::erase_if(heard, [&](const auto& one) { return one.second + kHeardFor < taken_at; });
    separation.take_all(separations);
    if (gradients) gradient.take_all(*gradients);
    look_for_names();
    clearance_msg_ZoneState state{};
    dds_sample_info_t info;
    while (zones.take(state, info)) {
      note(state, now_ns);
      writer_of[state.daemon] = info.publication_handle;
    }
  }
  void look_for_names() {
    catalogue.update([this](const clearance_msg_Catalogue& names) {
      divisions.push_front({names.daemon, names.scene_revision, division_of(names)});
      if (divisions.size() > 2 * Catalogue::kKept) divisions.pop_back();
    });
  }
  // The division of that scene by the daemon of its last report. Partners may be of two builds:
  // that of the other one counts only until the daemon's own catalogue has come. 0: none has come.
  [[nodiscard]] std::uint64_t division(std::uint64_t revision, std::uint64_t daemon) const {
    std::uint64_t of_share = 0;
    for (const Division& each : divisions) {
      if (each.revision != revision) continue;
      if (each.daemon == daemon) return each.hash;
      if (of_share == 0) of_share = each.hash;
    }
    return of_share;
  }
  // Keeps the state at the last report of the former scene, as long as that counts, and all later
  // ones. If a zone has more of them than kMost, that state is unknown.
  void note(const clearance_msg_ZoneState& state, std::int64_t now_ns) {
    constexpr std::size_t kMost = 64;
    const bool counts = less(now_ns, current.former->publish_ns) <= late_ns;
    const std::int64_t first_ns = (counts ? current.former : current.latest)->now_ns;
    if (!states.contains({state.zone, state.daemon})) forget_gone(state.daemon);
    auto& all = states[{state.zone, state.daemon}];
    all.push_back(state);
    while (all.size() > 1 && (all[1].now_ns <= first_ns || all.size() > kMost)) all.pop_front();
  }
  // A daemon whose reports come no more, without one that is kept, is gone or was cut off. In the
  // latter case DDS sends its states again.
  void forget_gone(std::uint64_t but) {
    if (states.empty()) return;
    const auto writers = writers_of(zones.entity());
    std::erase_if(states, [&](const auto& one) {
      const std::uint64_t daemon = one.first.second;
      const bool is_kept = daemon == but || daemon == current.latest->daemon ||
                           daemon == current.former->daemon || daemon == ahead->daemon;
      return !is_kept && !hears(daemon) && std::ranges::count(writers, writer_of[daemon]) == 0;
    });
    std::erase_if(writer_of, [&](const auto& one) {
      return std::ranges::none_of(states,
                                  [&](const auto& of) { return of.first.second == one.first; });
    });
  }
  [[nodiscard]] bool hears(std::uint64_t daemon) const { return heard.contains(daemon); }
  void use() {
    is_new = false;
    if (!has_ahead) return;
    current.before_next(ahead->scene_revision);
    std::swap(*current.latest, *ahead);
    is_new = true;
    has_ahead = false;
  }
  // The report of that scene that counts now: the latest one, or the last one of the former scene
  // as long as that is not late. Null: there is none.
  [[nodiscard]] const clearance_msg_Distances* report_of(std::uint64_t revision,
                                                         std::int64_t now_ns) const {
    const clearance_msg_Distances* const report = current.of(revision);
    const bool is_former = report == &*current.former;
    return is_former && less(now_ns, report->publish_ns) > late_ns ? nullptr : report;
  }
  // The last state at the time of this report that was written by a daemon whose reports come now.
  // Partners tick the same times. With the latest report, later states count, too.
  [[nodiscard]] const clearance_msg_ZoneState* zone(std::uint32_t id, std::string_view zone_name,
                                                    const clearance_msg_Distances& report) const {
    const std::int64_t until_ns =
        &report == &*current.former ? report.now_ns : std::numeric_limits<std::int64_t>::max();
    const clearance_msg_ZoneState* latest = nullptr;
    for (auto at = states.lower_bound({id, 0}); at != states.end() && at->first.first == id; ++at) {
      const std::uint64_t daemon = at->first.second;
      const bool counts = *report.partner != '\0' ? hears(daemon) : daemon == report.daemon;
      if (!counts) continue;
      for (const clearance_msg_ZoneState& state : at->second) {
        if (state.now_ns > until_ns) continue;
        if (zone_name.substr(0, sizeof state.name - 1) != state.name) continue;
        if (latest == nullptr || latest->daemon == daemon || state.now_ns > latest->now_ns ||
            (state.now_ns == latest->now_ns && state.active)) {
          latest = &state;
        }
      }
    }
    return latest;
  }

  // The latest report is of that scene, whose names have come, and so have the states of all zones
  // that have a pair of this share.
  [[nodiscard]] bool is_heard_in(std::uint64_t revision) const {
    const clearance_msg_Catalogue* const names = catalogue.message(revision);
    if (current.latest->scene_revision != revision || names == nullptr) return false;
    for (const clearance_msg_CatalogueShare& share : list(names->shares)) {
      if (name != share.name) continue;
      const bool has_all = std::ranges::all_of(list(names->zones), [&](const auto& of) {
        const auto ids = list(share.zones);
        return std::ranges::find(ids, of.id) == ids.end() ||
               zone(of.id, of.name, *current.latest) != nullptr;
      });
      if (!has_all) return false;
    }
    return true;
  }

  // A first report has come, and all that belongs to it.
  [[nodiscard]] bool is_heard() const {
    return current.latest->cycle != 0 && is_heard_in(current.latest->scene_revision);
  }

  std::string name;
  std::int64_t late_ns;
  Connection connection;
  Reports reports;
  client::Separation separations;
  std::optional<Gradients> gradients;  // none: they are not asked for
  Catalogue catalogue;
  struct Division {
    std::uint64_t daemon, revision, hash;
  };
  std::deque<Division> divisions;  // by the catalogues of this share, the latest one first
  client::Health health;
  HealthCounts counted;
  CheckedReader zones;
  OfTwoScenes<clearance_msg_Distances> current;
  OfTwoScenes<clearance_msg_Separation> separation;
  OfTwoScenes<clearance_msg_Gradients> gradient;
  Sample<clearance_msg_Distances> ahead;
  const clearance_msg_Distances* used = nullptr;  // in the joined report; one of `current`
  bool is_new = false, has_ahead = false;
  std::uint64_t missed = 0;
  PartnerCheck partner;                         // the worst since the previous call of SharedCell
  bool partner_is_told = false;                 // the caller knows `partner`
  bool partner_is_old = false;                  // the caller has called again since
  std::int64_t taken_at = 0, came_at = 0;       // the last take() and report, by monotonic_ns()
  std::map<std::uint64_t, std::int64_t> heard;  // daemons, and when their last report came
  std::map<std::uint64_t, std::int64_t> sender_heard_ns;     // of reports.senders(), by daemon
  std::map<std::uint64_t, dds_instance_handle_t> writer_of;  // of zones, by daemon
  // By zone and daemon, in the order in which they came.
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::deque<clearance_msg_ZoneState>> states;
};

}  // namespace clearance::client
