#include "tools/bench/report/report.hpp"

#include <cstdio>
#include <fstream>

namespace clearance::bench {
namespace {

bool write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (out) return true;
  std::fprintf(stderr, "cannot write %s: is the folder writable and the disk not full?\n",
               file.c_str());
  return false;
}

}  // namespace

bool write_report(const std::filesystem::path& folder, const Figures& figures) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    std::fprintf(stderr, "cannot make the folder %s: %s\n", folder.c_str(),
                 error.message().c_str());
    return false;
  }
  if (!write(folder / "report.md", tables(figures))) return false;
  if (!write(folder / "pareto.svg", pareto(figures))) return false;
  std::fprintf(stderr, "\r\033[Kwritten: %s and %s\n", (folder / "report.md").c_str(),
               (folder / "pareto.svg").c_str());
  return true;
}

}  // namespace clearance::bench
