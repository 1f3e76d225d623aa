// A partner that a test makes up on the topics of partners: it is wrong wherever the test wants.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include "monitor/dds/partner_port.hpp"
#include "monitor/files/build_info.hpp"
#include "monitor/inputs/checksum.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {

class MadePartner {
 public:
  MadePartner(const DdsOptions& dds, const Cell& cell, const char* name = "right")
      : name_(name),
        revision_(cell.scene.revision),
        reports_topic_(cell.topics.distances),
        participant_(dds),
        reports_(participant_.writer(TopicKind::kDistances, cell.topics.distances)),
        ticks_(participant_.writer(TopicKind::kPartnerTicks, cell.topics.partner_ticks,
                                   {.lease_ns = leader_lease_ns(0)})),
        states_(participant_.writer(TopicKind::kPartnerStates, cell.topics.partner_states)) {}

  // Publishes another partner's report as its own, after a change that the checksums follow.
  template <class Change>
  void report(clearance_msg_Distances message, const Change& change) {
    copy(name_, message.partner);
    message.daemon += 1;
    change(message);
    seal(message, participant_.address(reports_topic_));
    dds_write(reports_, &message);
  }
  // Leads a tick, by a clock that is behind by this time. A daemon that leads as well goes on
  // leading unless it is outranked. The tick is due in this time.
  void lead(std::int64_t behind_ns = 0, bool outranks = true, std::int64_t due_in_ns = 0) {
    clearance_msg_PartnerTick tick{};
    copy(name_, tick.partner);
    tick.daemon = kDaemonId;
    tick.start_ns = 1;
    tick.scene_revision = revision_;
    tick.term = outranks ? 1 : 0;
    tick.lineage = 1;
    tick.cycle = ++cycle_;
    tick.now_ns = tick.due_ns = dds_time() - behind_ns;
    tick.due_ns += due_in_ns;
    dds_write_ts(ticks_, &tick, dds_time() - behind_ns);
  }
  // Sends a state, which no daemon can take over.
  struct State {
    std::uint64_t revisions_later = 0;
    std::string build = kBuild;
  };
  void send(const State& state) {
    Sample<clearance_msg_PartnerState> sample;
    copy(name_, sample->partner);
    sample->daemon = kDaemonId;
    sample->build = dds_string_dup(state.build.c_str());
    sample->scene_revision = revision_ + state.revisions_later;
    sample->lineage = 1;
    sample->checksum = Checksum().value();
    dds_write(states_, &*sample);
  }

 private:
  static constexpr std::uint64_t kDaemonId = 99;
  template <std::size_t N>
  static void copy(const std::string& from, char (&to)[N]) {
    std::memset(to, 0, N);
    from.copy(to, N - 1);
  }

  std::string name_;
  std::uint64_t revision_, cycle_ = 0;
  std::string reports_topic_;
  Participant participant_;
  dds_entity_t reports_, ticks_, states_;
};

}  // namespace clearance::test
