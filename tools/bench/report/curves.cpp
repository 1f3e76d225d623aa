#include "tools/bench/report/curves.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/plot/gnuplot.hpp"

namespace clearance::bench {

std::string logarithmic_axes() {
  return "set logscale xy\nset format x '%.0s %cs'\nset grid linecolor rgb '#e4e4e4'\n"
         "set border 3\nset tics nomirror\nset key reverse Left\n";
}

std::string panel_script(const Panel& panel, int number) {
  std::string data, plot;
  int i = 0;
  for (const Curve& curve : panel.curves) {
    if (curve.marks.empty()) continue;
    const std::string block = fmt::format("$panel{}curve{}", number, i++);
    data += block + " << EOD\n";
    for (const Mark& mark : curve.marks) {
      data += fmt::format("{:.6g} {:.6g} {} {}\n", mark.x, mark.y, mark.size, mark.hollow ? 6 : 7);
    }
    data += "EOD\n";
    const std::string line = fmt::format("linewidth 1.5 linecolor rgb '{}'", curve.colour);
    if (curve.joined) {
      plot += fmt::format("{}{} using 1:2 with lines {} dashtype {} notitle",
                          plot.empty() ? "" : ", ", block, line, curve.dashed ? 2 : 1);
    }
    plot += fmt::format(
        "{}{} using 1:2:3:4 with points pointsize variable pointtype variable {} "
        "notitle, keyentry with points pointsize 0.9 pointtype {} {} title {}",
        plot.empty() ? "" : ", ", block, line, curve.dashed ? 6 : 7, line, plot_text(curve.label));
  }
  if (plot.empty()) return {};
  return fmt::format("{}set title {}\n{}plot {}\nunset arrow\nunset label\n", data,
                     plot_text(panel.title), panel.settings, plot);
}

std::string limit_line(double y, const std::string& words) {
  return fmt::format(
      "set arrow from graph 0, first {0:g} to graph 1, first {0:g} nohead dashtype 2 linecolor rgb "
      "'#b00000'\nset label {1} at graph 0.995, first {0:g} right offset 0, 0.5 textcolor rgb "
      "'#b00000' font ',10'\n",
      y, plot_text(words));
}

double shown_error(double error) { return std::max(error, 1e-17); }

}  // namespace clearance::bench
