// A run as one self-contained page of HTML, to attach to a review.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/replay/run_series.hpp"

namespace clearance {

// A moment of the run with its picture; without a browser there is no picture.
struct PicturedMoment {
  double time_s = 0.0;
  std::string what;
  std::filesystem::path picture;  // PNG; need not exist
};

// The content of the page.
struct ReportPage {
  std::string recording, cell, build;
  std::vector<std::string> expectations = {};  // each as a sentence
  std::vector<PicturedMoment> moments = {};
  std::string svg = {};      // the plot; empty: none
  std::string no_plot = {};  // the reason for an empty plot
  std::string no_pictures = {};
};

[[nodiscard]] std::string report_page(const Scene& scene, const OfflineReplay& replay,
                                      const RunSeries& series, const ReportPage& page);

}  // namespace clearance
