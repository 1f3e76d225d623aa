#include "monitor/publish/refusal_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/text/sentences.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/publish/joint_log.hpp"

namespace clearance {
namespace {

// A joint is "joint NAME" in the list of refusals, a sensor "sensor NAME".
std::string_view refused_of(std::string_view input) {
  if (input.starts_with("joint ")) return "position";
  return input.starts_with("sensor ") ? "message" : "pose";
}

}  // namespace

void RefusalLog::add(const clearance_msg_RejectCount& entry) {
  const std::string input = entry.object, cause = entry.cause;
  const std::uint64_t grown = entry.count - std::exchange(before_[{input, cause}], entry.count);
  if (grown == 0) return;
  Refusals& refusals = refusals_[{refused_of(input), cause}];
  if (std::ranges::find(refusals.inputs, input) == refusals.inputs.end())
    refusals.inputs.push_back(input);
  refusals.count += grown;
  refusals.total += grown;
  refusals.last = entry.last == nullptr ? "" : entry.last;
  refusals.quiet_s = 0;
}

// A line is due at once if it names an input that no line before did.
bool RefusalLog::is_due(const Refusals& refusals) {
  const bool is_news = !std::ranges::all_of(
      refusals.inputs, [&](const std::string& input) { return refusals.named.contains(input); });
  return refusals.count > 0 && (is_news || refusals.silent_s >= refusals.pause_s);
}

std::size_t RefusalLog::update(const clearance_msg_Health& health, std::size_t most) {
  for (auto& [key, refusals] : refusals_) {
    ++refusals.silent_s;
    if (++refusals.quiet_s > kOverS && refusals.count == 0) {
      refusals.named.clear();
      refusals.pause_s = 0;
    }
  }
  for (std::uint32_t i = 0; i < health.rejected._length; ++i) add(health.rejected._buffer[i]);
  std::size_t due = 0;
  for (auto& [key, refusals] : refusals_) {
    if (refusals.count > 0) ++refusals.counted_s;
    if (!is_due(refusals) || due++ >= most) continue;
    const auto& [what, cause] = key;
    log_line(lines::kRefused, refusals.count,
             fmt::format("{}{} of {}", what, refusals.count == 1 ? "" : "s",
                         listed(refusals.inputs, kNamesALine)),
             refusals.counted_s == 1 ? "second" : fmt::format("{} s", refusals.counted_s),
             refusals.last.empty() ? cause : fmt::format("{}, the last: {}", cause, refusals.last),
             refusals.total);
    refusals.named.insert(refusals.inputs.begin(), refusals.inputs.end());
    refusals.inputs.clear();
    refusals.count = 0;
    refusals.counted_s = refusals.silent_s = 0;
    refusals.pause_s = std::clamp(2 * refusals.pause_s, kFirstPauseS, kLongestPauseS);
  }
  return due;
}

}  // namespace clearance
