#include "tools/plot/gnuplot.hpp"

#include <fmt/format.h>

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <fstream>

namespace clearance {

std::string plot_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    // One backslash is for the string, one for the markup.
    if (c == '_' || c == '^' || c == '@' || c == '&' || c == '{' || c == '}' || c == '~') {
      out += "\\\\";
    }
    out += c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20 ? '\'' : c;
  }
  return out + "\"";
}

// The script goes through a file, because gnuplot's messages come back through the pipe.
std::string plot_svg(const std::filesystem::path& svg, int width, int height,
                     const std::string& script) {
  const std::filesystem::path file = svg.string() + ".gnuplot";
  std::ofstream(file) << fmt::format(
      "set terminal svg size {},{} dynamic enhanced font 'sans,12' background '#ffffff'\n"
      "set output '{}'\nset encoding utf8\n{}\nunset output\n",
      width, height, svg.string(), script);
  std::FILE* const pipe = popen(fmt::format("gnuplot '{}' 2>&1", file.string()).c_str(), "r");
  std::string said;
  if (pipe != nullptr) {
    std::array<char, 4096> piece;
    while (const std::size_t read = std::fread(piece.data(), 1, piece.size(), pipe)) {
      said.append(piece.data(), read);
    }
  }
  const int status = pipe == nullptr ? -1 : pclose(pipe);
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (status == 0) return {};
  if (status != -1 && WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    return "gnuplot is needed for plots: Debian's package gnuplot-nox";
  }
  return fmt::format("gnuplot failed: {}", said.substr(0, 500));
}

}  // namespace clearance
