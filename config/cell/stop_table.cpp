#include "config/cell/stop_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace clearance {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

enum Column { kJoint, kCategory, kLoad, kExtension, kSpeed, kTime, kAngle, kLength, kColumns };
constexpr std::array<std::string_view, kColumns> kNames = {
    "joint",         "category", "load_percent", "extension_percent",
    "speed_percent", "time_ms",  "angle_deg",    "distance_mm"};

std::string_view trimmed(std::string_view text) noexcept {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string_view> cells(std::string_view line) {
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

// Reads the rows one by one.
class RowReader {
 public:
  // An empty text: the header is as expected.
  [[nodiscard]] std::string take_header(std::string_view line) {
    header_ = cells(line);
    place_.fill(header_.size());
    for (std::size_t i = 0; i < header_.size(); ++i) {
      const auto known = std::ranges::find(kNames, header_[i]);
      if (known == kNames.end())
        return fmt::format("found the column '{}'; expected {}", header_[i],
                           fmt::join(kNames, ", "));
      std::size_t& place = place_[static_cast<std::size_t>(known - kNames.begin())];
      if (place != header_.size()) return fmt::format("found the column '{}' twice", header_[i]);
      place = i;
    }
    for (const Column column : {kJoint, kSpeed, kTime}) {
      if (!has(column)) return fmt::format("found no column '{}'; expected it", kNames[column]);
    }
    if (has(kAngle) || has(kLength)) return "";
    return "found neither 'angle_deg' nor 'distance_mm'; expected one of them, or both";
  }

  [[nodiscard]] std::string take(std::string_view line, StopRow& row) {
    const std::vector<std::string_view> fields = cells(line);
    if (fields.size() != header_.size())
      return fmt::format("found {} cells; expected {}, as the first line has", fields.size(),
                         header_.size());
    const auto text = [&](Column column) {
      return has(column) ? fields[place_[column]] : std::string_view();
    };
    row.joint = text(kJoint);
    row.is_angle = !text(kAngle).empty();
    if (row.joint.empty()) return "found no joint; expected its name or number";
    if (row.is_angle != text(kLength).empty())
      return "found an angle and a distance, or neither; expected one of them in each row";
    const Column distance = row.is_angle ? kAngle : kLength;
    const double unit = row.is_angle ? kDegree : 1e-3;
    double category = -1.0;
    if (has(kCategory) && !read(text(kCategory), 0.0, 2.0, category)) return wrong(kCategory);
    row.category = static_cast<int>(category);
    for (const auto& [column, share] :
         {std::pair(kLoad, &row.load), {kExtension, &row.extension}, {kSpeed, &row.speed}}) {
      if (!has(column)) continue;
      if (!read(text(column), column == kSpeed ? 1e-3 : 0.0, 1000.0, *share)) return wrong(column);
      *share *= 0.01;
    }
    if (!read(text(kTime), 0.0, 60e3, row.time)) return wrong(kTime);
    if (!read(text(distance), 0.0, 1e5, row.distance)) return wrong(distance);
    row.time *= 1e-3;
    row.distance *= unit;
    return "";
  }

 private:
  [[nodiscard]] bool has(Column column) const noexcept { return place_[column] < header_.size(); }
  [[nodiscard]] bool read(std::string_view text, double least, double most, double& value) {
    found_ = text;
    const auto read = number(text);
    if (!read || *read < least || *read > most) return false;
    value = *read;
    return true;
  }
  [[nodiscard]] std::string wrong(Column column) const {
    return fmt::format("found '{}' as {}; expected a number in its range", found_, kNames[column]);
  }

  std::vector<std::string_view> header_;
  std::array<std::size_t, kColumns> place_{};  // the number of columns: it is not there
  std::string_view found_;
};

}  // namespace

std::variant<std::vector<StopRow>, NamedFileMistake> stop_rows(std::string_view text) {
  std::vector<StopRow> rows;
  RowReader reader;
  bool has_header = false;
  for (int line = 1; !text.empty(); ++line) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view content = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (trimmed(content).empty()) continue;
    StopRow row;
    row.line = line;
    const std::string fault = has_header ? reader.take(content, row) : reader.take_header(content);
    if (!fault.empty()) return NamedFileMistake{line, fault};
    if (has_header) rows.push_back(std::move(row));
    has_header = true;
  }
  if (rows.empty()) return NamedFileMistake{1, "found no rows; expected a row for each stop"};
  return rows;
}

}  // namespace clearance
