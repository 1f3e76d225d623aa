#include "monitor/client/partner_merge.hpp"

#include <algorithm>
#include <utility>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/wire/report_check.hpp"
#include "monitor/wire/report_checksum.hpp"

namespace clearance::client {
namespace {

constexpr std::int64_t kSilentNs = 500'000'000;

}  // namespace

const char* name(PartnerState state) noexcept {
  constexpr std::array kNames = {"alone",        "agrees",    "missing",
                                 "other inputs", "different", "corrupt"};
  const auto index = static_cast<std::size_t>(state);
  return index < kNames.size() ? kNames[index] : "";
}

bool PartnerMerge::is_silent(std::int64_t heard_ns, std::int64_t now_ns) const noexcept {
  return now_ns - heard_ns > std::max(kSilentNs, 4 * period_ns_);
}

bool PartnerMerge::changes_scene(const clearance_msg_Distances& report) const noexcept {
  return report.scene_revision != revision_ &&
         std::ranges::any_of(senders_, [&](const Sender& sender) {
           return sender.revision == revision_ && sender.daemon == report.daemon;
         });
}

// Partners may change their scene one after the other, or one of them cannot: distances of the
// former scene would leave out what the other daemon has added.
bool PartnerMerge::is_of_scene(const clearance_msg_Distances& report,
                               std::int64_t heard_ns) const noexcept {
  if (cycle_ == 0 || report.scene_revision == revision_ || changes_scene(report)) return true;
  return std::ranges::none_of(senders_, [&](const Sender& sender) {
    return sender.revision == revision_ && sender.daemon != report.daemon &&
           !is_silent(sender.heard_ns, heard_ns);
  });
}

// Cycles decide between partners that agree. Time decides where they do not count alike: the one
// that counts lower takes the other's place when that has been silent for more than a period. A
// report that was handed out with a wrong cycle or time does not keep out those after it. After a
// clock was set back there is nothing to compare: then only the silence counts.
bool PartnerMerge::is_next(const clearance_msg_Distances& report,
                           std::int64_t heard_ns) const noexcept {
  if (cycle_ == 0) return true;
  if (report.lineage != lineage_ && is_silent(handed_out_ns_, heard_ns)) return true;
  const bool is_older = report.now_ns < now_ns_;
  const std::int64_t newer_ns = elapsed(now_ns_, report.now_ns);
  if (report.cycle > cycle_) return newer_ns > 0 || (is_older && contradicts(report));
  return newer_ns - newer_ns / 3 > period_ns_;
}

// Within a lineage a later cycle has a later time.
bool PartnerMerge::contradicts(const clearance_msg_Distances& report) const noexcept {
  return cycle_ != 0 && report.lineage == lineage_ &&
         (report.cycle > cycle_) != (report.now_ns > now_ns_);
}

bool PartnerMerge::take(const clearance_msg_Distances& report, std::int64_t heard_ns,
                        bool is_sound) {
  if (!is_sound) {
    note(PartnerState::kCorrupt, report);
    return false;
  }
  // A change is handed out even if the other one was faster in this cycle: it may always be.
  const bool is_changed_cycle = report.cycle == cycle_ && changes_scene(report);
  const bool is_handed_out =
      is_of_scene(report, heard_ns) && (is_changed_cycle || is_next(report, heard_ns));
  note_sender(report, heard_ns, is_handed_out);
  if (contradicts(report)) note(PartnerState::kDifferent, report);
  if (!is_handed_out) {
    compare(report);
    return false;
  }
  const Seen& before = seen_[cycle_ % kSeen];
  check_ = std::exchange(found_, {});
  const bool has_partner = senders_[1].daemon != 0;
  if (check_.state == PartnerState::kAlone && has_partner && cycle_ != 0 && !before.is_compared) {
    check_ = {PartnerState::kMissing, cycle_, senders_[1].partner};
  }
  period_ns_ = stated_period_ns(report);
  cycle_ = report.cycle;
  lineage_ = report.lineage;
  revision_ = report.scene_revision;
  now_ns_ = report.now_ns;
  handed_out_ns_ = heard_ns;
  seen_[cycle_ % kSeen] = {.cycle = cycle_,
                           .daemon = report.daemon,
                           .lineage = lineage_,
                           .checksum = compared_checksum(report),
                           .state_checksum = report.state_checksum,
                           .inputs_checksum = inputs_checksum_of(report)};
  return true;
}

void PartnerMerge::compare(const clearance_msg_Distances& report) {
  Seen& other = seen_[report.cycle % kSeen];
  if (other.cycle != report.cycle || other.daemon == report.daemon) return;
  other.is_compared = true;
  if (other.lineage != report.lineage) return note(PartnerState::kOtherInputs, report);
  const bool same = other.checksum == compared_checksum(report) &&
                    other.state_checksum == report.state_checksum &&
                    other.inputs_checksum == inputs_checksum_of(report);
  note(same ? PartnerState::kAgrees : PartnerState::kDifferent, report);
}

// The worst is told.
void PartnerMerge::note(PartnerState state, const clearance_msg_Distances& report) {
  if (state >= found_.state) found_ = {state, report.cycle, report.partner};
}

// A change of the scene counts once it is handed out.
void PartnerMerge::note_sender(const clearance_msg_Distances& report, std::int64_t heard_ns,
                               bool is_handed_out) {
  if (senders_[0].partner != report.partner) std::swap(senders_[0], senders_[1]);
  const bool keeps_revision = senders_[0].daemon == report.daemon && !is_handed_out;
  const std::uint64_t revision = keeps_revision ? senders_[0].revision : report.scene_revision;
  senders_[0] = {report.partner, report.daemon, heard_ns, revision};
}

}  // namespace clearance::client
