#include "config/cell/stop_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

namespace clearance {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets write it

// The numbers that a column accepts. A percentage below 1 is probably a share.
struct Accepted {
  StopColumn column;
  double least, most;
  const char* what;
  bool zero = false, whole = false;
};
constexpr Accepted kCategories{StopColumn::kCategory, 0.0, 2.0, "0, 1 or 2", true, true},
    kLoads{StopColumn::kLoad, 1.0, 1000.0, "percent of the largest load: 0, or from 1 to 1000",
           true},
    kExtensions{StopColumn::kExtension, 1.0, 1000.0,
                "percent of the largest extension: 0, or from 1 to 1000", true},
    kSpeeds{StopColumn::kSpeed, 1.0, 1000.0, "percent of the joint's full speed, from 1 to 1000"},
    kTimes{StopColumn::kTime, 1.0, 60e3, "a time from 1 to 60000 ms"},
    kAngles{StopColumn::kAngle, 1e-6, 1e5, "an angle in degrees, above 0"},
    kDistances{StopColumn::kDistance, 1e-6, 1e5, "a distance in mm, above 0"};

std::string_view name_of(StopColumn column) {
  return kStopColumns[static_cast<std::size_t>(column)];
}

std::string_view trimmed(std::string_view text) noexcept {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> all;
  for (;;) {
    const auto comma = line.find(',');
    all.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return all;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

// Reads the cells of one row, and keeps the first mistake.
class CellsReader {
 public:
  CellsReader(const StopCells& cells, std::string_view joint) : cells_(cells), joint_(joint) {}

  // Returns `otherwise` where the column has no cell, unless it has to have one.
  double read(const Accepted& accepted, std::optional<double> otherwise = std::nullopt) {
    const std::string_view text = cells_[static_cast<std::size_t>(accepted.column)];
    if (text.empty() && otherwise) return *otherwise;
    const auto value = number(text);
    const bool is_good = value &&
                         ((accepted.zero && *value == 0.0) ||
                          (*value >= accepted.least && *value <= accepted.most)) &&
                         !(accepted.whole && *value != std::floor(*value));
    if (is_good) return *value;
    if (mistake_.empty())
      mistake_ = fmt::format("found {} '{}' of the joint '{}'; expected {}",
                             name_of(accepted.column), text, joint_, accepted.what);
    return otherwise.value_or(1.0);
  }
  [[nodiscard]] const std::string& mistake() const noexcept { return mistake_; }

 private:
  const StopCells& cells_;
  std::string_view joint_;
  std::string mistake_;
};

// Returns the column of each field of the first line, or what is wrong with that line.
std::variant<std::vector<StopColumn>, std::string> header(std::string_view line) {
  std::vector<StopColumn> columns;
  for (const std::string_view name : split(line)) {
    const auto column = stop_column(name);
    if (!column)
      return fmt::format("found the column '{}'; expected {}", name, fmt::join(kStopColumns, ", "));
    if (std::ranges::find(columns, *column) != columns.end())
      return fmt::format("found the column '{}' again; expected it once", name);
    columns.push_back(*column);
  }
  for (const StopColumn column : {StopColumn::kJoint, StopColumn::kSpeed, StopColumn::kTime}) {
    if (std::ranges::find(columns, column) == columns.end())
      return fmt::format("found no column '{}'; expected it", name_of(column));
  }
  return columns;
}

std::variant<StopRow, std::string> csv_row(std::string_view line,
                                           const std::vector<StopColumn>& columns) {
  const std::vector<std::string_view> fields = split(line);
  if (fields.size() != columns.size())
    return fmt::format("found {} cells; expected {}, as in the first line", fields.size(),
                       columns.size());
  StopCells cells;
  for (std::size_t i = 0; i < fields.size(); ++i)
    cells[static_cast<std::size_t>(columns[i])] = fields[i];
  return stop_row(cells);
}

}  // namespace

std::optional<StopColumn> stop_column(std::string_view name) {
  const auto found = std::ranges::find(kStopColumns, name);
  if (found == kStopColumns.end()) return std::nullopt;
  return static_cast<StopColumn>(found - kStopColumns.begin());
}

std::variant<StopRow, std::string> stop_row(const StopCells& cells) {
  StopRow row;
  row.joint = cells[static_cast<std::size_t>(StopColumn::kJoint)];
  if (row.joint.empty()) return "found no joint; expected its name or number";
  row.is_angle = !cells[static_cast<std::size_t>(StopColumn::kAngle)].empty();
  if (row.is_angle != cells[static_cast<std::size_t>(StopColumn::kDistance)].empty())
    return fmt::format("found {} of the joint '{}'; expected either angle_deg or distance_mm",
                       row.is_angle ? "an angle and a distance" : "no angle and no distance",
                       row.joint);
  CellsReader reader(cells, row.joint);
  row.category = static_cast<int>(reader.read(kCategories, -1.0));
  row.load = 0.01 * reader.read(kLoads, 100.0);
  row.extension = 0.01 * reader.read(kExtensions, 100.0);
  row.speed = 0.01 * reader.read(kSpeeds);
  row.time = 1e-3 * reader.read(kTimes);
  row.distance = row.is_angle ? kDegree * reader.read(kAngles) : 1e-3 * reader.read(kDistances);
  if (!reader.mistake().empty()) return reader.mistake();
  return row;
}

std::variant<std::vector<StopRow>, StopMistake> stop_rows(std::string_view csv) {
  if (csv.starts_with(kByteOrderMark)) csv.remove_prefix(kByteOrderMark.size());
  std::vector<StopRow> rows;
  std::vector<StopColumn> columns;
  for (int line = 1; !csv.empty(); ++line) {
    const auto end = std::min(csv.find('\n'), csv.size());
    const std::string_view content = csv.substr(0, end);
    csv.remove_prefix(std::min(end + 1, csv.size()));
    if (trimmed(content).empty()) continue;
    if (columns.empty()) {
      auto found = header(content);
      if (const auto* fault = std::get_if<std::string>(&found)) return StopMistake{line, *fault};
      columns = std::get<std::vector<StopColumn>>(std::move(found));
      continue;
    }
    auto row = csv_row(content, columns);
    if (const auto* fault = std::get_if<std::string>(&row)) return StopMistake{line, *fault};
    rows.push_back(std::get<StopRow>(std::move(row)));
    rows.back().place = line;
  }
  if (rows.empty()) return StopMistake{1, "found no rows; expected a row for each stop"};
  return rows;
}

}  // namespace clearance
