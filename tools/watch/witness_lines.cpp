#include "tools/watch/witness_lines.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>

namespace clearance::watch {
namespace {

constexpr double kMmPerM = 1e3;

std::span<const clearance_msg_WitnessHealth> witnesses(const Feed& feed) {
  const clearance_msg_Health* const health = feed.health();
  if (health == nullptr) return {};
  return {health->witnesses._buffer, health->witnesses._length};
}

// "camera sees arm at 412 of 412 rays, residual 0.4 mm (90 %: 1.9)".
std::string text_of(const clearance_msg_WitnessHealth& of) {
  const std::uint32_t rays = of.agreeing + of.through;
  std::string text = rays == 0 ? fmt::format("{} does not see {}", of.sensor, of.robot)
                               : fmt::format("{} sees {} at {} of {} rays", of.sensor, of.robot,
                                             of.agreeing, rays);
  if (!std::isnan(of.residual_p50))
    text += fmt::format(", residual {:.1f} mm (90 %: {:.1f})", kMmPerM * of.residual_p50,
                        kMmPerM * of.residual_p90);
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
  for (const auto& each : witnesses(feed)) texts.push_back(text_of(each));
  return texts;
}

void add_witnesses(std::vector<Line>& lines, const Feed& feed, std::size_t width) {
  for (const auto& each : witnesses(feed))
    lines.emplace_back(width).add("witness   ", Style::kDim).add(text_of(each), style_of(each));
}

}  // namespace clearance::watch
