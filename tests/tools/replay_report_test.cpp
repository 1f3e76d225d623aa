// Plots and reports of a replay, as a person attaches them to a review. The oracle of the curves is
// the run itself: a ball descends to 80 mm above a box and leaves again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <regex>

#include "tests/tools/bench_cell.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kLeastMm = 80.0, kLeastAtS = 0.12, kRunS = 0.199;

// The ball moves down at one metre per second, and up again.
std::string visit_log() {
  std::string log = "t_ns,object,px,py,pz,qw,qx,qy,qz\n";
  for (int tick = 0; tick < 200; ++tick) {
    const double height = 0.15 + 1e-3 * (kLeastMm + std::abs(tick - 1e3 * kLeastAtS));
    log +=
        fmt::format("{0},hand,0,0,{1},1,0,0,0\n{0},tool,0,2,0,1,0,0,0\n", tick * 1'000'000, height);
  }
  return log;
}

struct PlotPoint {
  double x, y;
};

// The points of the last line of a path. The line before it is a sample for the legend.
std::vector<PlotPoint> points_of(std::string path) {
  path.erase(0, path.rfind('M'));
  static const std::regex kPoint(R"(([-\d.]+),([-\d.]+))");
  std::vector<PlotPoint> points;
  for (std::sregex_iterator at(path.begin(), path.end(), kPoint), end; at != end; ++at) {
    points.push_back({std::stod((*at)[1]), std::stod((*at)[2])});
  }
  return points;
}

// The curve with this title, converted to the plot's units. The two lowest numbers on the axis give
// the scale in mm, and the ends of the run give it in s.
std::vector<PlotPoint> curve_of(const std::string& svg, const std::string& title) {
  static const std::regex kTick(
      R"rx(d='M[\d.]+,([\d.]+) L[^']*'/>\s*<g transform="[^"]*"[^>]*text-anchor="end">\s*<text><tspan[^>]*> ?([-\d.]+)</tspan>)rx");
  std::vector<std::pair<double, double>> ticks;  // (pixel, mm)
  for (std::sregex_iterator at(svg.begin(), svg.end(), kTick), end; at != end; ++at) {
    ticks.emplace_back(std::stod((*at)[1]), std::stod((*at)[2]));
  }
  const std::size_t begin = svg.find("<title>" + title + "</title>");
  if (ticks.size() < 2 || begin == std::string::npos) return {};
  const std::string group = svg.substr(begin, svg.find("<title>", begin + 1) - begin);
  static const std::regex kPath(R"(<path stroke='[^']*'\s+d='([^']*)')");
  std::vector<PlotPoint> longest;
  for (std::sregex_iterator at(group.begin(), group.end(), kPath), end; at != end; ++at) {
    std::vector<PlotPoint> points = points_of((*at)[1]);
    if (points.size() > longest.size()) longest = std::move(points);
  }
  const double mm_a_pixel = (ticks[1].second - ticks[0].second) / (ticks[1].first - ticks[0].first);
  const double left = longest.front().x, right = longest.back().x;
  for (PlotPoint& point : longest) {
    point = {kRunS * (point.x - left) / (right - left),
             ticks[0].second + (point.y - ticks[0].first) * mm_a_pixel};
  }
  return longest;
}

class ReplayReport : public RunsPrograms {
 protected:
  void SetUp() override {
    write_text(folder / "cell.yaml", kBenchCell);
    write_text(folder / "log.csv", visit_log());
    ASSERT_EQ(0, run(kRecord, {"--from-csv", path("log.csv"), "-o", path("run.mcap"), "--cell",
                               path("cell.yaml")}))
        << output;
  }
  int replay(const std::vector<std::string>& more) {
    return run(kReplay, with({"check", "--cell", path("cell.yaml"), path("run.mcap")}, more));
  }
};

TEST_F(ReplayReport, ThePlotsCurveHoldsTheRunsLeastDistance) {
  ASSERT_EQ(0, replay({"--plot", path("run.svg")})) << output;
  const std::string svg = read_text(folder / "run.svg");
  const std::vector<PlotPoint> hand = curve_of(svg, "hand - box");
  ASSERT_GT(hand.size(), 150u);
  const auto least = std::ranges::min_element(hand, {}, &PlotPoint::y);
  const double pixel_mm = 8.0;  // 2 m on 350 pixels, with a margin
  EXPECT_NEAR(least->y, kLeastMm, pixel_mm);
  EXPECT_NEAR(least->x, kLeastAtS, 0.003);
  EXPECT_NEAR(hand.front().y, kLeastMm + 120.0, pixel_mm);
  EXPECT_THAT(svg, HasSubstr("<title>tool - box</title>"));
  EXPECT_THAT(svg, HasSubstr(">stop<"));  // the zone's threshold
}

TEST_F(ReplayReport, APlotShowsThePairsThatAreAskedForAndNoOthers) {
  ASSERT_EQ(0, replay({"--plot", path("run.svg"), "--plot-pair", "box", "hand"})) << output;
  const std::string svg = read_text(folder / "run.svg");
  EXPECT_THAT(svg, Not(HasSubstr("tool")));
  // Without the tool the axis ends at 200 mm: a pixel is less than a millimetre.
  const std::vector<PlotPoint> hand = curve_of(svg, "hand - box");
  ASSERT_GT(hand.size(), 150u);
  EXPECT_NEAR(std::ranges::min_element(hand, {}, &PlotPoint::y)->y, kLeastMm, 1.0);

  EXPECT_EQ(1, replay({"--plot", path("none.svg"), "--plot-pair", "hand", "tool"}));
  EXPECT_THAT(output, HasSubstr("the cell publishes no pair of 'hand' and 'tool'"));
}

TEST_F(ReplayReport, IsOnePageThatNamesExpectationsAndWorstMomentsWithPictures) {
  ChildProcess child(
      kReplay, {"check", "--cell", path("cell.yaml"), path("run.mcap"), "--report",
                path("run.html"), "--expect-no-zone", "stop", "--expect-min-distance", "0.05"});
  // the time includes the start of a browser
  EXPECT_EQ(1, child.wait(std::chrono::seconds(250))) << child.output();
  const std::string html = read_text(folder / "run.html");
  EXPECT_THAT(html, HasSubstr("NOT all of them hold"));
  EXPECT_THAT(html, HasSubstr("zone stop"));
  EXPECT_THAT(html, HasSubstr("0.05"));
  EXPECT_THAT(html,
              HasSubstr("<td>80.000 mm, certified to be from 80.000 to 80.000 mm: hand - box"));
  EXPECT_THAT(html, HasSubstr("<figcaption>0.1200 s: "));
  EXPECT_THAT(html, HasSubstr("<title>hand - box</title>"));  // the page contains the plot
  EXPECT_THAT(html, HasSubstr("src=\"data:image/png;base64,iVBORw0KGgo"));
  // The page fetches nothing: the only addresses in it are names of XML namespaces.
  static const std::regex kElsewhere(
      R"rx((src|href)\s*=\s*["'](?!#|data:)[^"']*["']|url\(|@import)rx");
  std::smatch found;
  EXPECT_FALSE(std::regex_search(html, found, kElsewhere)) << found.str();
}

TEST_F(ReplayReport, IsNotWrittenOverAFileWithoutForce) {
  write_text(folder / "run.html", "kept");
  EXPECT_NE(0, replay({"--report", path("run.html")}));
  EXPECT_EQ(read_text(folder / "run.html"), "kept");
}

}  // namespace
}  // namespace clearance::test
