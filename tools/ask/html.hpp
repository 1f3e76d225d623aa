// Pages of HTML that programs write: one style, and texts that are not markup.
#pragma once

#include <cstddef>
#include <string>

namespace clearance {

inline constexpr const char* kPageStyle = R"(
body { font: 15px/1.5 system-ui, sans-serif; max-width: 1120px; margin: 32px auto; padding: 0 20px; color: #17202b; }
h1 { font-size: 24px; margin-bottom: 4px; } h2 { font-size: 18px; margin-top: 36px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
td, th { text-align: left; padding: 4px 12px 4px 0; border-bottom: 1px solid #dfe3e8; vertical-align: top; }
th { color: #64707d; font-weight: 550; }
.held { color: #0f8a6d; font-weight: 650; } .failed { color: #d1242f; font-weight: 650; }
figure { margin: 18px 0; } figure img, figure svg { width: 100%; height: auto; border: 1px solid #dfe3e8; border-radius: 8px; }
figcaption { font-weight: 600; margin-bottom: 6px; } .quiet { color: #64707d; }
)";

// The text for a place between tags or in quotes.
[[nodiscard]] inline std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

// A file of gnuplot without the lines before its <svg> element.
[[nodiscard]] inline std::string inline_svg(const std::string& svg) {
  const std::size_t begin = svg.find("<svg");
  return begin == std::string::npos ? "" : svg.substr(begin);
}

}  // namespace clearance
