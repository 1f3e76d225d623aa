// Draws a reduction: error against time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/plot/gnuplot.hpp"
#include "tools/scene/reduction.hpp"

namespace clearance {
namespace {

constexpr int kColumns = 2, kPanelWidth = 560, kPanelHeight = 350, kKeyHeight = 70;
constexpr double kLeastError = 1e-5;  // m: the lower end of the logarithmic axis

constexpr double kLabelled = 0.85;  // share of the error labelled last; closer labels would overlap

constexpr const char* kKinds[] = {"sphere",   "capsule",   "box",    "rounded box",
                                  "cylinder", "ellipsoid", "facets", "parts"};
static_assert(std::size(kKinds) == std::size(kPlotColours));

std::size_t kind_of(const ReducedModel& model) {
  return model.parts.size() > 1 ? std::size(kKinds) - 1
                                : static_cast<std::size_t>(model.parts.front().kind);
}

// The number of facets or of parts.
std::string number_of(const ReducedModel& model) {
  if (model.parts.size() > 1) return fmt::format("{}", model.parts.size());
  return model.parts.front().kind == ModelKind::kPolyhedron ? fmt::format("{}", model.facets())
                                                            : std::string();
}

struct Ranges {
  double least_ns = kInfinity, most_ns = 0.0, most_error = 0.0;
};
Ranges ranges_of(const std::vector<Reduction>& bodies) {
  Ranges all;
  for (const Reduction& body : bodies) {
    for (const Level& level : levels_of(body)) {
      all.least_ns = std::min(all.least_ns, 0.7 * level.query_ns);
      all.most_ns = std::max(all.most_ns, 1.6 * level.query_ns);
      all.most_error = std::max(all.most_error, 2.0 * level.error);
    }
  }
  return all;
}

// The cheapest model at a distance, and the line of models of equal cost as a table of ns and m.
struct Tangent {
  std::string line;
  Level touches;
};
std::optional<Tangent> tangent(const std::vector<Level>& levels, const Watching& watching,
                               const Ranges& ranges) {
  const auto best = cheapest(levels, watching);
  if (!best) return std::nullopt;
  const double cost = watch_cost(levels[*best], watching)->ns_per_s;
  Tangent made{"", levels[*best]};
  constexpr int kSamples = 400;
  for (int i = 0; i <= kSamples; ++i) {
    const double ns =
        ranges.least_ns * std::pow(ranges.most_ns / ranges.least_ns, double(i) / kSamples);
    const double error = error_of_equal_cost(ns, cost, watching);
    if (error > kLeastError) made.line += fmt::format("{:.6g} {:.6g}\n", ns, error);
  }
  return made;
}

std::string marks(const Reduction& body) {
  std::string text;
  double labelled = kInfinity;  // the error of the last one
  for (const ReducedModel& model : body.models) {
    const std::string number = number_of(model);
    const bool is_labelled = !number.empty() && model.error < kLabelled * labelled;
    if (is_labelled) labelled = model.error;
    text +=
        fmt::format("{:.6g} {:.6g} {} {}\n", model.time->cold, std::max(model.error, kLeastError),
                    kind_of(model), plot_text(is_labelled ? number : ""));
  }
  return text;
}

std::string panel(const Reduction& body, int number, const ReductionOptions& options,
                  const Ranges& ranges) {
  std::string data = fmt::format("$marks{} << EOD\n{}EOD\n", number, marks(body)), curves;
  const std::vector<Level> levels = levels_of(body);
  int i = 0;
  for (const double distance : options.distances) {
    const auto made = tangent(levels, {distance, options.speed}, ranges);
    if (!made) continue;
    const std::string block = fmt::format("$tangent{}_{}", number, i++);
    data += fmt::format("{} << EOD\n{}EOD\n", block, made->line);
    curves += fmt::format(
        "{0} using 1:2 with lines dashtype 2 linecolor rgb '#b00000' notitle, "
        "'+' every ::::0 using ({1:.6g}):({2:.6g}) with points pointtype 6 pointsize 1.6 "
        "linewidth 1.5 linecolor rgb '#b00000' notitle, "
        "'+' every ::::0 using ({1:.6g}):({2:.6g}):({3}) with labels font ',9' right offset -1.1, "
        "-0.3 "
        "textcolor rgb '#b00000' notitle, ",
        block, made->touches.query_ns, std::max(made->touches.error, kLeastError),
        plot_text(fmt::format("{:g} m", distance)));
  }
  return fmt::format(
      "{0}set title {1}\nplot {2}$marks{3} using 1:2:(colour($3)) with points pointtype 7 "
      "pointsize "
      "0.7 linecolor rgb variable notitle, $marks{3} using 1:2:4 with labels font ',8' left offset "
      "0.7, -0.4 notitle\n",
      data, plot_text(body.name), curves, number);
}

std::string key() {
  std::string entries;
  for (std::size_t i = 0; i < std::size(kKinds); ++i) {
    entries += fmt::format(", keyentry with points pointtype 7 linecolor rgb '{}' title {}",
                           kPlotColours[i], plot_text(kKinds[i]));
  }
  return "unset logscale\nunset border\nunset tics\nunset xlabel\nunset ylabel\nunset title\n"
         "set key center center horizontal maxrows 2 reverse Left\nplot [0:1] [0:1] NaN notitle" +
         entries + "\n";
}

std::string colours() {
  std::string list;
  for (const char* colour : kPlotColours) list += fmt::format(" 0x{}", colour + 1);
  return "colour(i) = int(word('" + list.substr(1) + "', int(i) + 1))\n";
}

}  // namespace

std::string plot_reductions(const std::vector<Reduction>& bodies, const ReductionOptions& options,
                            const std::filesystem::path& svg) {
  const int count = static_cast<int>(bodies.size());
  const int columns = std::min(kColumns, count), rows = (count + columns - 1) / columns;
  const int width = std::max(2, columns) * kPanelWidth, height = rows * kPanelHeight + kKeyHeight;
  const Ranges ranges = ranges_of(bodies);
  std::string script =
      "set logscale xy\nset format y '10^{%T}'\nset grid linecolor rgb '#e4e4e4'\nset border "
      "3\nset tics nomirror\nset xlabel 'ns a query, cold'\nset ylabel 'error, m'\nunset key\n" +
      colours() +
      fmt::format("set xrange [{:g}:{:g}]\nset yrange [{:g}:{:g}]\nset multiplot\n",
                  ranges.least_ns, ranges.most_ns, kLeastError, ranges.most_error);
  const double panel_width = 1.0 / columns, panel_height = double(kPanelHeight) / height;
  for (int i = 0; i < count; ++i) {
    script += fmt::format("set size {:g}, {:g}\nset origin {:g}, {:g}\n", panel_width, panel_height,
                          (i % columns) * panel_width, 1.0 - (i / columns + 1) * panel_height);
    script += panel(bodies[static_cast<std::size_t>(i)], i, options, ranges);
  }
  script += fmt::format("set size 1, {:g}\nset origin 0, 0\n", double(kKeyHeight) / height) + key();
  return plot_svg(svg, width, height, script + "unset multiplot\n");
}

}  // namespace clearance
