#include "tools/bench/report/report.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>

#include "monitor/app/print.hpp"
#include "monitor/files/build_info.hpp"
#include "tools/plot/gnuplot.hpp"

namespace clearance::bench {
namespace {

bool write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (out) return true;
  print(stderr, "cannot write {}: is the folder writable and the disk not full?\n", file.string());
  return false;
}

// Two files of the folder, which is made if it is not there.
bool write_both(const std::filesystem::path& folder, const char* table_file,
                const std::string& table, const char* picture_file, const Picture& picture) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    print(stderr, "cannot make the folder {}: {}\n", folder.string(), error.message());
    return false;
  }
  if (!write(folder / table_file, fmt::format("{}Made by clearance-bench {}.\n", table, kBuild))) {
    return false;
  }
  const std::string wrong =
      plot_svg(folder / picture_file, picture.width, picture.height, picture.script);
  if (!wrong.empty()) {
    print(stderr, "{} is not written: {}\n", (folder / picture_file).string(), wrong);
    return false;
  }
  print(stderr, "\r\033[Kwritten: {} and {}\n", (folder / table_file).string(),
        (folder / picture_file).string());
  return true;
}

}  // namespace

bool write_report(const std::filesystem::path& folder, const Figures& figures) {
  return write_both(folder, "report.md", tables(figures), "pareto.svg", pareto(figures));
}

bool write_tick_report(const std::filesystem::path& folder, const Figures& figures) {
  return write_both(folder, "ticks.md", tick_tables(figures), "ticks.svg", tick_curves(figures));
}

bool write_curved_report(const std::filesystem::path& folder, const Figures& figures) {
  return write_both(folder, "curved.md", pair_tables(figures) + chapter5_tables(figures),
                    "curved.svg", curved_picture(figures));
}

}  // namespace clearance::bench
