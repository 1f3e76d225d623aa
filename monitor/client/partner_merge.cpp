#include "monitor/client/partner_merge.hpp"

#include <utility>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/wire/report_checksum.hpp"

namespace clearance::client {

const char* name(PartnerState state) noexcept {
  constexpr std::array kNames = {"alone",        "agrees",    "missing",
                                 "other inputs", "different", "corrupt"};
  const auto index = static_cast<std::size_t>(state);
  return index < kNames.size() ? kNames[index] : "";
}

// Cycles decide between partners that agree. Time decides where they do not count alike: the one
// that counts lower takes the other's place when that has been silent for more than a period. A
// report that was handed out with a wrong cycle or time does not keep out those after it.
bool PartnerMerge::is_next(const clearance_msg_Distances& report) const noexcept {
  if (cycle_ == 0) return true;
  const bool is_older = report.now_ns < now_ns_;
  const std::int64_t newer_ns = elapsed(now_ns_, report.now_ns);
  if (report.cycle > cycle_) return newer_ns > 0 || (is_older && contradicts(report));
  return newer_ns - newer_ns / 3 > step_ns_;
}

// Within a lineage a later cycle has a later time.
bool PartnerMerge::contradicts(const clearance_msg_Distances& report) const noexcept {
  return cycle_ != 0 && report.lineage == lineage_ &&
         (report.cycle > cycle_) != (report.now_ns > now_ns_);
}

bool PartnerMerge::take(const clearance_msg_Distances& report) {
  const bool is_delivered_whole =
      report.delivery_checksum == 0 || delivery_checksum_of(report) == report.delivery_checksum;
  if (checksum_of(report) != report.checksum || !is_delivered_whole) {
    note(PartnerState::kCorrupt, report);
    return false;
  }
  note_names(report);
  if (contradicts(report)) note(PartnerState::kDifferent, report);
  if (!is_next(report)) {
    compare(report);
    return false;
  }
  const Seen& before = seen_[cycle_ % kSeen];
  check_ = std::exchange(found_, {});
  const bool has_partner = !names_[1].empty();
  if (check_.state == PartnerState::kAlone && has_partner && cycle_ != 0 && !before.is_compared) {
    check_ = {PartnerState::kMissing, cycle_, names_[0] == report.partner ? names_[1] : names_[0]};
  }
  if (report.cycle == cycle_ + 1) step_ns_ = elapsed(now_ns_, report.now_ns);
  cycle_ = report.cycle;
  lineage_ = report.lineage;
  now_ns_ = report.now_ns;
  seen_[cycle_ % kSeen] = {.cycle = cycle_,
                           .daemon = report.daemon,
                           .lineage = lineage_,
                           .checksum = report.checksum,
                           .state_checksum = report.state_checksum,
                           .inputs_checksum = inputs_checksum_of(report)};
  return true;
}

void PartnerMerge::compare(const clearance_msg_Distances& report) {
  Seen& other = seen_[report.cycle % kSeen];
  if (other.cycle != report.cycle || other.daemon == report.daemon) return;
  other.is_compared = true;
  if (other.lineage != report.lineage) return note(PartnerState::kOtherInputs, report);
  const bool same = other.checksum == report.checksum &&
                    other.state_checksum == report.state_checksum &&
                    other.inputs_checksum == inputs_checksum_of(report);
  note(same ? PartnerState::kAgrees : PartnerState::kDifferent, report);
}

// The worst is told.
void PartnerMerge::note(PartnerState state, const clearance_msg_Distances& report) {
  if (state >= found_.state) found_ = {state, report.cycle, report.partner};
}

void PartnerMerge::note_names(const clearance_msg_Distances& report) {
  if (names_[0] == report.partner) return;
  names_[1] = std::exchange(names_[0], report.partner);
}

}  // namespace clearance::client
