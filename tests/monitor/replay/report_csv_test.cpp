// The columns of robots that state how they stop, in the table of a replay.
//
// Oracle: the figures of the report, read back from the text.
#include "monitor/replay/report_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/monitor/ask/stopping_scara.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

// The rows of a table without quoted cells, by column.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& text) {
  std::istringstream lines(text);
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line) c == ',' ? void(cells.emplace_back()) : cells.back().push_back(c);
    return cells;
  };
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> header = cells_of(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), header.size()) << line;
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) row[header.at(i)] = cells[i];
  }
  return rows;
}

double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

// The finger moves away from the ball, and then comes too fast. A cell without robots follows.
TEST(ReportCsv, HasScalingShareAndLimitingPairOfEachRobotThatStops) {
  const ScratchFolder folder;
  Cell arm;
  arm.scene = scene_of_scara({});
  StoppingTicks ticks(arm.scene);
  ReportCsv csv(folder / "t.csv", arm.scene, true);
  std::vector<RobotStop> stops;
  std::vector<double> lowers;       // by tick: of the only pair
  std::vector<std::size_t> of_row;  // by row: its tick
  for (const double velocity : {-1.0, 1.9}) {
    const Report& report = ticks.tick(0.0, velocity);
    csv.add({report, {}, ticks.monitor, arm, {}});
    ASSERT_EQ(report.stops.size(), 1u);
    of_row.insert(of_row.end(), arm.scene.pairs.size(), stops.size());
    stops.push_back(report.stops.front());
    ASSERT_EQ(report.pairs.size(), 1u);
    lowers.push_back(report.pairs.front().stop_lower);
    ASSERT_GE(lowers.back(), 0.0);
  }
  ASSERT_EQ(stops[0].scaling, 1.0);
  ASSERT_GT(stops[1].scaling, 0.0);
  ASSERT_LT(stops[1].scaling, 1.0);
  Cell none;
  none.scene = bench_cell();
  Monitor monitor(none.scene);
  csv.add({monitor.tick({}, kStart), {}, monitor, none, {}});
  ASSERT_TRUE(csv.close()) << csv.error();

  const std::string text = read_text(folder / "t.csv");
  EXPECT_THAT(text, HasSubstr(",unseen,arm/stop_validity,arm/stop_scaling,arm/stop_clearance,arm/"
                              "stop_pair,arm/stop_share,arm/stop_time\n"));
  auto rows = rows_of(text);
  ASSERT_EQ(rows.size(), of_row.size() + none.scene.pairs.size());
  for (std::size_t i = 0; i < of_row.size(); ++i) {
    const RobotStop& stop = stops[of_row[i]];
    EXPECT_EQ(rows[i]["arm/stop_validity"], "measured");
    EXPECT_EQ(number(rows[i]["arm/stop_scaling"]), stop.scaling);
    EXPECT_EQ(number(rows[i]["arm/stop_clearance"]), stop.clearance);
    EXPECT_EQ(rows[i]["arm/stop_pair"], "ball - finger");
    EXPECT_EQ(number(rows[i]["arm/stop_share"]), stop.share);
    EXPECT_EQ(number(rows[i]["arm/stop_time"]), stop.time);
    EXPECT_EQ(number(rows[i]["stop_lower"]), lowers[of_row[i]]);
  }
  for (std::size_t i = of_row.size(); i < rows.size(); ++i) {
    for (const auto& [column, value] : rows[i])
      EXPECT_TRUE(!column.starts_with("arm/") || value.empty()) << column << ' ' << value;
  }
}

}  // namespace
}  // namespace clearance::test
