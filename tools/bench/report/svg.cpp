#include "tools/bench/report/svg.hpp"

#include <fmt/format.h>

#include <cmath>

namespace clearance::bench {

std::string svg_page(double width, double height, const std::string& content) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" fill=\"#222222\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{2}</svg>\n",
      width, height, content);
}

std::string svg_text(double x, double y, const std::string& words, const char* anchor, int size) {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\">{}</text>\n", x, y,
      anchor, size, words);
}

std::string svg_line(double x1, double y1, double x2, double y2, const char* colour,
                     const char* dashes) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
      "stroke-dasharray=\"{}\"/>\n",
      x1, y1, x2, y2, colour, dashes);
}

std::string svg_circle(double x, double y, double radius, const char* fill, const char* stroke) {
  return fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\" fill-opacity=\"0.85\" "
      "stroke=\"{}\" stroke-width=\"2\"/>\n",
      x, y, radius, fill, stroke);
}

std::string svg_path(const std::string& path, const char* colour, const char* dashes) {
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" stroke-dasharray=\"{}\"/>\n",
      path, colour, dashes);
}

std::string time_label(int exponent) {
  const char* const units[] = {"ns", "&#181;s", "ms", "s"};
  const int thousands = exponent / 3;
  return fmt::format("{:.0f} {}", std::pow(10.0, exponent - 3 * thousands), units[thousands]);
}

}  // namespace clearance::bench
