#include "tools/replay/run_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "monitor/pair_name.hpp"
#include "tools/plot/gnuplot.hpp"

namespace clearance {
namespace {

constexpr int kWidth = 1100, kHeight = 640;
constexpr std::size_t kMostVisits = 400;

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "NaN";
}

// A block of data for each pair: time, distance in mm, lower bound in mm, closing speed.
std::string data_of(const RunSeries& series, std::span<const std::size_t> places) {
  std::string text;
  for (std::size_t i = 0; i < places.size(); ++i) {
    text += fmt::format("$pair{} << EOD\n", i);
    for (std::size_t k = 0; k < series.stretches(); ++k) {
      const StretchOfPair& pair = series.of(places[i], k);
      text += fmt::format("{:.6f} {} {} {}\n", series.time_s(k), number(1e3 * pair.distance),
                          number(1e3 * pair.lower), number(pair.closing_speed));
    }
    text += "EOD\n";
  }
  return text;
}

// Rectangles behind the curves for the times in which a zone was active.
std::string zone_times(const RunSeries& series) {
  std::string text;
  std::size_t shown = 0;
  for (const ZoneVisit& visit : series.visits()) {
    if (++shown > kMostVisits) break;
    text += fmt::format(
        "set object rectangle from {:.6f}, graph 0 to {:.6f}, graph 1 behind fillcolor rgb "
        "'#D55E00' fillstyle transparent solid 0.08 noborder\n",
        visit.begin_s, std::max(visit.end_s, visit.begin_s + 1e-3 * series.duration_s()));
  }
  return text;
}

// Lines for the thresholds of the zones that contain one of these pairs.
std::string thresholds(const Scene& scene, const RunSeries& series,
                       std::span<const std::size_t> places) {
  std::string text;
  for (const Zone& zone : scene.zones) {
    const bool holds_one = std::ranges::any_of(places, [&](std::size_t place) {
      return std::ranges::find(zone.pairs, series.pairs()[place]) != zone.pairs.end();
    });
    if (!holds_one) continue;
    text += fmt::format(
        "set arrow from graph 0, first {0:g} to graph 1, first {0:g} nohead dashtype 2 linecolor "
        "rgb '#b00000'\nset label {1} at graph 0.995, first {0:g} right offset 0, 0.5 textcolor "
        "rgb '#b00000' font ',10'\n",
        1e3 * zone.enter_below, plot_text(zone.name));
  }
  return text;
}

std::string distance_curves(const Scene& scene, const RunSeries& series,
                            std::span<const std::size_t> places) {
  std::string text = "plot ";
  for (std::size_t i = 0; i < places.size(); ++i) {
    const char* const colour = kPlotColours[i % std::size(kPlotColours)];
    text += fmt::format(
        "{0}$pair{1} using 1:3:2 with filledcurves fillcolor rgb '{2}' fillstyle transparent solid "
        "0.25 notitle, $pair{1} using 1:2 with lines linewidth 1.6 linecolor rgb '{2}' title {3}",
        i == 0 ? "" : ", ", i, colour, plot_text(pair_name(scene, series.pairs()[places[i]])));
  }
  return text + "\n";
}

std::string speed_curves(std::span<const std::size_t> places) {
  std::string text = "plot ";
  for (std::size_t i = 0; i < places.size(); ++i) {
    text += fmt::format("{}$pair{} using 1:4 with lines linewidth 1.2 linecolor rgb '{}' notitle",
                        i == 0 ? "" : ", ", i, kPlotColours[i % std::size(kPlotColours)]);
  }
  return text + "\n";
}

}  // namespace

std::string plot_run(const Scene& scene, const RunSeries& series,
                     std::span<const std::size_t> places, const std::filesystem::path& svg) {
  if (places.empty()) return "there is no pair to plot: none is published, or none was ever known";
  std::string script = data_of(series, places);
  script += fmt::format(
      "set xrange [0:{:.6g}]\nset grid linecolor rgb '#e4e4e4'\nset border 3\nset tics nomirror\n"
      "set key outside top center horizontal maxcols 3\nset lmargin 10\nset rmargin 3\n",
      std::max(1e-3, series.duration_s()));
  script += "set multiplot\nset size 1, 0.66\nset origin 0, 0.34\nset ylabel 'distance, mm'\n";
  script += zone_times(series) + thresholds(scene, series, places);
  script += distance_curves(scene, series, places);
  script += "unset arrow\nunset label\nset size 1, 0.34\nset origin 0, 0\nunset key\n";
  script += "set ylabel 'closing speed, m/s'\nset xlabel 'time after the first tick, s'\n";
  script += "set xzeroaxis\n" + speed_curves(places) + "unset multiplot\n";
  return plot_svg(svg, kWidth, kHeight, script);
}

}  // namespace clearance
