// The registers of a cell that states none. Zones and robots have blocks of their own, so that one
// more at the end of a list moves no other.
#include <algorithm>

#include "config/cell/plc_settings.hpp"

namespace clearance {
namespace {

constexpr std::uint16_t kWholeCell = 10, kZones = 100, kSeparations = 400, kRobots = 1000;
constexpr double kTicksPerPeriod = 3.0;

PlcRow row(PlcValue value, std::size_t at, std::string zone = {}, std::string robot = {}) {
  PlcRow made{.value = value,
              .zone = std::move(zone),
              .robot = std::move(robot),
              .at = static_cast<std::uint16_t>(at)};
  const auto unit = std::ranges::find(kPlcUnits, made.key().quantity, &PlcUnit::quantity);
  if (!made.has_unit()) return made;
  made.unit = static_cast<std::uint8_t>(unit - kPlcUnits.begin());
  made.scale = unit->standard;
  return made;
}

}  // namespace

PlcSettings default_plc(const Scene& scene) {
  PlcSettings settings;
  const auto ticks_ns = static_cast<std::int64_t>(kTicksPerPeriod * 1e9 / scene.rate_hz);
  settings.period_ns = std::max(settings.period_ns, ticks_ns);
  std::vector<PlcRow>& rows = settings.rows;
  for (std::size_t at = 0; at <= std::size_t(PlcValue::kMisfits); ++at)
    rows.push_back(row(static_cast<PlcValue>(at), at));
  const bool has_zones = !scene.zones.empty(), is_separated = separated_count(scene).any();
  if (has_zones) rows.push_back(row(PlcValue::kClear, kWholeCell));
  rows.push_back(row(PlcValue::kLeastDistance, kWholeCell + 1));
  if (has_zones || is_separated) rows.push_back(row(PlcValue::kSpeedScaling, kWholeCell + 2));
  if (is_separated) rows.push_back(row(PlcValue::kStopMargin, kWholeCell + 3));
  for (std::size_t i = 0; i < scene.zones.size(); ++i)
    rows.push_back(row(PlcValue::kClear, kZones + i, scene.zones[i].name));
  for (std::size_t i = 0; i < scene.zones.size(); ++i) {
    if (!scene.zones[i].separation) continue;
    rows.push_back(row(PlcValue::kSpeedScaling, kSeparations + 2 * i, scene.zones[i].name));
    rows.push_back(row(PlcValue::kStopMargin, kSeparations + 2 * i + 1, scene.zones[i].name));
  }
  for (std::size_t i = 0; i < scene.robots.size(); ++i) {
    if (!scene.robots[i].stopping.is_stated()) continue;
    rows.push_back(row(PlcValue::kSpeedScaling, kRobots + 2 * i, {}, scene.robots[i].name));
    rows.push_back(row(PlcValue::kStopMargin, kRobots + 2 * i + 1, {}, scene.robots[i].name));
  }
  return settings;
}

}  // namespace clearance
