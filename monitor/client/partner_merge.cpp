#include "monitor/client/partner_merge.hpp"

#include <utility>

#include "monitor/wire/report_checksum.hpp"

namespace clearance::client {

const char* name(PartnerState state) noexcept {
  constexpr std::array kNames = {"alone",        "agrees",    "missing",
                                 "other inputs", "different", "corrupt"};
  const auto index = static_cast<std::size_t>(state);
  return index < kNames.size() ? kNames[index] : "";
}

// Cycles decide between partners that agree. Time decides where they do not count alike: the one
// that counts lower takes the other's place when that has been silent for more than a period.
bool PartnerMerge::is_next(const clearance_msg_Distances& report) const noexcept {
  if (cycle_ == 0) return true;
  const std::int64_t newer_ns = report.now_ns - now_ns_;
  if (report.cycle > cycle_) return newer_ns > 0;
  return report.lineage != lineage_ && newer_ns > step_ns_ + step_ns_ / 2;
}

bool PartnerMerge::take(const clearance_msg_Distances& report) {
  const bool is_delivered_whole =
      report.delivery_checksum == 0 || delivery_checksum_of(report) == report.delivery_checksum;
  was_good_ = checksum_of(report) == report.checksum && is_delivered_whole;
  if (!was_good_) {
    note(PartnerState::kCorrupt, report);
    return false;
  }
  note_names(report);
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
  if (report.cycle == cycle_ + 1) step_ns_ = report.now_ns - now_ns_;
  cycle_ = report.cycle;
  lineage_ = report.lineage;
  now_ns_ = report.now_ns;
  seen_[cycle_ % kSeen] = {cycle_, report.daemon, lineage_, report.state_checksum, false};
  return true;
}

void PartnerMerge::compare(const clearance_msg_Distances& report) {
  Seen& other = seen_[report.cycle % kSeen];
  if (other.cycle != report.cycle || other.daemon == report.daemon) return;
  other.is_compared = true;
  if (other.lineage != report.lineage) return note(PartnerState::kOtherInputs, report);
  const bool same = other.state_checksum == report.state_checksum;
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
