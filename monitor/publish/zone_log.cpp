#include "monitor/publish/zone_log.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "monitor/app/log_line.hpp"
#include "monitor/interface/pair_name.hpp"
#include "monitor/interface/zone_cause.hpp"

namespace clearance {
namespace {

// The most zones whose flickering is told at once; the others are counted together.
constexpr std::uint64_t kZonesAtOnce = 5;

// Adds the clearance between the two ticks where it is printed differently.
std::string clearance_text(const ZoneReport& zone) {
  if (std::isinf(zone.clearance)) return "unknown";
  const std::string now = fmt::format("{:.3f}", zone.clearance);
  const std::string between = fmt::format("{:.3f}", zone.swept_clearance);
  const std::string text = fmt::format("at least {} m clear", now);
  if (now == between) return text;
  return fmt::format("{}, and at least {} m at every instant since the tick before", text, between);
}

// Logs that a zone was entered, and why, or that it was left. Only near and late zones have bounds.
void log_zone(const Scene& scene, std::uint32_t index, const ZoneReport& zone,
              std::uint64_t cycle) {
  const std::string& name = scene.zones[index].name;
  if (!zone.active) return log_line(lines::kZoneLeft, name, cycle);
  const std::string pair = pair_name(scene, zone.pair);
  const std::string cause = cause_text(scene, zone);
  switch (zone.cause) {
    case ZoneCause::kLate:
      return log_line(lines::kZoneLate, name, cycle, cause, pair, clearance_text(zone));
    case ZoneCause::kUnknown:
      return log_line(lines::kZoneUnknown, name, cycle, cause, pair);
    case ZoneCause::kContradicted:
      return log_line(lines::kZoneContradicted, name, cycle, cause, pair);
    case ZoneCause::kDiscontinuous:
      return log_line(lines::kZoneDiscontinuous, name, cycle, cause, pair);
    case ZoneCause::kContactTooDeep:
      return log_line(lines::kZoneContactTooDeep, name, cycle, cause, pair);
    case ZoneCause::kContactTooLate:
      return log_line(lines::kZoneContactTooLate, name, cycle, cause, pair);
    default:
      return log_line(lines::kZoneNear, name, cycle, cause, pair, clearance_text(zone));
  }
}

}  // namespace

void ZoneLog::note(std::uint32_t zone, const ZoneReport& report, std::uint64_t cycle) {
  Zone& of = zones_[scene_->zones[zone].name];
  of.active = report.active;
  if (of.lines >= kLinesOfAZone || lines_ >= kLinesOfAll) {
    ++of.left_out;
    return;
  }
  ++of.lines;
  ++lines_;
  log_zone(*scene_, zone, report, cycle);
}

void ZoneLog::end_second() {
  std::uint64_t zones = 0, others = 0;
  for (auto& [name, zone] : zones_) {
    if (zone.left_out > 0 && zones++ < kZonesAtOnce) {
      log_line(lines::kZoneFlickers, name, zone.left_out, zone.active ? "active" : "not active");
    } else {
      others += zone.left_out;
    }
  }
  if (others > 0) log_line(lines::kZonesLeftOut, counted(others, "more change"));
  zones_.clear();
  lines_ = 0;
}

}  // namespace clearance
