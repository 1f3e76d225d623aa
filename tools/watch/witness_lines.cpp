#include "tools/watch/witness_lines.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string_view>

namespace clearance::watch {
namespace {

constexpr double kMmPerM = 1e3;

std::span<const clearance_msg_WitnessHealth> witnesses(const Feed& feed) {
  const clearance_msg_Health* const health = feed.health();
  if (health == nullptr) return {};
  return {health->witnesses._buffer, health->witnesses._length};
}

// Of the links of this sensor and robot, the one that is seen farthest from its place; null: none.
const clearance_msg_WitnessHealth* worst_link(const Feed& feed,
                                              const clearance_msg_WitnessHealth& of) {
  const clearance_msg_WitnessHealth* worst = nullptr;
  for (const auto& each : witnesses(feed)) {
    const bool is_link = *each.link != '\0' && std::string_view(each.sensor) == of.sensor &&
                         std::string_view(each.robot) == of.robot;
    if (!is_link || std::isnan(each.residual_p50)) continue;
    if (worst == nullptr || std::abs(each.residual_p50) > std::abs(worst->residual_p50))
      worst = &each;
  }
  return worst;
}

// "camera sees arm at 412 of 412 rays, residual 0.4 mm (90 %: 1.9), most at wrist: 1.1 mm".
std::string text_of(const Feed& feed, const clearance_msg_WitnessHealth& of) {
  const std::uint32_t rays = of.agreeing + of.through;
  std::string text = rays == 0 ? fmt::format("{} does not see {}", of.sensor, of.robot)
                               : fmt::format("{} sees {} at {} of {} rays", of.sensor, of.robot,
                                             of.agreeing, rays);
  if (!std::isnan(of.residual_p50))
    text += fmt::format(", residual {:.1f} mm (90 %: {:.1f})", kMmPerM * of.residual_p50,
                        kMmPerM * of.residual_p90);
  if (const auto* const worst = worst_link(feed, of))
    text += fmt::format(", most at {}: {:.1f} mm", worst->link, kMmPerM * worst->residual_p50);
  if (of.denied) text += ": it is not where its joints say";
  return text;
}

Style style_of(const clearance_msg_WitnessHealth& of) {
  if (of.denied) return Style::kAlarm;
  if (of.through != 0) return Style::kWarning;
  return of.agreeing != 0 ? Style::kGood : Style::kDim;
}

}  // namespace

std::vector<std::string> witness_texts(const Feed& feed) {
  std::vector<std::string> texts;
  for (const auto& each : witnesses(feed))
    if (*each.link == '\0') texts.push_back(text_of(feed, each));
  return texts;
}

void add_witnesses(std::vector<Line>& lines, const Feed& feed, std::size_t width) {
  for (const auto& each : witnesses(feed)) {
    if (*each.link != '\0') continue;
    lines.emplace_back(width)
        .add("witness   ", Style::kDim)
        .add(text_of(feed, each), style_of(each));
  }
}

}  // namespace clearance::watch
