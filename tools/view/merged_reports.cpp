#include "tools/view/merged_reports.hpp"

#include <fmt/format.h>

namespace clearance::view {
namespace {

// A person can read what was so for a moment.
constexpr std::int64_t kToldForNs = 1'000'000'000;
// Health comes once per second.
constexpr std::int64_t kNoLeaderNs = 3'000'000'000;

bool is_recent(std::int64_t then_ns, std::int64_t now_ns, std::int64_t limit_ns) {
  return then_ns != 0 && now_ns - then_ns < limit_ns;
}

}  // namespace

bool MergedReports::take(const clearance_msg_Distances& report, std::int64_t steady_ns,
                         bool is_sound) {
  using enum client::PartnerState;
  if (*report.partner == '\0' && report.checksum == 0) {
    single_ns_ = steady_ns;
    return is_sound;
  }
  partner_ns_ = steady_ns;
  if (!merge_.take(report, steady_ns, is_sound)) return false;
  const client::PartnerCheck& check = merge_.check();
  have_met_ |= check.state != kAlone;
  const bool is_lost_here = check.state == kMissing && is_recent(lost_ns_, steady_ns, kToldForNs);
  if (check.state != kAlone && check.state != kAgrees && !is_lost_here) {
    check_ = check;
    check_ns_ = steady_ns;
  }
  return true;
}

bool MergedReports::take(const clearance_msg_Health& health, std::int64_t steady_ns) {
  if (*health.partner.partner == '\0') return true;
  if (health.partner.leads) leader_ns_ = steady_ns;
  return health.partner.leads || !is_recent(leader_ns_, steady_ns, kNoLeaderNs);
}

bool MergedReports::are_partners(std::int64_t steady_ns) const noexcept {
  return partner_ns_ != 0 && !is_recent(single_ns_, steady_ns, kToldForNs);
}

MergedReports::Trouble MergedReports::trouble(std::int64_t steady_ns) const {
  using enum client::PartnerState;
  if (partner_ns_ == 0) return {};
  if (is_recent(check_ns_, steady_ns, kToldForNs)) {
    const bool is_fault = check_.state == kDifferent || check_.state == kCorrupt;
    return {is_fault ? 2 : 1, fmt::format("partner '{}': {}", check_.partner, name(check_.state))};
  }
  if (!have_met_) return {1, "no partner yet"};
  return {};
}

}  // namespace clearance::view
