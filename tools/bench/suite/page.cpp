#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "monitor/files/build_info.hpp"
#include "tools/bench/suite/suite.hpp"
#include "tools/plot/gnuplot.hpp"

namespace clearance::bench {
namespace {

const char* name(bool cold) { return cold ? "cold" : "tracked"; }

// The row of all separations, if there is one.
const RaceRow* find(std::span<const RaceRow> rows, const std::string& kind, std::size_t rival,
                    bool cold) {
  const auto found = std::ranges::find_if(rows, [&](const RaceRow& row) {
    return row.kind == kind && row.rival == rival && row.cold == cold && std::isnan(row.separation);
  });
  return found == rows.end() ? nullptr : &*found;
}

std::string number(double value) { return std::isnan(value) ? "" : fmt::format("{:.3g}", value); }

std::string error(double value) {
  if (std::isnan(value)) return "–";
  return value == 0.0 ? "0" : fmt::format("{:.0e}", value);
}

std::string times(const RaceRow& row) {
  return fmt::format("{:.0f} / {:.0f}", row.p50_ns, row.p90_ns);
}

std::vector<std::string> kinds_of(std::span<const RaceRow> rows) {
  std::vector<std::string> kinds;
  for (const RaceRow& row : rows) {
    if (std::ranges::find(kinds, row.kind) == kinds.end()) kinds.push_back(row.kind);
  }
  return kinds;
}

// A line of the table: a rival in a class.
std::string line(std::span<const RaceRow> rows, const std::string& kind, std::size_t rival,
                 const std::string& rival_name) {
  const RaceRow* const tracked = find(rows, kind, rival, false);
  const RaceRow* const cold = find(rows, kind, rival, true);
  if (tracked == nullptr || cold == nullptr) return {};
  const auto multiple = [&](bool is_cold, const RaceRow& row) {
    const RaceRow* const ours = find(rows, kind, 0, is_cold);
    return ours == nullptr ? std::string("–") : fmt::format("{:.2f}", row.p50_ns / ours->p50_ns);
  };
  return fmt::format("| {} | {} | {} | {} | {:.0f} | {} | {} | {} | {} | {} of {} |\n", kind,
                     rival_name, times(*tracked), multiple(false, *tracked), tracked->streamed_ns,
                     times(*cold), multiple(true, *cold),
                     error(std::max(tracked->median_error, cold->median_error)),
                     error(std::max(tracked->max_error, cold->max_error)),
                     tracked->failures + cold->failures, tracked->queries + cold->queries);
}

// The classes in which a rival that is right has the smaller median, and the separations of others.
std::string where_rivals_lead(std::span<const RaceRow> rows, std::span<const Rival> rivals) {
  const auto is_same = [](double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
  };
  const auto find_row = [&](const RaceRow& like, std::size_t rival, double separation) {
    return std::ranges::find_if(rows, [&](const RaceRow& row) {
      return row.rival == rival && row.cold == like.cold && row.kind == like.kind &&
             is_same(row.separation, separation);
    });
  };
  // The multiple of our time, where that is below 1.
  const auto lead = [&](const RaceRow& row) -> std::optional<double> {
    if (row.failures > 0 || std::isnan(row.max_error)) return std::nullopt;
    const auto ours = find_row(row, 0, row.separation);
    if (ours == rows.end() || !(row.p50_ns < ours->p50_ns)) return std::nullopt;
    return row.p50_ns / ours->p50_ns;
  };
  std::string text;
  for (const RaceRow& row : rows) {
    const auto multiple = row.rival == 0 ? std::nullopt : lead(row);
    if (!multiple) continue;
    const bool is_one = !std::isnan(row.separation);
    if (is_one && lead(*find_row(row, row.rival, std::numeric_limits<double>::quiet_NaN())))
      continue;
    text += fmt::format("| {} | {} | {} | {} | {:.0f} | {:.2f} | {} |\n", row.kind,
                        is_one ? number(row.separation) : "all", rivals[row.rival].name,
                        name(row.cold), row.p50_ns, *multiple, error(row.max_error));
  }
  if (text.empty()) return {};
  return "\n## Where another library is faster\n\nThe table has only rows in which the rival has "
         "no failure. None of these rivals certifies bounds.\n\n| class | separation, m | rival | "
         "| p50, ns | x | largest error, m "
         "|\n|---|---|---|---|---:|---:|---:|\n" +
         text;
}

}  // namespace

std::string suite_csv(std::span<const RaceRow> rows, std::span<const Rival> rivals) {
  std::string text =
      "class,separation_m,rival,mode,p50_ns,p90_ns,streamed_ns,median_error_m,max_error_m,"
      "failures,queries\n";
  for (const RaceRow& row : rows) {
    text += fmt::format("\"{}\",{},\"{}\",{},{},{},{},{},{},{},{}\n", row.kind,
                        std::isnan(row.separation) ? "all" : number(row.separation),
                        rivals[row.rival].name, name(row.cold), number(row.p50_ns),
                        number(row.p90_ns), number(row.streamed_ns), number(row.median_error),
                        number(row.max_error), row.failures, row.queries);
  }
  return text;
}

std::string suite_page(std::span<const RaceRow> rows, std::span<const Rival> rivals,
                       const RaceOptions& options) {
  std::string text = fmt::format(
      R"(# One set of cases for all: speed and error

Every case has a distance that follows from its construction ([bench/suite](../suite/README.md)). Each class has separations from
contact over 1e-6 m to 10 m, and depths where they are known; [suite.csv](suite.csv) has each by itself. The rivals run in turns in one
process, {} passes over all cases. A time is that of one query between two readings of the clock, both poses as quaternions, the least
of all passes, in steps of the clock: compare it only within this page, since queries overlap in the processor in [report.md](report.md). *In a row* is the mean
of a motion's tracked queries, one after another. *x* is the multiple of Clearance's median
over the whole class, also where the rival is not asked for depths; the CSV compares separation by separation. A query fails that has no answer, or one
that is wrong by more than 1e-6 of the larger body's radius plus the distance. Answers are exact to {:.0e} m. A class that a rival has
no shapes for, or no depths, is left out.

![largest error against median time](suite.svg)

| rival | setting |
|---|---|
)",
      options.passes, kRoundedPoses);
  for (const Rival& rival : rivals) text += fmt::format("| {} | {} |\n", rival.name, rival.setting);
  text +=
      "\n| class | rival | tracked, p50 / p90 ns | x | in a row, ns | cold, p50 / p90 ns | x | "
      "median "
      "error, m | largest | failures |\n|---|---|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const std::string& kind : kinds_of(rows)) {
    for (std::size_t r = 0; r < rivals.size(); ++r) text += line(rows, kind, r, rivals[r].name);
  }
  text += where_rivals_lead(rows, rivals);
  return text + fmt::format("\nMade from {} by `clearance-bench --suite`.\n", kBuild);
}

std::string draw_suite(const std::filesystem::path& svg, std::span<const RaceRow> rows,
                       std::span<const Rival> rivals) {
  std::string script =
      "set logscale xy\nset format x '%.0f'\nset format y '10^{%T}'\nset yrange [1e-17:100]\n"
      "set grid linecolor rgb '#e4e4e4'\nset border 3\nset tics nomirror\nset xlabel 'median ns'\n"
      "set multiplot layout 1, 2 margins 0.06, 0.98, 0.25, 0.93 spacing 0.07\n";
  for (const bool cold : {false, true}) {
    std::string plots;
    for (std::size_t r = 0; r < rivals.size(); ++r) {
      // Gnuplot's marks come in pairs, the hollow one first: squares, circles, triangles.
      const std::size_t hollow = 4 + 2 * (2 * (r / std::size(kPlotColours)) + r % 2);
      std::string marks;
      for (const RaceRow& row : rows) {
        if (row.rival != r || row.cold != cold || !std::isnan(row.separation)) continue;
        if (std::isnan(row.max_error)) continue;
        marks += fmt::format("{:.6g} {:.6g} {}\n", std::max(1.0, row.p50_ns),
                             std::max(1e-16, row.max_error), hollow + (row.failures == 0));
      }
      if (marks.empty()) continue;
      const std::string block = fmt::format("$marks{}_{}", name(cold), r);
      const std::string style = fmt::format("pointsize {} linecolor rgb '{}'", r == 0 ? 1.0 : 0.7,
                                            kPlotColours[r % std::size(kPlotColours)]);
      script += fmt::format("{} << EOD\n{}EOD\n", block, marks);
      plots += fmt::format(
          "{}{} using 1:2:3 with points pointtype variable {} notitle, keyentry with points "
          "pointtype {} {} title {}",
          plots.empty() ? "" : ", ", block, style, hollow + 1, style, plot_text(rivals[r].name));
    }
    script += fmt::format(
        "set title '{}: largest error, m; hollow: some queries failed'\n{}\nplot {}\n", name(cold),
        cold ? "unset key"
             : "set key at screen 0.5, 0.02 center bottom horizontal maxrows 3 reverse Left",
        plots.empty() ? "1e-17 notitle" : plots);
  }
  return plot_svg(svg, 1120, 620, script + "unset multiplot\n");
}

}  // namespace clearance::bench
