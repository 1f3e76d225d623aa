// Pictures by gnuplot: callers state the content, and gnuplot writes the SVG.
#pragma once

#include <filesystem>
#include <string>

namespace clearance {

// Colours after Okabe and Ito, which most colour-blind people can distinguish.
inline constexpr const char* kPlotColours[] = {"#D55E00", "#0072B2", "#009E73", "#CC79A7",
                                               "#E69F00", "#56B4E9", "#000000", "#999999"};

// Runs a script after setting a terminal of this size (px) that writes `svg`. Returns an empty text
// or the fault: gnuplot is missing, or gnuplot's message.
[[nodiscard]] std::string plot_svg(const std::filesystem::path& svg, int width, int height,
                                   const std::string& script);

// For titles and labels: escapes gnuplot's markup and adds quotes.
[[nodiscard]] std::string plot_text(const std::string& text);

}  // namespace clearance
