// A cell in two shares, and a daemon of one of them that a test plays over real DDS.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "config/cell/share_topics.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/wire/convert.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/sealed.hpp"

namespace clearance::client {

inline constexpr std::uint32_t kWide = 0, kFar = 1;

// The zone `wide` has pairs of both shares, `far` those of the right one.
inline Cell cell_in_shares() {
  const auto ball = [](const char* name, const char* group) {
    return std::string("  - {name: ") + name + ", groups: [all, " + group +
           "], sphere: {radius: 0.1}}\n";
  };
  return read_good(cell_text(
      "objects:\n" + ball("a", "first") + ball("b", "first") + ball("c", "last") +
      "pairs: [{between: [all, all], publish: true}]\nzones:\n"
      "  - {name: wide, between: [all, all], enter_below: 1, leave_above: 1}\n"
      "  - name: far\n    between: [first, last]\n    enter_below: 1\n    leave_above: 1\n"
      "    separation: {human: last, reaction_time_ms: 1, stopping_time_ms: 1, "
      "stopping_distance: 1, intrusion_distance: 1}\n"
      "shares:\n  - {name: left, pairs: [{between: [first, first]}]}\n"
      "  - {name: right, pairs: [{between: [first, last]}]}\n"));
}

// A daemon of a share. Partners have a name.
class ShareDaemon {
 public:
  ShareDaemon(const DdsOptions& dds, const Cell& cell, const char* share, std::uint64_t id,
              std::string partner = {})
      : topics_(topics_of_share(cell.topics, share)),
        participant_(dds),
        id_(id),
        revision_(cell.scene.revision),
        partner_(std::move(partner)) {
    for (const Share& each : cell.shares.all) {
      if (each.name == share) pairs_ = static_cast<std::uint32_t>(each.pairs.size());
    }
    auto catalogue = make_catalogue(cell);
    catalogue->daemon = id;
    test::write_sealed(participant_, catalogue_, *catalogue);
  }
  [[nodiscard]] bool is_heard() const { return test::matched_readers(distances_) > 0; }
  // Reports say from now on that it has so many pairs, or they have these bits.
  void set_pairs(std::uint32_t pairs) { pairs_ = pairs; }
  void set_bits(std::uint64_t state) { state_ = state; }
  // The clock of its machine is ahead of this one's by this time from now on.
  void set_clock_ahead(std::int64_t ns) { ahead_ns_ = ns; }
  void report(std::uint64_t cycle) { report(cycle, dds_time() + ahead_ns_); }
  void report(std::uint64_t cycle, std::int64_t publish_ns,
              std::vector<std::uint32_t> active = {}) {
    clearance_msg_Distances message{};
    message.active_zones._length = message.active_zones._maximum =
        static_cast<std::uint32_t>(active.size());
    message.active_zones._buffer = active.data();
    partner_.copy(message.partner, sizeof message.partner - 1);
    message.daemon = id_;
    message.cycle = cycle;
    message.lineage = 4;
    message.now_ns = now_ns(cycle);
    message.publish_ns = publish_ns;
    message.scene_revision = revision_;
    message.pairs_total = pairs_;
    message.state_checksum = state_;
    test::write_sealed(participant_, distances_, message);
  }
  void zones(std::uint64_t cycle, bool active) {
    for (const std::uint32_t zone : {kWide, kFar}) {
      clearance_msg_ZoneState state{};
      state.zone = zone;
      std::strcpy(state.name, zone == kWide ? "wide" : "far");
      state.daemon = id_;
      state.active = active;
      state.cause = active ? static_cast<std::uint8_t>(ZoneCause::kNear) : std::uint8_t{0};
      state.cycle = cycle;
      state.now_ns = now_ns(cycle);
      test::write_sealed(participant_, zones_, state);
    }
  }

 private:
  std::int64_t now_ns(std::uint64_t cycle) const {
    return start_ns_ + ahead_ns_ + static_cast<std::int64_t>(cycle) * 1'000'000;
  }

  inline static const std::int64_t start_ns_ = dds_time();
  std::int64_t ahead_ns_ = 0;
  Topics topics_;
  Participant participant_;
  std::uint64_t id_, revision_, state_ = 0;
  std::uint32_t pairs_ = 0;
  std::string partner_;
  dds_entity_t distances_ =
      participant_.writer(TopicKind::kDistances, topics_.distances, {.lease_ns = 60'000'000'000});
  dds_entity_t catalogue_ = participant_.writer(TopicKind::kCatalogue, topics_.catalogue);
  dds_entity_t zones_ = participant_.writer(TopicKind::kZones, topics_.zones);
};

}  // namespace clearance::client
