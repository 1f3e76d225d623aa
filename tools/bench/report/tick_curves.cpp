// The cost of a tick against the number of pairs, speed and density.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/bench/report/report.hpp"

namespace clearance::bench {
namespace {

// Rows whose names end so, and one of their counters.
struct Source {
  const char* suffix;
  const char* counter;
  const char* label;
  const char* colour;  // after Okabe and Ito
  bool dashed;
};
constexpr Source kSources[] = {
    {"", "p50_us", "Clearance, median", "#D55E00", false},
    {"", "p99.9_us", "Clearance, p99.9", "#D55E00", true},
    {"/plain", "p50_us", "every pair evaluated, median", "#000000", false},
    {"/fcl", "p50_us", "FCL's tree, the minimum alone, median", "#0072B2", false},
};

struct Axis {
  const char* prefix;  // of its rows
  const char* title;
  const char* unit;
  double (*place)(const std::string& value, const Figure& figure);
};

double pairs_of(const std::string&, const Figure& figure) { return figure.counted("pairs"); }
double value_of(const std::string& value, const Figure&) { return std::stod(value); }
double density_of(const std::string& spacing, const Figure&) {
  return std::pow(std::stod(spacing), -3.0);
}

constexpr Axis kAxes[] = {
    {"sweep/objects/", "number of pairs, all moving", "pairs", pairs_of},
    {"sweep/speed/", "speed of 300 objects", "m/s", value_of},
    {"sweep/spacing/", "density of 300 objects", "objects a cubic metre", density_of},
};

// In the order of x; times in seconds.
std::vector<Mark> marks_of(const Figures& figures, const Axis& axis, const Source& source) {
  std::vector<Mark> marks;
  const std::string prefix = axis.prefix, suffix = source.suffix;
  for (const auto& [name, figure] : figures.rows()) {
    if (!name.starts_with(prefix)) continue;
    const std::string rest = name.substr(prefix.size());
    const std::string value = rest.substr(0, rest.find('/'));
    if (rest != value + suffix) continue;
    marks.push_back({axis.place(value, figure), 1e-6 * figure.counted(source.counter)});
  }
  std::sort(marks.begin(), marks.end(),
            [](const Mark& left, const Mark& right) { return left.x < right.x; });
  return marks;
}

Panel panel_of(const Figures& figures, const Axis& axis, bool first) {
  Panel panel{
      axis.title,
      fmt::format("set xlabel '{}'\n{}\n", axis.unit,
                  first ? "set key at screen 0.5, 0.03 center bottom horizontal" : "unset key"),
      {}};
  panel.settings += limit_line(1e-3, "a period at 1 kHz");
  for (const Source& source : kSources) {
    panel.curves.push_back(
        {source.label, source.colour, marks_of(figures, axis, source), true, source.dashed});
  }
  return panel;
}

}  // namespace

Picture tick_curves(const Figures& figures) {
  std::string script =
      logarithmic_axes() +
      "set format x '%g'\nset format y '%.0s %cs'\nset yrange [1e-6:1]\n"
      "set multiplot layout 1, 3 margins 0.07, 0.98, 0.25, 0.84 spacing 0.06 title "
      "'Time of one tick' font ',15'\n";
  int number = 0;
  for (const Axis& axis : kAxes) {
    const bool first = number == 0;
    script += panel_script(panel_of(figures, axis, first), ++number);
  }
  return {1200, 540, script + "unset multiplot\n"};
}

}  // namespace clearance::bench
