// Points and lines of the report's pictures, as gnuplot takes them (tools/plot).
#pragma once

#include <string>
#include <vector>

namespace clearance::bench {

struct Mark {
  double x, y;
  double size = 0.6;  // of the point, as gnuplot has it
  bool hollow = false;
};

struct Curve {
  std::string label;
  const char* colour;
  std::vector<Mark> marks;
  bool joined = true;
  bool dashed = false;
};

struct Panel {
  std::string title;
  std::string settings;  // gnuplot's, of this panel alone: ranges, labels, key
  std::vector<Curve> curves;
};

// What to plot, and how large, px.
struct Picture {
  int width, height;
  std::string script;
};

// Grid, borders and logarithmic axes, which all of them have. Times are in seconds, so that gnuplot
// writes 10 ns or 1 ms.
[[nodiscard]] std::string logarithmic_axes();

// The lines that draw a panel within a multiplot; `number` is its own. A curve without marks is
// left out.
[[nodiscard]] std::string panel_script(const Panel& panel, int number);

// A dashed red line across the panel, named at its end.
[[nodiscard]] std::string limit_line(double y, const std::string& words);

// Errors of 0 have no place on a logarithmic axis.
[[nodiscard]] double shown_error(double error);

}  // namespace clearance::bench
