#include "monitor/publish/motion_diagnostics.hpp"

#include <fmt/format.h>

namespace clearance {

DiagnosticText motion_status(const std::string& motion, const QuestionResult& result) {
  DiagnosticText status{.name = "motion on " + motion, .message = "free"};
  status.values = {{"request", std::to_string(result.request)},
                   {"status", std::string(name_of(result.status))}};
  if (!result.done()) {
    status.raise(DiagnosticLevel::kError, "nothing is known of this motion: " + result.reason);
    return status;
  }
  for (const MarginResult& margin : result.margins) {
    const std::string key = fmt::format("margin {:g} m", margin.margin);
    status.values.emplace_back(key, name(margin.verdict));
    if (margin.verdict == Verdict::kFree) continue;
    const bool below = margin.verdict == Verdict::kBelow;
    status.raise(below ? DiagnosticLevel::kError : DiagnosticLevel::kWarn,
                 fmt::format("{} - {} {} {:g} m at {:.3f} s", margin.first, margin.second,
                             below ? "comes below" : "may come below", margin.margin,
                             below ? margin.below_at : margin.above_until));
    status.values.emplace_back(key + ", above until", fmt::format("{:.6f} s", margin.above_until));
  }
  status.values.emplace_back("lower", fmt::format("{:.6f} m", result.lower));
  status.values.emplace_back("upper", fmt::format("{:.6f} m", result.upper));
  if (!result.first.empty()) {
    status.values.emplace_back("closest pair", result.first + " - " + result.second);
    status.values.emplace_back("closest at", fmt::format("{:.6f} s", result.time));
  }
  status.values.emplace_back("start deviation", fmt::format("{:.6f}", result.start_deviation));
  status.values.emplace_back("scene revision", std::to_string(result.scene_revision));
  status.values.emplace_back("cycle", std::to_string(result.cycle));
  return status;
}

}  // namespace clearance
