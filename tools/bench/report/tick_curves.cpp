// Draws the cost of a tick against the number of pairs, speed and density, with logarithmic axes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/bench/report/report.hpp"
#include "tools/bench/report/svg.hpp"

namespace clearance::bench {
namespace {

// Page, px: three panels side by side, the legend below.
constexpr double kWidth = 1200, kHeight = 540;
constexpr double kPanelWidth = 310, kPanelHeight = 330, kTop = 80, kLeft = 80, kGap = 75;
constexpr int kFirstTime = 3, kLastTime = 9;  // ns, powers of ten

// One curve: rows whose names end so, and one of their counters.
struct Curve {
  const char* suffix;
  const char* counter;
  const char* label;
  const char* colour;  // after Okabe and Ito
  const char* dashes;
};
constexpr Curve kCurves[] = {
    {"", "p50_us", "Clearance, median", "#D55E00", "none"},
    {"", "p99.9_us", "Clearance, p99.9", "#D55E00", "5 4"},
    {"/plain", "p50_us", "every pair evaluated, median", "#000000", "none"},
    {"/fcl", "p50_us", "FCL's tree, the minimum alone, median", "#0072B2", "none"},
};

struct Axis {
  const char* prefix;  // of its rows
  const char* title;
  const char* unit;
  int first, last;  // powers of ten
  double (*place)(const std::string& value, const Figure& figure);
};

double pairs_of(const std::string&, const Figure& figure) { return figure.counted("pairs"); }
double value_of(const std::string& value, const Figure&) { return std::stod(value); }
double density_of(const std::string& spacing, const Figure&) {
  return std::pow(std::stod(spacing), -3.0);
}

constexpr Axis kAxes[] = {
    {"sweep/objects/", "number of pairs, all moving", "pairs", 2, 6, pairs_of},
    {"sweep/speed/", "speed of 300 objects", "m/s", -1, 1, value_of},
    {"sweep/spacing/", "density of 300 objects", "objects a cubic metre", -2, 0, density_of},
};

struct Point {
  double x, us;
};

// In the order of x.
std::vector<Point> points_of(const Figures& figures, const Axis& axis, const Curve& curve) {
  std::vector<Point> points;
  const std::string prefix = axis.prefix, suffix = curve.suffix;
  for (const auto& [name, figure] : figures.rows()) {
    if (!name.starts_with(prefix)) continue;
    const std::string rest = name.substr(prefix.size());
    const std::string value = rest.substr(0, rest.find('/'));
    if (rest != value + suffix) continue;
    points.push_back({axis.place(value, figure), figure.counted(curve.counter)});
  }
  std::sort(points.begin(), points.end(),
            [](const Point& left, const Point& right) { return left.x < right.x; });
  return points;
}

class Panel {
 public:
  Panel(const Axis& axis, double left) : axis_(axis), left_(left) {}

  [[nodiscard]] std::string frame() const {
    const double bottom = kTop + kPanelHeight, right = left_ + kPanelWidth;
    std::string out = svg_text(left_ + kPanelWidth / 2, kTop - 18, axis_.title, "middle", 15);
    for (int e = axis_.first; e <= axis_.last; ++e) {
      const double x = at_x(std::pow(10.0, e));
      out += svg_line(x, kTop, x, bottom, "#dddddd") +
             svg_text(x, bottom + 18, fmt::format("{:g}", std::pow(10.0, e)), "middle", 12);
    }
    for (int e = kFirstTime; e <= kLastTime; ++e) {
      const double y = at_us(std::pow(10.0, e - 3));
      out += svg_line(left_, y, right, y, "#e6e6e6") +
             svg_text(left_ - 8, y + 4, time_label(e), "end", 12);
    }
    const double period = at_us(1000.0);
    return out + svg_line(left_, period, right, period, "#b00000", "5 4") +
           svg_text(right - 4, period - 5, "a period at 1 kHz", "end", 11) +
           svg_line(left_, kTop, left_, bottom, "#444444") +
           svg_line(left_, bottom, right, bottom, "#444444") +
           svg_text(left_ + kPanelWidth / 2, bottom + 38, axis_.unit, "middle", 13);
  }

  [[nodiscard]] std::string draw(const Curve& curve, const Figures& figures) const {
    std::string path, circles;
    for (const Point& point : points_of(figures, axis_, curve)) {
      const double x = at_x(point.x), y = at_us(point.us);
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x, y);
      circles += svg_circle(x, y, 3.5, curve.colour, curve.colour);
    }
    return path.empty() ? "" : svg_path(path, curve.colour, curve.dashes) + circles;
  }

 private:
  [[nodiscard]] double at_x(double value) const {
    const double share = (std::log10(value) - axis_.first) / (axis_.last - axis_.first);
    return left_ + kPanelWidth * std::clamp(share, 0.0, 1.0);
  }
  [[nodiscard]] static double at_us(double us) {
    const double share = (3.0 + std::log10(us) - kFirstTime) / (kLastTime - kFirstTime);
    return kTop + kPanelHeight * (1.0 - std::clamp(share, 0.0, 1.0));
  }

  const Axis& axis_;
  double left_;
};

std::string legend() {
  constexpr double kColumn = 270, kLine = kTop + kPanelHeight + 80;
  std::string out;
  double x = kLeft;
  for (const Curve& curve : kCurves) {
    out += svg_line(x, kLine - 4, x + 30, kLine - 4, curve.colour, curve.dashes) +
           svg_circle(x + 15, kLine - 4, 3.5, curve.colour, curve.colour) +
           svg_text(x + 38, kLine, curve.label, "start", 13);
    x += kColumn;
  }
  return out;
}

}  // namespace

std::string tick_curves(const Figures& figures) {
  std::string out = svg_text(kWidth / 2, 32, "Time of one tick", "middle", 19);
  double left = kLeft;
  for (const Axis& axis : kAxes) {
    const Panel panel(axis, left);
    out += panel.frame();
    for (const Curve& curve : kCurves) out += panel.draw(curve, figures);
    left += kPanelWidth + kGap;
  }
  return svg_page(kWidth, kHeight, out + legend());
}

}  // namespace clearance::bench
