// A run as one page of HTML that needs nothing beside it: what someone attaches to a review.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/replay/run_series.hpp"

namespace clearance {

// A moment of the run with its picture; without one where no browser is there.
struct PicturedMoment {
  double time_s = 0.0;
  std::string what;
  std::filesystem::path picture;  // PNG; need not exist
};

// What the page is made of.
struct ReportPage {
  std::string recording, cell, build;
  std::vector<std::string> expectations = {};  // what was asked for, a sentence each
  std::vector<PicturedMoment> moments = {};
  std::string svg = {};      // the plot; empty: none
  std::string no_plot = {};  // why there is none
  std::string no_pictures = {};
};

[[nodiscard]] std::string report_page(const Scene& scene, const OfflineReplay& replay,
                                      const RunSeries& series, const ReportPage& page);

}  // namespace clearance
