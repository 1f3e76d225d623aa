#include <fmt/format.h>

#include <string>

#include "tools/bench/report/report.hpp"

namespace clearance::bench {
namespace {

struct Solver {
  const char* prefix;
  const char* label;
  const char* colour;
};
// Colours after Okabe and Ito, which most colour-blind people tell apart.
constexpr Solver kSolvers[] = {
    {"", "Clearance, with its certificate", "#D55E00"},
    {"variant/base/", "the thesis's iteration, base", "#000000"},
    {"variant/aggressive/", "the thesis's iteration, aggressive", "#999999"},
    {"peer/fcl/", "FCL (libccd), 1e-6", "#0072B2"},
    {"peer/fcl-tight/", "FCL (libccd), 1e-12", "#56B4E9"},
    {"peer/fcl-gjk/", "FCL, own GJK", "#009E73"},
    {"peer/bullet/", "Bullet, doubles", "#CC79A7"},
    {"peer/qp/", "general QP", "#E69F00"},
};

struct Size {
  const char* load;
  double mark;
};
constexpr Size kSizes[] = {{"f2", 0.5}, {"f10", 0.8}, {"f40", 1.2}};  // 12, 256, 4,084 facets

Panel panel_of(const Figures& figures, const std::string& mode) {
  Panel panel{fmt::format("{}, largest error in m", mode),
              "set xrange [1e-8:1e-3]\nset yrange [1e-17:10]\nset format y '10^{%T}'\n"
              "set xlabel 'CPU time a query'\n" +
                  limit_line(1e-6, "failure: above 1e-6 m"),
              {}};
  panel.settings += mode == "tracked"
                        ? "set key at screen 0.5, 0.07 center bottom horizontal maxrows 2\n"
                        : "unset key\n";
  for (const Solver& solver : kSolvers) {
    Curve curve{solver.label, solver.colour, {}};
    for (const Size& size : kSizes) {
      const Figure* f = figures.at(fmt::format("{}{}/{}", solver.prefix, mode, size.load));
      if (!f) continue;
      curve.marks.push_back(
          {1e-9 * f->ns, shown_error(f->max_error), size.mark, f->failures > 0.0});
    }
    panel.curves.push_back(curve);
  }
  return panel;
}

}  // namespace

Picture pareto(const Figures& figures) {
  std::string script =
      logarithmic_axes() +
      "set multiplot layout 1, 2 margins 0.07, 0.98, 0.24, 0.87 spacing 0.08 title "
      "'Largest error against time: distance of two facet-balls' font ',15'\n"
      "set label 1 'Small to large circles: 12, 256 and 4,084 facets a pair. "
      "Hollow: at least one of 4,000 queries failed. Lower and further left is "
      "better.' at screen 0.5, 0.03 center\n";
  script +=
      panel_script(panel_of(figures, "tracked"), 1) + panel_script(panel_of(figures, "cold"), 2);
  return {1120, 640, script + "unset multiplot\n"};
}

}  // namespace clearance::bench
