// Error against time of curved pairs, ours and the peers', and of chapter 5's methods.
#include <fmt/format.h>

#include <iterator>
#include <string>

#include "tools/bench/chapter5/methods.hpp"
#include "tools/bench/report/report.hpp"
#include "tools/bench/workload.hpp"
#include "tools/plot/gnuplot.hpp"

namespace clearance::bench {
namespace {

struct Solver {
  const char* prefix;   // of pairs
  const char* crossed;  // of ellipsoids/
  const char* label;
  const char* colour;
};
constexpr Solver kSolvers[] = {
    {"", "ours", "Clearance, with its certificate", "#D55E00"},
    {"peer/fcl/", "fcl", "FCL (libccd), 1e-6", "#0072B2"},
    {"peer/fcl-tight/", "fcl-tight", "FCL (libccd), 1e-12", "#56B4E9"},
    {"peer/fcl-gjk/", "fcl-gjk", "FCL, own GJK", "#009E73"},
    {"peer/bullet/", "bullet", "Bullet, doubles", "#CC79A7"},
};

std::string axes_of_errors(const char* from, const char* to) {
  return fmt::format(
      "set xrange [{}:{}]\nset yrange [1e-17:10]\nset format y '10^{{%T}}'\nset xlabel 'CPU time a "
      "query'\n",
      from, to);
}

Panel pairs_panel(const Figures& figures, const std::string& mode) {
  Panel panel{fmt::format("pairs of shapes, {}: largest error of 4,000, m", mode),
              axes_of_errors("1e-8", "1e-4") + limit_line(1e-6, "failure: above 1e-6 m"),
              {}};
  panel.settings += "unset key\n";
  for (const Solver& solver : kSolvers) {
    Curve curve{solver.label, solver.colour, {}, false};
    for (const KindPair& pair : kind_pairs()) {
      const Figure* f =
          figures.at(fmt::format("{}{}/{}/{}", solver.prefix, pair.group(), mode, pair.load()));
      if (f)
        curve.marks.push_back({1e-9 * f->ns, shown_error(f->max_error), 0.6, f->failures > 0.0});
    }
    panel.curves.push_back(curve);
  }
  return panel;
}

// Dashed ones have hollow marks.
Curve crossed_curve(const Figures& figures, const char* who, const std::string& label,
                    const char* colour, bool dashed) {
  Curve curve{label, colour, {}, true, dashed};
  double size = 0.4;
  for (const double separation : kSeparations) {
    const Figure* f = figures.at(fmt::format("ellipsoids/{}/{}", who, separation));
    if (f) curve.marks.push_back({1e-9 * f->ns, shown_error(f->max_error), size, dashed});
    size += 0.2;
  }
  return curve;
}

Panel crossed_panel(const Figures& figures) {
  Panel panel{"crossed ellipsoids 0.001 (small), 0.1, 0.5, 1.2955 and 5 m (large) apart: error, m",
              axes_of_errors("1e-8", "0.1") + "set key outside right center vertical maxrows 20\n",
              {}};
  for (std::size_t i = 1; i < std::size(kSolvers); ++i) {
    panel.curves.push_back(
        crossed_curve(figures, kSolvers[i].crossed, kSolvers[i].label, kSolvers[i].colour, true));
  }
  // After the eight colours the same again, dashed.
  std::size_t i = 0;
  for (const Method& method : methods()) {
    panel.curves.push_back(crossed_curve(figures, method.name, method.label,
                                         kPlotColours[i % std::size(kPlotColours)],
                                         i >= std::size(kPlotColours)));
    ++i;
  }
  return panel;
}

// The key of both upper panels, between these and the lower one: a plot of nothing.
std::string key_of_pairs() {
  std::string entries;
  for (const Solver& solver : kSolvers) {
    entries +=
        fmt::format(", keyentry with points pointsize 0.9 pointtype 7 linecolor rgb '{}' title {}",
                    solver.colour, plot_text(solver.label));
  }
  return "unset logscale\nunset border\nunset tics\nunset xlabel\nunset title\n"
         "set key center center horizontal maxrows 2\n"
         "plot [0:1] [0:1] NaN notitle" +
         entries + "\n";
}

}  // namespace

Picture curved_picture(const Figures& figures) {
  std::string script = logarithmic_axes() + "set multiplot\nset size 0.5, 0.46\n";
  script += "set origin 0, 0.54\n" + panel_script(pairs_panel(figures, "tracked"), 1);
  script += "set origin 0.5, 0.54\n" + panel_script(pairs_panel(figures, "cold"), 2);
  script += "set size 1, 0.5\nset origin 0, 0\n" + panel_script(crossed_panel(figures), 3);
  script += "set size 1, 0.06\nset origin 0, 0.49\n" + key_of_pairs();
  return {1120, 1100, script + "unset multiplot\n"};
}

}  // namespace clearance::bench
