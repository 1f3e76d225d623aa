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

}  // namespace

std::vector<std::string> separation_texts(const Feed& feed) {
  std::vector<std::string> texts;
  for (const auto& zone : separations(feed)) texts.push_back(text_of(feed, zone));
  return texts;
}

void add_separation(std::vector<Line>& lines, const Feed& feed, std::size_t width) {
  for (const auto& zone : separations(feed)) {
    lines.emplace_back(width)
        .add("keep off  ", Style::kDim)
        .add(text_of(feed, zone), zone.scaling < 1.0 ? Style::kAlarm : Style::kGood);
  }
}

}  // namespace clearance::watch
