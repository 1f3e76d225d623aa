#include "monitor/recording/recorded_event.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace clearance {
namespace {

using Cause = RecordedEvent::Cause;

bool is_violated(const ContactReport& contact) {
  return contact.status == ContactStatus::kTooDeep || contact.status == ContactStatus::kTooLate;
}

}  // namespace

const char* name(RecordedEvent::Cause cause) noexcept {
  switch (cause) {
    case Cause::kZone:
      return "zone";
    case Cause::kFault:
      return "fault";
    case Cause::kCommand:
      return "command";
  }
  return "";
}

std::optional<RecordedEvent> EventWatch::find(const Report& report, const Scene& scene) {
  const std::uint64_t total =
      std::accumulate(report.rejected.begin(), report.rejected.end(), std::uint64_t{0});
  const bool refuses = std::exchange(rejected_, total) < total;
  const bool was_quiet =
      !rejected_ns_ || report.now_ns < *rejected_ns_ || report.now_ns - *rejected_ns_ >= quiet_ns_;
  if (refuses) rejected_ns_ = report.now_ns;
  const std::uint32_t unsure = report.stale + report.unknown;
  const bool was_unsure = std::exchange(was_unsure_, unsure > 0);
  const auto violated = std::ranges::find_if(report.contacts, is_violated);
  const bool too_deep = violated != report.contacts.end();
  const bool was_too_deep = std::exchange(was_too_deep_, too_deep);

  for (std::size_t zone = 0; zone < report.zones.size(); ++zone) {
    if (report.zones[zone].changed && report.zones[zone].active)
      return RecordedEvent{Cause::kZone,
                           fmt::format("zone '{}' is entered ({})", scene.zones[zone].name,
                                       name(report.zones[zone].cause))};
  }
  if (unsure > 0 && !was_unsure)
    return RecordedEvent{Cause::kFault, fmt::format("{} pairs are stale and {} unknown",
                                                    report.stale, report.unknown)};
  if (too_deep && !was_too_deep)
    return RecordedEvent{Cause::kFault,
                         fmt::format("an allowed contact is {}", name(violated->status))};
  if (refuses && was_quiet) return RecordedEvent{Cause::kFault, "samples are refused"};
  return std::nullopt;
}

}  // namespace clearance
