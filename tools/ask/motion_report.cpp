#include "tools/ask/motion_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "monitor/files/build_info.hpp"
#include "monitor/files/file_error.hpp"
#include "monitor/files/temporary_folder.hpp"
#include "tools/ask/html.hpp"
#include "tools/ask/motion_json.hpp"
#include "tools/plot/gnuplot.hpp"

namespace clearance {
namespace {

// More curves could not be told apart.
constexpr std::size_t kMostCurves = std::size(kPlotColours);
constexpr int kWidth = 1120, kHeight = 560;

// A field of a CSV: quoted where it has to be.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

MotionReport::MotionReport(MotionReportFiles files, std::string title,
                           std::optional<double> expected)
    : files_(std::move(files)), title_(std::move(title)), expected_(expected) {}

std::string MotionReport::begin() {
  if (files_.profile.empty()) return "";
  csv_.open(files_.profile);
  csv_ << "motion,from_s,to_s,lower_m,upper_m,first,second\n";
  return csv_ ? "" : cannot_write(files_.profile);
}

void MotionReport::add(const AskedMotion& motion) {
  if (!files_.any()) return;
  Row row{.name = motion.name(), .error = motion.error, .as_expected = motion.as_expected};
  const auto name = [&](std::uint32_t object) -> const std::string& {
    return object_name(motion.scene(), motion.question, object);
  };
  if (row.error.empty()) {
    const Answer& answer = motion.answer;
    row.lower = answer.lower;
    row.upper = answer.upper;
    row.time = answer.time;
    if (answer.has_pair && answer.upper < kInfinity)
      row.pair = name(answer.first) + " - " + name(answer.second);
    for (std::size_t i = 0; i < answer.margins.size(); ++i) {
      const MarginAnswer& margin = answer.margins[i];
      row.verdicts += fmt::format("{}{} m: {}", row.verdicts.empty() ? "" : ", ",
                                  margin_text(motion.question, i), clearance::name(margin.verdict));
      if (margin.verdict == Verdict::kBelow)
        row.verdicts += fmt::format(" from {:.6g} s on", margin.above_until);
    }
    row.profile = answer.profile;
    for (const ProfilePoint& point : answer.profile) {
      if (!csv_.is_open()) break;
      csv_ << fmt::format("{},{},{},{},{},{},{}\n", field(row.name), point.from, point.to,
                          point.lower, point.upper, field(name(point.first)),
                          field(name(point.second)));
    }
  }
  rows_.push_back(std::move(row));
}

// The motions that come nearest, each from its own begin.
std::string MotionReport::plot(const std::filesystem::path& svg) const {
  std::vector<std::size_t> order(rows_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) { return rows_[i].profile.empty(); });
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return rows_[i].lower; });
  order.resize(std::min(order.size(), kMostCurves));
  if (order.empty()) return "no motion has a distance over time";
  std::ranges::sort(order);
  std::string script, curves;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Row& row = rows_[order[i]];
    script += fmt::format("$motion{} << END\n", i);
    const double begin = row.profile.front().from;
    for (const ProfilePoint& point : row.profile) {
      for (const double t : {point.from, point.to})
        script += fmt::format("{} {} {}\n", t - begin, 1e3 * point.lower, 1e3 * point.upper);
    }
    script += "END\n";
    curves += fmt::format(
        "{0}$motion{1} using 1:2:3 with filledcurves fillcolor rgb '{2}' fillstyle transparent "
        "solid 0.35 notitle, $motion{1} using 1:2 with lines linewidth 1.4 linecolor rgb '{2}' "
        "title {3}",
        i == 0 ? "plot " : ", ", i, kPlotColours[i], plot_text(row.name));
  }
  script +=
      "set grid linecolor rgb '#e4e4e4'\nset border 3\nset tics nomirror\nset yrange [0:*]\n"
      "set key outside top center horizontal maxcols 3\nset lmargin 10\nset rmargin 3\n"
      "set ylabel 'least distance, mm'\nset xlabel 'time after the first waypoint, s'\n";
  if (expected_) {
    script += fmt::format(
        "set arrow from graph 0, first {0:g} to graph 1, first {0:g} nohead dashtype 2 linecolor "
        "rgb '#b00000'\n",
        1e3 * *expected_);
  }
  return plot_svg(svg, kWidth, kHeight, script + curves + "\n");
}

std::string MotionReport::page(const std::string& svg, const std::string& no_plot) const {
  const auto failed = std::ranges::count_if(
      rows_, [](const Row& row) { return !row.as_expected || !row.error.empty(); });
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>"
      "<style>{1}</style></head>\n<body><h1>{0}</h1>\n<p>{2} motions, answered by Clearance {3}. "
      "The bounds hold at all instants of a motion.</p>\n",
      escaped(title_), kPageStyle, rows_.size(), escaped(kBuild));
  if (expected_) {
    out += fmt::format("<p class=\"{}\">Expected: every motion keeps {:g} m. {}</p>\n",
                       failed == 0 ? "held" : "failed", *expected_,
                       failed == 0 ? "All of them do."
                                   : fmt::format("{} of them do not, or have no answer.", failed));
  }
  out += svg.empty() ? fmt::format("<p class=\"quiet\">No plot: {}</p>\n", escaped(no_plot))
                     : fmt::format(
                           "<figure>{}</figure>\n<p class=\"quiet\">Bands lie between the "
                           "lower and the upper bound. The {} motions that come nearest "
                           "are shown, if there are more.</p>\n",
                           inline_svg(svg), kMostCurves);
  out +=
      "<table><tr><th>Motion</th><th>Least distance, mm</th><th>At, s</th><th>Pair</th>"
      "<th>Margins</th></tr>\n";
  for (const Row& row : rows_) {
    const std::string name =
        fmt::format("<td class=\"{}\">{}</td>",
                    row.as_expected && row.error.empty() ? "" : "failed", escaped(row.name));
    if (!row.error.empty()) {
      out += fmt::format("<tr>{}<td colspan=\"4\">{}</td></tr>\n", name, escaped(row.error));
      continue;
    }
    out += row.pair.empty()
               ? fmt::format("<tr>{}<td>no watched pair</td><td></td><td></td><td>{}</td></tr>\n",
                             name, escaped(row.verdicts))
               : fmt::format(
                     "<tr>{}<td>{:.3f} to {:.3f}</td><td>{:.4f}</td><td>{}</td>"
                     "<td>{}</td></tr>\n",
                     name, 1e3 * row.lower, 1e3 * row.upper, row.time, escaped(row.pair),
                     escaped(row.verdicts));
  }
  return out + "</table>\n</body></html>\n";
}

std::string MotionReport::finish() {
  if (csv_.is_open()) {
    csv_.close();
    if (!csv_) return cannot_write(files_.profile);
  }
  if (files_.plot.empty() && files_.page.empty()) return "";
  const TemporaryFolder folder;
  if (!folder.error().empty()) return folder.error();
  const std::filesystem::path svg =
      files_.plot.empty() ? folder.path() / "plot.svg" : std::filesystem::path(files_.plot);
  const std::string no_plot = plot(svg);
  if (files_.page.empty()) return no_plot;
  std::ifstream drawn(svg);
  const std::string text{std::istreambuf_iterator<char>(drawn), {}};
  std::ofstream file(files_.page);
  file << page(no_plot.empty() ? text : "", no_plot);
  file.close();
  if (!file) return cannot_write(files_.page);
  return files_.plot.empty() ? "" : no_plot;
}

}  // namespace clearance
