#include "monitor/client/report_judge.hpp"

#include <algorithm>
#include <array>

#include "monitor/wire/report_checksum.hpp"

namespace clearance::client {

const char* name(ReportError error) noexcept {
  constexpr std::array kNames = {
      "good",         "nothing heard", "silent",  "old",           "clocks disagree",
      "other source", "repeated",      "corrupt", "other address", "share"};
  const auto index = static_cast<std::size_t>(error);
  return index < kNames.size() ? kNames[index] : "";
}

template <class Message>
ReportError ReportJudge::refuse(const Message& message, std::int64_t at_ns) noexcept {
  using enum ReportError;
  ReportError error = delivery_error(message, address_);
  if (error == kGood && checker_.has_had(message)) error = kRepeated;
  if (error != kGood) note(error, true, at_ns);
  return error;
}

// Another source is a fault while a daemon on its own is heard: one that starts again comes after a
// silence. Of partners, PartnerMerge chooses the report; other messages do not name who leads.
template <class Message>
ReportCheck ReportJudge::check(const Message& message, std::int64_t realtime_ns,
                               std::int64_t at_ns) noexcept {
  using enum ReportError;
  bool is_alone = false;
  if constexpr (requires { message.partner; }) is_alone = *message.partner == '\0';
  ReportCheck found = checker_.check(message, realtime_ns);
  // No message counts for longer than the interval of errors, whatever it states.
  const std::int64_t stated_ns = std::min(message.period_ns, limits_.error_interval_ns / 2);
  limit_ns_ = limits_.period_ns > 0 ? limits_.period_ns
              : stated_ns > 0       ? 2 * stated_ns
                                    : limits_.old_after_ns;
  const bool is_replay = message.publish_ns == 0;
  found.error = found.other_daemon                      ? kOtherSource
                : found.age_ns < -limit_ns_             ? kClocksDisagree
                : is_replay || found.age_ns > limit_ns_ ? kOld
                                                        : kGood;
  if (found.error != kGood) {
    const bool is_masquerade = found.error == kOtherSource && is_alone && at_ns <= good_until_ns_;
    note(found.error, is_masquerade, at_ns);
  } else {
    failed_ = kGood;
    good_until_ns_ = at_ns + limit_ns_ - std::max<std::int64_t>(0, found.age_ns);
  }
  return found;
}

ReportError ReportJudge::error(std::int64_t at_ns) const noexcept {
  using enum ReportError;
  if (is_held()) return held_by_;
  if (failed_ != kGood && at_ns - failed_ns_ <= limit_ns_) return failed_;
  if (good_until_ns_ == 0) return kNothingHeard;
  return failed_ != kGood || at_ns > good_until_ns_ ? kSilent : kGood;
}

void ReportJudge::acknowledge() noexcept {
  checker_ = ReportChecker(limits_.old_after_ns);
  failed_ = held_by_ = ReportError::kGood;
  good_until_ns_ = fault_ns_ = 0;
}

// A message that comes too late says nothing about the channel, so it does not hold.
void ReportJudge::note(ReportError error, bool is_faulty, std::int64_t at_ns) noexcept {
  failed_ = error;
  failed_ns_ = at_ns;
  if (!is_faulty) return;
  if (fault_ns_ != 0 && at_ns - fault_ns_ <= limits_.error_interval_ns) held_by_ = error;
  fault_ns_ = at_ns;
}

template ReportError ReportJudge::refuse(const clearance_msg_Distances&, std::int64_t) noexcept;
template ReportError ReportJudge::refuse(const clearance_msg_Gradients&, std::int64_t) noexcept;
template ReportError ReportJudge::refuse(const clearance_msg_Separation&, std::int64_t) noexcept;
template ReportCheck ReportJudge::check(const clearance_msg_Distances&, std::int64_t,
                                        std::int64_t) noexcept;
template ReportCheck ReportJudge::check(const clearance_msg_Gradients&, std::int64_t,
                                        std::int64_t) noexcept;
template ReportCheck ReportJudge::check(const clearance_msg_Separation&, std::int64_t,
                                        std::int64_t) noexcept;

}  // namespace clearance::client
