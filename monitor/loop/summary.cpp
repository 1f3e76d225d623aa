// Formats the figures of a run for a terminal.
#include "monitor/loop/summary.hpp"

#include <fmt/format.h>

#include "config/text/sentences.hpp"
#include "monitor/interface/pair_name.hpp"

namespace clearance {
std::string percentiles(const Histogram& histogram) {
  constexpr double kUsPerNs = 1e-3;
  return fmt::format("p50 {:.1f} us  p99.9 {:.1f} us  max {:.1f} us",
                     kUsPerNs * static_cast<double>(histogram.percentile_ns(0.5)),
                     kUsPerNs * static_cast<double>(histogram.percentile_ns(0.999)),
                     kUsPerNs * static_cast<double>(histogram.max_ns()));
}

std::string histograms_json(std::initializer_list<std::pair<const char*, Histogram>> histograms) {
  std::string json = "{";
  for (const auto& [name, histogram] : histograms) {
    std::string bins;
    histogram.each_bin([&bins](std::int64_t upper_ns, std::uint64_t count) {
      bins += fmt::format("{}[{}, {}]", bins.empty() ? "" : ", ", upper_ns, count);
    });
    json +=
        fmt::format("{}\n\"{}\": {{\"count\": {}, \"max_ns\": {}, \"bins\": [{}]}}",
                    json.size() > 1 ? "," : "", name, histogram.count(), histogram.max_ns(), bins);
  }
  return json + "\n}\n";
}

std::string run_summary(const RunStatistics& statistics, const ResponseTimes& responses,
                        double seconds, std::uint64_t dropped_reports) {
  return fmt::format(
      "{} in {:.2f} s, {}, {}, {} dropped\n"
      "tick     {}\n"
      "wake-up  {}\n"
      "report   {}, from the tick until DDS has it\n"
      "response {}, from the stamp of the slowest input until then\n",
      counted(statistics.cycle, "tick"), seconds, counted(statistics.overruns, "overrun"),
      counted(statistics.skipped_cycles, "skipped cycle"), counted(dropped_reports, "report"),
      percentiles(statistics.tick), percentiles(statistics.wakeup), percentiles(responses.delays()),
      percentiles(responses.slowest()));
}

// Says "none" when no pair was ever evaluated, so that no number stands for nothing.
std::string minimum_text(const MinimumSeen& minimum, const Scene& scene) {
  if (!minimum.known) return "minimum  none: no pair was ever evaluated\n";
  return fmt::format("minimum  {:.6f} m in [{:.6f}, {:.6f}], {}, at cycle {}\n",
                     minimum.pair.distance, minimum.pair.lower, minimum.pair.upper,
                     pair_name(scene, minimum.pair), minimum.cycle);
}

}  // namespace clearance
