// Pictures by gnuplot, which Debian packages. A caller describes a plot and needs no code for SVG.
#pragma once

#include <filesystem>
#include <string>

namespace clearance {

// Colours after Okabe and Ito, which most colour-blind people tell apart.
inline constexpr const char* kPlotColours[] = {"#D55E00", "#0072B2", "#009E73", "#CC79A7",
                                               "#E69F00", "#56B4E9", "#000000", "#999999"};

// Runs a script that writes `svg` with this size, px. Returns an empty text or the fault: gnuplot
// is missing, or its own message.
[[nodiscard]] std::string plot_svg(const std::filesystem::path& svg, int width, int height,
                                   const std::string& script);

// A title or label in quotes, with gnuplot's markup escaped.
[[nodiscard]] std::string plot_text(const std::string& text);

}  // namespace clearance
