// The CSV of a maker's stopping table.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/yaml/diagnostics.hpp"

namespace clearance {

// What is printed for one joint at one load, extension and speed, which are shares of the largest.
struct StopRow {
  std::string joint;  // its name in the URDF without the prefix; or its number, from 1 on
  int category = -1;  // -1: the table does not say
  double load = 1.0, extension = 1.0, speed = 1.0;
  double time = 0.0, distance = 0.0;  // s; rad or m
  bool is_angle = true;
  int line = 0;
};

// The columns `joint`, `speed_percent`, `time_ms`, and `angle_deg` or `distance_mm` have to be
// there; `category`, `load_percent` and `extension_percent` may be. Others are refused: what they
// say might change a stop. Returns the first mistake otherwise.
[[nodiscard]] std::variant<std::vector<StopRow>, NamedFileMistake> stop_rows(std::string_view text);

}  // namespace clearance
