// A maker's stopping table: its rows, and the CSV that has them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace clearance {

// A printed stop of one joint. Load, extension and speed are shares of the largest ones.
struct StopRow {
  std::string joint;  // its name in the URDF without the prefix; or its number, from 1 on
  int category = -1;  // -1: the table does not say
  double load = 1.0, extension = 1.0, speed = 1.0;
  double time = 0.0, distance = 0.0;  // s; rad or m
  bool is_angle = true;
  int place = 0;  // its line in a CSV, from 1 on; else as the caller counts
};

// `text` says what was found and expected.
struct StopMistake {
  int place;  // as StopRow::place
  std::string text;
};

enum class StopColumn : std::uint8_t {
  kJoint,
  kCategory,
  kLoad,
  kExtension,
  kSpeed,
  kTime,
  kAngle,
  kDistance
};
inline constexpr std::array<std::string_view, 8> kStopColumns = {
    "joint",         "category", "load_percent", "extension_percent",
    "speed_percent", "time_ms",  "angle_deg",    "distance_mm"};

// The cells of one row, by column; empty: it has none.
using StopCells = std::array<std::string_view, kStopColumns.size()>;

[[nodiscard]] std::optional<StopColumn> stop_column(std::string_view name);

// A joint, `speed_percent`, `time_ms`, and either `angle_deg` or `distance_mm` have to be there.
// Returns what was found and expected otherwise, with the joint and the value.
[[nodiscard]] std::variant<StopRow, std::string> stop_row(const StopCells& cells);

// Returns the rows of a CSV, or the first mistake. Its first line has the names of the columns.
// Others than kStopColumns are refused: what they say might change a stop.
[[nodiscard]] std::variant<std::vector<StopRow>, StopMistake> stop_rows(std::string_view csv);

}  // namespace clearance
