#include "tools/plot/gnuplot.hpp"

#include <fmt/format.h>

#include <boost/process/args.hpp>
#include <boost/process/child.hpp>
#include <boost/process/exe.hpp>
#include <boost/process/io.hpp>
#include <boost/process/pipe.hpp>
#include <fstream>
#include <iterator>
#include <vector>

namespace clearance {

namespace bp = boost::process;

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

// The script is a file, so that the pipe is free for gnuplot's messages. env finds gnuplot in PATH,
// and ends with 127 if it finds none.
std::string plot_svg(const std::filesystem::path& svg, int width, int height,
                     const std::string& script) {
  const std::string file = svg.string() + ".gnuplot";
  std::ofstream(file) << fmt::format(
      "set terminal svg size {},{} dynamic enhanced font 'sans,12' background '#ffffff'\n"
      "set output '{}'\nset encoding utf8\n{}\nunset output\n",
      width, height, svg.string(), script);
  bp::ipstream output;
  bp::child gnuplot(bp::exe = "/usr/bin/env", bp::args = std::vector<std::string>{"gnuplot", file},
                    (bp::std_out & bp::std_err) > output, bp::std_in < bp::null);
  const std::string words(std::istreambuf_iterator<char>(output), {});
  gnuplot.wait();
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (gnuplot.exit_code() == 0) return {};
  if (gnuplot.exit_code() == 127)
    return "gnuplot is needed for plots: Debian's package gnuplot-nox";
  return fmt::format("gnuplot failed: {}", words.substr(0, 500));
}

}  // namespace clearance
