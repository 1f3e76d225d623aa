#include "tools/watch/separation_lines.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "monitor/interface/report.hpp"

namespace clearance::watch {
namespace {

std::span<const clearance_msg_ZoneSeparation> separations(const Feed& feed) {
  const clearance_msg_Separation* const separation = feed.separation();
  if (separation == nullptr) return {};
  return {separation->zones._buffer, separation->zones._length};
}

std::string text_of(const Feed& feed, const clearance_msg_ZoneSeparation& zone) {
  const std::string name = feed.zone_name(zone.zone), pair = feed.pair_name(zone.pair);
  const auto validity = static_cast<SeparationValidity>(zone.validity);
  if (validity == SeparationValidity::kUnknown)
    return fmt::format("{}: not known, scaling 0, {}", name, pair);
  if (validity == SeparationValidity::kAbsent) return fmt::format("{}: absent, scaling 1", name);
  return fmt::format("{}: scaling {:.2f}, robot up to {:.2f} m/s, {:.3f} m {} S_p, {}{}", name,
                     zone.scaling, zone.speed_limit, std::abs(zone.remaining),
                     zone.remaining < 0.0 ? "below" : "above", pair,
                     validity == SeparationValidity::kAssumed ? ", by stated speeds" : "");
}

std::span<const clearance_msg_RobotStop> stops(const Feed& feed) {
  const clearance_msg_Separation* const separation = feed.separation();
  if (separation == nullptr) return {};
  return {separation->stops._buffer, separation->stops._length};
}

std::string text_of(const Feed& feed, const clearance_msg_RobotStop& stop) {
  const std::string name = feed.robot_name(stop.robot), pair = feed.pair_name(stop.pair);
  const auto validity = static_cast<SeparationValidity>(stop.validity);
  if (validity == SeparationValidity::kUnknown)
    return fmt::format("{} stops: not known, scaling 0, {}", name, pair);
  if (validity == SeparationValidity::kAbsent) return fmt::format("{}: absent, scaling 1", name);
  if (stop.scaling < 1.0)
    return fmt::format(
        "{} stops: scaling {:.2f}, {:.0f} % of its motion is clear, {}, {:.3f} m {} the margin, "
        "in {:.2f} s",
        name, stop.scaling, std::floor(100.0 * stop.share), pair, std::abs(stop.clearance),
        stop.clearance < 0.0 ? "below" : "above", stop.time);
  return fmt::format("{} stops: clear by {:.3f} m in {:.2f} s, {}", name, stop.clearance, stop.time,
                     pair);
}

}  // namespace

std::vector<std::string> separation_texts(const Feed& feed) {
  std::vector<std::string> texts;
  for (const auto& zone : separations(feed)) texts.push_back(text_of(feed, zone));
  for (const auto& stop : stops(feed)) texts.push_back(text_of(feed, stop));
  return texts;
}

void add_separation(std::vector<Line>& lines, const Feed& feed, std::size_t width) {
  for (const auto& zone : separations(feed)) {
    lines.emplace_back(width)
        .add("keep off  ", Style::kDim)
        .add(text_of(feed, zone), zone.scaling < 1.0 ? Style::kAlarm : Style::kGood);
  }
  for (const auto& stop : stops(feed)) {
    lines.emplace_back(width)
        .add("keep off  ", Style::kDim)
        .add(text_of(feed, stop), stop.scaling < 1.0 ? Style::kAlarm : Style::kGood);
  }
}

}  // namespace clearance::watch
