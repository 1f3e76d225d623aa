#include "tools/plot/gnuplot.hpp"

#include <fmt/format.h>

#include <fstream>

#include "tools/shared/other_program.hpp"

namespace clearance {

std::string plot_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    // gnuplot removes one backslash when it reads the string, and one when it reads the markup.
    if (c == '_' || c == '^' || c == '@' || c == '&' || c == '{' || c == '}' || c == '~') {
      out += "\\\\";
    }
    out += c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20 ? '\'' : c;
  }
  return out + "\"";
}

// The script is a file: gnuplot's input is empty.
std::string plot_svg(const std::filesystem::path& svg, int width, int height,
                     const std::string& script) {
  const std::string file = svg.string() + ".gnuplot";
  std::ofstream out(file);
  if (!out) return fmt::format("cannot write {}: does its folder exist?", file);
  out << fmt::format(
      "set terminal svg size {},{} dynamic enhanced font 'sans,12' background '#ffffff'\n"
      "set output '{}'\nset encoding utf8\n{}\nunset output\n",
      width, height, svg.string(), script);
  out.close();
  const ProgramRun gnuplot = run_program({"gnuplot", file});
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (gnuplot.status == 0) return {};
  if (gnuplot.status == kNotInPath)
    return "gnuplot is needed for plots: Debian's package gnuplot-nox";
  return fmt::format("gnuplot failed: {}", gnuplot.said.substr(0, 500));
}

}  // namespace clearance
