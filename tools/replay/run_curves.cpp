#include "tools/replay/run_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "monitor/files/build_info.hpp"
#include "monitor/files/file_error.hpp"
#include "monitor/files/temporary_folder.hpp"
#include "monitor/pair_name.hpp"
#include "tools/replay/pictures.hpp"
#include "tools/replay/report_page.hpp"
#include "tools/replay/run_plot.hpp"

namespace clearance {
namespace {

constexpr std::size_t kMostPairs = 4;
// Moments nearer to each other than this count as one, s.
constexpr double kSameMoment = 0.05;

std::vector<std::string> expectations_of(const CheckArguments& arguments) {
  std::vector<std::string> all;
  if (arguments.expect_min_distance) {
    all.push_back(fmt::format("every distance is at least {:g} m", *arguments.expect_min_distance));
  }
  for (const std::string& zone : arguments.expect_no_zone) {
    all.push_back(fmt::format("zone {} is never active", zone));
  }
  if (arguments.compare) all.push_back("the recorded reports are the replayed ones, to the bit");
  if (arguments.compare_bounds) all.push_back("recorded and replayed bounds overlap");
  if (!arguments.reference.empty()) {
    all.push_back(fmt::format("distances are those of {}", arguments.reference));
  }
  return all;
}

// The moments at which these pairs were nearest, in the order of the pairs; equal moments are
// merged.
std::vector<PicturedMoment> moments_of(const Scene& scene, const RunSeries& series,
                                       const std::vector<std::size_t>& places,
                                       const TemporaryFolder& folder) {
  std::vector<PicturedMoment> all;
  for (const std::size_t place : places) {
    const NearestTick& nearest = series.nearest(place);
    if (!nearest.known) continue;
    const std::string what =
        fmt::format("{}, {:.3f} mm (at least {:.3f})", pair_name(scene, series.pairs()[place]),
                    1e3 * nearest.distance, 1e3 * nearest.lower);
    const auto same = std::find_if(all.begin(), all.end(), [&](const PicturedMoment& each) {
      return std::abs(each.time_s - nearest.time_s) < kSameMoment;
    });
    if (same != all.end()) {
      same->what += "; " + what;
    } else {
      all.push_back({nearest.time_s, what, folder / fmt::format("{}.png", all.size())});
    }
  }
  return all;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

std::string RunCurves::unknown_pair() const {
  for (const auto& [a, b] : arguments_.plot_pairs) {
    if (series_.choose({{a, b}}, 1).empty()) {
      return fmt::format("the cell publishes no pair of '{}' and '{}'", a, b);
    }
  }
  return {};
}

std::string RunCurves::write(const OfflineReplay& replay) const {
  if (std::string unknown = unknown_pair(); !unknown.empty()) return unknown;
  if (!arguments_.plot.empty()) {
    const auto places = series_.choose(arguments_.plot_pairs, kMostPairs);
    if (std::string error = plot_run(scene_, series_, places, arguments_.plot); !error.empty()) {
      return error;
    }
  }
  return arguments_.report.empty() ? std::string() : write_report(replay);
}

std::string RunCurves::write_report(const OfflineReplay& replay) const {
  const TemporaryFolder folder;
  if (!folder.error().empty()) return folder.error();
  const auto places = series_.choose(arguments_.plot_pairs, kMostPairs);
  ReportPage page{.recording = arguments_.recording(),
                  .cell = arguments_.cell.empty() ? "as the recording keeps it" : arguments_.cell,
                  .build = kBuild,
                  .expectations = expectations_of(arguments_),
                  .moments = moments_of(scene_, series_, places, folder)};
  page.no_plot = plot_run(scene_, series_, places, folder / "plot.svg");
  page.svg = text_of(folder / "plot.svg");
  std::string cell = arguments_.cell;
  if (cell.empty()) {
    cell = folder / "cell.yaml";
    std::ofstream(cell) << cell_.yaml;
  }
  page.no_pictures = take_pictures(arguments_, cell, page.moments);
  std::ofstream file(arguments_.report, std::ios::binary);
  file << report_page(scene_, replay, series_, page);
  return file.flush() ? std::string() : cannot_write(arguments_.report);
}

}  // namespace clearance
