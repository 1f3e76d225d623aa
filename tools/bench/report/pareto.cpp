#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "tools/bench/report/report.hpp"
#include "tools/bench/report/svg.hpp"

namespace clearance::bench {
namespace {

// Page, px. Two panels side by side, the legend below.
constexpr double kWidth = 1120, kHeight = 640;
constexpr double kPanelWidth = 470, kPanelHeight = 430, kTop = 80, kLeft = 80, kGap = 80;

// Axes, powers of ten.
constexpr int kFirstTime = 1, kLastTime = 6;      // ns
constexpr int kFirstError = -17, kLastError = 1;  // m

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
  const char* label;
  double radius;
};
constexpr Size kSizes[] = {{"f2", "12 facets", 4.0}, {"f10", "256", 6.5}, {"f40", "4,084", 9.5}};

class Panel {
 public:
  Panel(std::ostream& out, double left) : out_(out), left_(left) {}

  void axes(const char* title) const {
    text(left_ + kPanelWidth / 2, kTop - 18, title, "middle", 15);
    for (int e = kFirstTime; e <= kLastTime; ++e) {
      const double x = at_time(std::pow(10.0, e));
      line(x, kTop, x, kTop + kPanelHeight, "#dddddd");
      text(x, kTop + kPanelHeight + 18, time_label(e), "middle", 12);
    }
    for (int e = kFirstError; e <= kLastError; e += 2) {
      const double y = at_error(std::pow(10.0, e));
      line(left_, y, left_ + kPanelWidth, y, "#e6e6e6");
      text(left_ - 8, y + 4, fmt::format("1e{}", e), "end", 12);
    }
    const double failure = at_error(1e-6);
    line(left_, failure, left_ + kPanelWidth, failure, "#b00000", "5 4");
    text(left_ + kPanelWidth - 4, failure - 5, "failure: above 1e-6 m", "end", 11);
    line(left_, kTop, left_, kTop + kPanelHeight, "#444444");
    line(left_, kTop + kPanelHeight, left_ + kPanelWidth, kTop + kPanelHeight, "#444444");
    text(left_ + kPanelWidth / 2, kTop + kPanelHeight + 38, "CPU time a query", "middle", 13);
  }

  // Its sizes joined by a line; hollow where a query failed.
  void draw(const Solver& solver, const Figures& figures, const std::string& mode) const {
    std::string path, circles;
    for (const Size& size : kSizes) {
      const Figure* f = figures.at(fmt::format("{}{}/{}", solver.prefix, mode, size.load));
      if (!f) continue;
      const double x = at_time(f->ns), y = at_error(f->max_error);
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x, y);
      circles += svg_circle(x, y, size.radius, f->failures > 0.0 ? "#ffffff" : solver.colour,
                            solver.colour);
    }
    out_ << svg_path(path, solver.colour) << circles;
  }

  void text(double x, double y, const std::string& words, const char* anchor, int size) const {
    out_ << svg_text(x, y, words, anchor, size);
  }

 private:
  [[nodiscard]] double at_time(double ns) const {
    const double share = (std::log10(ns) - kFirstTime) / (kLastTime - kFirstTime);
    return left_ + kPanelWidth * std::clamp(share, 0.0, 1.0);
  }
  [[nodiscard]] static double at_error(double error) {
    const double exponent = error > 0.0 ? std::log10(error) : kFirstError;
    const double share = (exponent - kFirstError) / (kLastError - kFirstError);
    return kTop + kPanelHeight * (1.0 - std::clamp(share, 0.0, 1.0));
  }
  void line(double x1, double y1, double x2, double y2, const char* colour,
            const char* dashes = "none") const {
    out_ << svg_line(x1, y1, x2, y2, colour, dashes);
  }

  std::ostream& out_;
  double left_;
};

void legend(std::ostream& out, const Panel& page) {
  constexpr int kColumns = 4;
  constexpr double kColumn = 262, kLine = 20, kFirst = kTop + kPanelHeight + 68;
  int i = 0;
  for (const Solver& solver : kSolvers) {
    const double x = kLeft + kColumn * (i % kColumns), y = kFirst + kLine * (i / kColumns);
    out << fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"6\" fill=\"{}\"/>\n", x, y - 4,
                       solver.colour);
    page.text(x + 14, y, solver.label, "start", 13);
    ++i;
  }
  page.text(
      kLeft, kFirst + 2 * kLine + 6,
      "Small to large circles: 12, 256 and 4,084 facets a pair. Hollow: at least one of 4,000 "
      "queries failed. Lower and further left is better.",
      "start", 12);
}

}  // namespace

std::string pareto(const Figures& figures) {
  std::ostringstream out;
  const Panel tracked(out, kLeft), cold(out, kLeft + kPanelWidth + kGap);
  tracked.text(kWidth / 2, 32, "Largest error against time: distance of two facet-balls", "middle",
               19);
  tracked.axes("tracked, largest error in m");
  cold.axes("cold, largest error in m");
  for (const Solver& solver : kSolvers) {
    tracked.draw(solver, figures, "tracked");
    cold.draw(solver, figures, "cold");
  }
  legend(out, tracked);
  return svg_page(kWidth, kHeight, out.str());
}

}  // namespace clearance::bench
