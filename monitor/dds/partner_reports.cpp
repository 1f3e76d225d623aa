#include "monitor/dds/partner_reports.hpp"

#include <algorithm>

#include "monitor/app/log_line.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/wire/report_checksum.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kTellAgainNs = 1'000'000'000;
// A partner's report of a cycle is missing when this daemon publishes the second one after it.
constexpr std::uint64_t kLateBy = 2;

template <std::size_t N>
void copy_name(const std::string& from, char (&to)[N]) {
  from.copy(to, N - 1);
}

}  // namespace

bool PartnerReports::may_tell(Kind kind) {
  const std::int64_t now = SystemClock().monotonic_ns();
  if (told_ns_[kind] != 0 && now - told_ns_[kind] < kTellAgainNs) return false;
  told_ns_[kind] = now;
  return true;
}

void PartnerReports::note(const clearance_msg_Distances& report, bool is_other) {
  const Lock lock(mutex_);
  const Kept kept{report.cycle,
                  report.lineage,
                  compared_checksum(report),
                  report.state_checksum,
                  inputs_checksum_of(report),
                  report.publish_ns};
  (is_other ? other_ : own_)[report.cycle % kKept] = kept;
  const Kept& counterpart = (is_other ? own_ : other_)[report.cycle % kKept];
  if (is_other) {
    name_ = report.partner;
    heard_ns_ = SystemClock().monotonic_ns();
  }
  if (counterpart.cycle == report.cycle) {
    is_other ? compare(counterpart, kept) : compare(kept, counterpart);
  }
  if (!is_other && report.cycle > kLateBy) look_for_missing(report.cycle - kLateBy);
}

// Reports of one lineage rest on the same inputs. Those of another one may be alike by chance, and
// need not be.
void PartnerReports::compare(const Kept& own, const Kept& other) {
  if (phases_.size() < 4096) phases_.push_back(less(own.publish_ns, other.publish_ns));
  if (own.lineage != other.lineage) {
    ++other_inputs_;
    if (agrees_from_ != 0 && may_tell(kOtherInputs))
      log_line(lines::kPartnerOtherInputs, name_, own.cycle);
    agrees_from_ = 0;
    return;
  }
  ++compared_;
  if (own.checksum != other.checksum || own.state_checksum != other.state_checksum ||
      own.inputs_checksum != other.inputs_checksum) {
    ++different_;
    agrees_from_ = 0;
    if (may_tell(kDifferent)) log_line(lines::kPartnerDiffers, name_, own.cycle, different_);
    return;
  }
  if (agrees_from_ != 0) return;
  agrees_from_ = own.cycle;
  if (may_tell(kAgrees)) log_line(lines::kPartnerAgrees, name_, own.cycle);
}

// Any field of a corrupt report may be wrong, even the name, so none is kept.
void PartnerReports::note_corrupt(const clearance_msg_Distances& report) {
  const Lock lock(mutex_);
  ++different_;
  agrees_from_ = 0;
  if (may_tell(kCorrupt))
    log_line(lines::kPartnerCorrupt, report.partner, report.cycle, different_);
}

// A partner counts as missing only if it has been heard before.
void PartnerReports::look_for_missing(std::uint64_t cycle) {
  if (heard_ns_ == 0 || other_[cycle % kKept].cycle == cycle) return;
  if (own_[cycle % kKept].cycle != cycle) return;
  const bool is_gone = SystemClock().monotonic_ns() - heard_ns_ > kLateAfterNs;
  if (is_gone && agrees_from_ == 0) return;
  ++missing_;
  if (agrees_from_ != 0 && may_tell(kMissing)) log_line(lines::kPartnerMissing, name_, cycle);
  agrees_from_ = is_gone ? 0 : agrees_from_;
}

bool PartnerReports::hears_any(std::int64_t within_ns) {
  const Lock lock(mutex_);
  return heard_ns_ != 0 && SystemClock().monotonic_ns() - heard_ns_ < within_ns;
}

bool PartnerReports::disagrees() {
  const Lock lock(mutex_);
  return agrees_from_ == 0 && heard_ns_ != 0;
}

std::string PartnerReports::name() {
  const Lock lock(mutex_);
  return name_;
}

bool PartnerReports::hears_another(const std::string& partner) {
  const Lock lock(mutex_);
  return heard_ns_ != 0 && name_ != partner &&
         SystemClock().monotonic_ns() - heard_ns_ < kLateAfterNs;
}

void PartnerReports::fill(clearance_msg_PartnerHealth& out) {
  const Lock lock(mutex_);
  copy_name(name_, out.other);
  out.other_publishes = heard_ns_ != 0 && SystemClock().monotonic_ns() - heard_ns_ < kTellAgainNs;
  out.agrees_from = agrees_from_;
  out.compared = compared_;
  out.different = different_;
  out.other_inputs = other_inputs_;
  out.missing = missing_;
  if (!phases_.empty()) {
    const auto middle = phases_.begin() + static_cast<std::ptrdiff_t>(phases_.size() / 2);
    std::ranges::nth_element(phases_, middle);
    phase_ns_ = *middle;
    phases_.clear();
  }
  out.phase_ns = phase_ns_;
}

}  // namespace clearance
