// Elements of the report's pictures, as SVG text.
#pragma once

#include <string>

namespace clearance::bench {

// All lengths in px; `anchor`: start, middle or end.
[[nodiscard]] std::string svg_page(double width, double height, const std::string& content);
[[nodiscard]] std::string svg_text(double x, double y, const std::string& words, const char* anchor,
                                   int size);
[[nodiscard]] std::string svg_line(double x1, double y1, double x2, double y2, const char* colour,
                                   const char* dashes = "none");
[[nodiscard]] std::string svg_circle(double x, double y, double radius, const char* fill,
                                     const char* stroke);
// `path`: what SVG calls d.
[[nodiscard]] std::string svg_path(const std::string& path, const char* colour,
                                   const char* dashes = "none");

// "10 ns", "1 ms": a power of ten of ns.
[[nodiscard]] std::string time_label(int exponent);

}  // namespace clearance::bench
