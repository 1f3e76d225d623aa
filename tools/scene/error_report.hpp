// What the stated errors of a cell do in one posture, and whether they explain measured places.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>

#include "config/scene/scene.hpp"

namespace clearance {

// What is wrong with the input.
struct ErrorReportFault {
  std::string text;
};

// Each watched pair whose bodies are known in this posture: its model error, and which sources have
// most of it. `joints`: rad or m, by name; others are at zero, or at the limit next to it.
[[nodiscard]] std::variant<std::string, ErrorReportFault> error_table(
    const Scene& scene, const std::map<std::string, double>& joints);

struct MeasuredReport {
  std::string text;
  bool explained = false;  // every place is within the stated errors
};
// Compares where a link's origin was measured with where the model puts it. `table`: CSV with a
// column for each joint that is not at zero, by its name (rad or m), and x, y, z (m, in the world);
// a row for each place.
[[nodiscard]] std::variant<MeasuredReport, ErrorReportFault> measured_report(
    const Scene& scene, const std::filesystem::path& table, const std::string& link);

}  // namespace clearance
