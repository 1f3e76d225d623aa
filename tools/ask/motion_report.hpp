// The answers of all motions as a table of profiles, a plot, and a page of HTML.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "tools/ask/asked_motion.hpp"

namespace clearance {

struct MotionReportFiles {
  std::string profile, plot, page;  // CSV, SVG, HTML; empty: none
  [[nodiscard]] bool any() const noexcept {
    return !profile.empty() || !plot.empty() || !page.empty();
  }
};

class MotionReport {
 public:
  // `title` names cell and motions. `expected`: the least distance that every motion should keep.
  MotionReport(MotionReportFiles files, std::string title, std::optional<double> expected);

  // The file of profiles is begun. Returns an empty text, or why it cannot be written.
  [[nodiscard]] std::string begin();
  void add(const AskedMotion& motion);
  // Writes what is left. Returns an empty text, or why that was not possible.
  [[nodiscard]] std::string finish();

 private:
  struct Row {
    std::string name = {}, error = {}, verdicts = {};
    bool as_expected = true;
    double lower = 0.0, upper = 0.0, time = 0.0;
    std::string pair = {};
    std::vector<ProfilePoint> profile = {};
  };
  [[nodiscard]] std::string plot(const std::filesystem::path& svg) const;
  [[nodiscard]] std::string page(const std::string& svg, const std::string& no_plot) const;

  MotionReportFiles files_;
  std::string title_;
  std::optional<double> expected_;
  std::vector<Row> rows_;
  std::ofstream csv_;
};

}  // namespace clearance
