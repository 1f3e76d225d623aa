// Pictures by gnuplot, which Debian packages: whoever plots writes what is to be seen, not how SVG
// is written.
#pragma once

#include <filesystem>
#include <string>

namespace clearance {

// Colours after Okabe and Ito, which most colour-blind people tell apart.
inline constexpr const char* kPlotColours[] = {"#D55E00", "#0072B2", "#009E73", "#CC79A7",
                                               "#E69F00", "#56B4E9", "#000000", "#999999"};

// Runs a script, after setting a terminal of this size (px) that writes `svg`. Empty, or what went
// wrong: gnuplot is not there, or its own words.
[[nodiscard]] std::string plot_svg(const std::filesystem::path& svg, int width, int height,
                                   const std::string& script);

// For titles and labels: what gnuplot would take as markup, escaped; with quotes around it.
[[nodiscard]] std::string plot_text(const std::string& text);

}  // namespace clearance
