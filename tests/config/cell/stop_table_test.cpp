// The CSV of a maker's stopping table, and which of its rows count.
#include "config/cell/stop_table.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "config/cell/stop_steps.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;

constexpr const char* kColumns =
    "joint,load_percent,extension_percent,speed_percent,time_ms,angle_deg\n";

std::vector<StopRow> rows_in(const std::string& csv) {
  const auto rows = stop_rows(csv);
  if (const auto* mistake = std::get_if<StopMistake>(&rows)) {
    ADD_FAILURE() << mistake->place << ": " << mistake->text;
    return {};
  }
  return std::get<std::vector<StopRow>>(rows);
}

// LINE: TEXT, or nothing.
std::string mistake_in(const std::string& csv) {
  const auto rows = stop_rows(csv);
  const auto* mistake = std::get_if<StopMistake>(&rows);
  return mistake == nullptr ? "" : fmt::format("{}: {}", mistake->place, mistake->text);
}

TEST(StopTable, HasARowForEachLineInSiUnits) {
  const auto rows =
      rows_in(std::string(kColumns) + "1,33,66,100,364,9.00\n\nelbow,0,100,33,1,90\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].joint, "1");
  EXPECT_EQ(rows[0].category, -1);
  EXPECT_EQ(rows[0].load, 0.33);
  EXPECT_EQ(rows[0].extension, 0.66);
  EXPECT_EQ(rows[0].speed, 1.0);
  EXPECT_NEAR(rows[0].time, 0.364, 1e-15);
  EXPECT_NEAR(rows[0].distance, 0.05 * std::numbers::pi, 1e-15);
  EXPECT_TRUE(rows[0].is_angle);
  EXPECT_EQ(rows[0].place, 2);
  EXPECT_EQ(rows[1].joint, "elbow");
  EXPECT_EQ(rows[1].load, 0.0);
  EXPECT_EQ(rows[1].place, 4);
}

TEST(StopTable, WithoutLoadAndExtensionIsOfTheLargest) {
  const auto rows = rows_in("speed_percent,joint,distance_mm,time_ms,category\n50,rail,80,400,2\n");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].load, 1.0);
  EXPECT_EQ(rows[0].extension, 1.0);
  EXPECT_EQ(rows[0].category, 2);
  EXPECT_FALSE(rows[0].is_angle);
  EXPECT_NEAR(rows[0].distance, 0.08, 1e-15);
}

TEST(StopTable, MayBeASpreadsheetsWithQuotesAndAByteOrderMark) {
  const auto rows = rows_in(
      "\xEF\xBB\xBF\"joint\", \"speed_percent\",\"time_ms\",\"angle_deg\"\r\n\"2\",33,364,9\r\n");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].joint, "2");
}

// Cells in other units are not in the range of their column.
TEST(StopTable, IsRefusedWithTheLineTheJointAndTheValue) {
  const auto with = [](const std::string& row) {
    return mistake_in(std::string(kColumns) + "1,33,33,33,364,9\n" + row + "\n");
  };
  EXPECT_THAT(with("2,0.33,33,33,364,9"),
              HasSubstr("3: found load_percent '0.33' of the joint '2'; expected percent of"));
  EXPECT_THAT(with("2,33,-1,33,364,9"), HasSubstr("found extension_percent '-1' of the joint '2'"));
  EXPECT_THAT(with("2,33,33,0.33,364,9"), HasSubstr("found speed_percent '0.33' of the joint '2'"));
  EXPECT_THAT(with("2,33,33,0,364,9"), HasSubstr("found speed_percent '0'"));
  EXPECT_THAT(with("2,33,33,33,0.364,9"),
              HasSubstr("found time_ms '0.364' of the joint '2'; expected a time from 1 to 60000"));
  EXPECT_THAT(with("2,33,33,33,364 ms,9"), HasSubstr("found time_ms '364 ms'"));
  EXPECT_THAT(with("2,33,33,33,nan,9"), HasSubstr("found time_ms 'nan'"));
  EXPECT_THAT(with("2,33,33,33,364,0"), HasSubstr("found angle_deg '0' of the joint '2'"));
  EXPECT_THAT(with("2,33,33,33,364,"), HasSubstr("found no angle and no distance of the joint"));
  EXPECT_THAT(with("2,,33,33,364"), HasSubstr("3: found 5 cells; expected 6"));
  EXPECT_THAT(with(",33,33,33,364,9"), HasSubstr("3: found no joint"));
  EXPECT_THAT(mistake_in("joint,category,speed_percent,time_ms,angle_deg\n1,1.5,33,364,9\n"),
              HasSubstr("2: found category '1.5' of the joint '1'; expected 0, 1 or 2"));
  EXPECT_THAT(mistake_in("joint,speed_percent,time_ms,angle_deg,distance_mm\n1,33,364,9,9\n"),
              HasSubstr("2: found an angle and a distance of the joint '1'"));
}

TEST(StopTable, IsRefusedWithAnUnknownOrMissingColumn) {
  EXPECT_THAT(mistake_in("joint,speed_percent,time_s,angle_deg\n1,33,0.3,9\n"),
              HasSubstr("1: found the column 'time_s'; expected joint, category"));
  EXPECT_THAT(mistake_in("joint,time_ms,angle_deg\n1,300,9\n"),
              HasSubstr("1: found no column 'speed_percent'; expected it"));
  EXPECT_THAT(mistake_in("joint,joint,speed_percent,time_ms,angle_deg\n"),
              HasSubstr("1: found the column 'joint' again; expected it once"));
  EXPECT_THAT(mistake_in(""), HasSubstr("found no rows"));
  EXPECT_THAT(mistake_in(kColumns), HasSubstr("found no rows"));
  EXPECT_THAT(mistake_in("joint;speed_percent;time_ms\n"), HasSubstr("found the column 'joint;"));
}

StopRow stop_at(double load, double extension, double speed, double distance, int category = -1) {
  return {.joint = "1",
          .category = category,
          .load = load,
          .extension = extension,
          .speed = speed,
          .time = distance,
          .distance = distance,
          .place = 7};
}
std::vector<StopRow> counted(const std::vector<StopRow>& rows, const StopConditions& conditions) {
  return std::get<std::vector<StopRow>>(counted_rows(rows, conditions));
}
std::string gap(const std::vector<StopRow>& rows, const StopConditions& conditions = {}) {
  return std::get<StopMistake>(counted_rows(rows, conditions)).text;
}

TEST(StopSteps, CountTheNextStepAboveAndAllBelow) {
  std::vector<StopRow> rows;
  for (const double load : {0.33, 0.66, 1.0})
    for (const double extension : {0.33, 1.0}) rows.push_back(stop_at(load, extension, 1.0, 1.0));
  EXPECT_EQ(counted(rows, {}).size(), 6u) << "the worst";
  EXPECT_EQ(counted(rows, {.load = 0.5}).size(), 4u);
  EXPECT_EQ(counted(rows, {.load = 0.66}).size(), 4u);
  EXPECT_EQ(counted(rows, {.load = 0.67}).size(), 6u);
  EXPECT_EQ(counted(rows, {.load = 0.0, .extension = 0.2}).size(), 1u);
  EXPECT_EQ(counted(rows, {.extension = 0.34}).size(), 6u);
  EXPECT_THAT(
      gap(rows, {.load = 1.1}),
      HasSubstr("found no row of the joint '1' from 110 % load on; expected one, or a lower "
                "load stated"));
}

TEST(StopSteps, CountRowsOfTheCategoryOrOfNone) {
  const std::vector<StopRow> rows = {stop_at(1, 1, 1, 1, 0), stop_at(1, 1, 1, 2, 1),
                                     stop_at(1, 1, 1, 3, -1)};
  EXPECT_EQ(counted(rows, {.category = 0}).size(), 2u);
  EXPECT_EQ(counted(rows, {.category = 2}).size(), 1u);
  EXPECT_TRUE(counted({stop_at(1, 1, 1, 1, 0)}, {.category = 1}).empty());
}

// The row that is missing may be the worst.
TEST(StopSteps, NeedARowForEachCombination) {
  const std::vector<StopRow> rows = {stop_at(0.5, 0.5, 1, 1), stop_at(0.5, 1, 1, 1),
                                     stop_at(1, 0.5, 1, 1)};
  EXPECT_THAT(gap(rows), HasSubstr("found no row of the joint '1' at 100 % load, 100 % extension "
                                   "and 100 % speed; expected one for each combination"));
}

TEST(StopSteps, NeverLeaveOutARowAtTheStatedLoadAndExtensionOrTheNextAbove) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<double> loads, extensions;
    for (int i = random.integer(1, 4); i > 0; --i) loads.push_back(random.integer(0, 12) / 10.0);
    for (int i = random.integer(1, 4); i > 0; --i)
      extensions.push_back(random.integer(0, 12) / 10.0);
    std::vector<StopRow> rows;
    for (const double load : loads)
      for (const double extension : extensions)
        rows.push_back(stop_at(load, extension, 1.0, random.uniform(0.1, 1.0)));
    const double load = random.unit() * std::ranges::max(loads),
                 extension = random.unit() * std::ranges::max(extensions);
    double worst = 0.0;
    for (const StopRow& each : rows) {
      // None of its own axis lies between the stated value and this row's.
      const auto is_next = [](const std::vector<double>& steps, double stated, double step) {
        return std::ranges::none_of(steps,
                                    [&](double other) { return other >= stated && other < step; });
      };
      if (is_next(loads, load, each.load) && is_next(extensions, extension, each.extension))
        worst = std::max(worst, each.distance);
    }
    double found = 0.0;
    for (const StopRow& each : counted(rows, {.load = load, .extension = extension}))
      found = std::max(found, each.distance);
    EXPECT_EQ(found, worst);
  }
}

}  // namespace
}  // namespace clearance
