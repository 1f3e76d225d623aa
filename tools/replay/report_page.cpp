#include "tools/replay/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "config/text/sentences.hpp"
#include "monitor/pair_name.hpp"
#include "tools/shared/html.hpp"

namespace clearance {
namespace {

std::string row(const std::string& term, const std::string& text) {
  return fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", term, escaped(text));
}

std::string base64(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned value = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      value =
          (value << 8U) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += i + k <= bytes.size() ? kDigits[(value >> (18U - 6U * k)) & 63U] : '=';
    }
  }
  return out;
}

std::string summary_table(const Scene& scene, const OfflineReplay& replay, const RunSeries& series,
                          const ReportPage& page) {
  std::string out = "<table>\n" + row("Recording", page.recording) +
                    row("Cell", fmt::format("{}: {}", page.cell, summary(scene)));
  out += row("Replayed with", page.build);
  out +=
      row("Run", fmt::format("{} in {:.3f} s", counted(replay.ticks, "tick"), series.duration_s()));
  if (replay.closest) {
    const PairReport& pair = *replay.closest;
    out += row("Least distance",
               fmt::format("{:.3f} mm, certified to be from {:.3f} to {:.3f} mm: {}, {}",
                           1e3 * pair.distance, 1e3 * pair.lower, 1e3 * pair.upper,
                           replay.closest_pair, replay.closest_tick.text()));
  } else {
    out += row("Least distance", "not known: no pair was ever evaluated");
  }
  out += row("Zones entered", counted(series.visits().size(), "time"));
  return out + "</table>\n";
}

std::string expectations(const OfflineReplay& replay, const ReportPage& page) {
  if (page.expectations.empty() && replay.failures.empty()) {
    return "<p class=\"quiet\">None was asked for (--expect-min-distance, --expect-no-zone, "
           "--compare).</p>\n";
  }
  std::string out =
      fmt::format("<p class=\"{}\">{}</p>\n<ul>\n", replay.ok() ? "held" : "failed",
                  replay.ok() ? "All of them hold in every tick." : "NOT all of them hold.");
  for (const std::string& each : page.expectations) {
    out += fmt::format("<li>{}</li>\n", escaped(each));
  }
  for (const ReplayFailure& failure : replay.failures) {
    out += fmt::format("<li class=\"failed\">{} ({:.6f} s): {}</li>\n",
                       escaped(failure.tick.text()), failure.time_s, escaped(failure.what));
  }
  return out + "</ul>\n";
}

std::string moments(const ReportPage& page) {
  std::string out;
  if (!page.no_pictures.empty()) {
    out += fmt::format("<p class=\"quiet\">No pictures: {}</p>\n", escaped(page.no_pictures));
  }
  for (const PicturedMoment& moment : page.moments) {
    out += fmt::format("<figure><figcaption>{:.4f} s: {}</figcaption>", moment.time_s,
                       escaped(moment.what));
    if (std::filesystem::exists(moment.picture)) {
      out += fmt::format("<img alt=\"the cell at {:.4f} s\" src=\"data:image/png;base64,{}\">",
                         moment.time_s, base64(moment.picture));
    }
    out += "</figure>\n";
  }
  return out;
}

std::string zones(const RunSeries& series) {
  constexpr std::size_t kMost = 100;
  const std::vector<ZoneVisit> visits = series.visits();
  if (visits.empty()) return "<p>No zone was ever active.</p>\n";
  std::string out =
      "<table><tr><th>Zone</th><th>From, s</th><th>To, s</th><th>Pair</th><th>Least clearance, "
      "mm</th></tr>\n";
  for (std::size_t i = 0; i < std::min(visits.size(), kMost); ++i) {
    const ZoneVisit& visit = visits[i];
    out += fmt::format(
        "<tr><td>{}</td><td>{:.4f}</td><td>{:.4f}</td><td>{}</td><td>{:.3f}</td></tr>\n",
        escaped(visit.zone), visit.begin_s, visit.end_s, escaped(visit.pair),
        1e3 * visit.clearance);
  }
  out += "</table>\n";
  if (visits.size() > kMost) out += fmt::format("<p>... and {} more.</p>\n", visits.size() - kMost);
  return out;
}

}  // namespace

std::string report_page(const Scene& scene, const OfflineReplay& replay, const RunSeries& series,
                        const ReportPage& page) {
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}: a run</title>"
      "<style>{1}</style></head>\n<body><h1>{0}: a run, replayed</h1>\n",
      escaped(scene.name), kPageStyle);
  out += summary_table(scene, replay, series, page);
  out += "<h2>Expectations</h2>\n" + expectations(replay, page);
  out += "<h2>Distances</h2>\n";
  out += page.svg.empty()
             ? fmt::format("<p class=\"quiet\">No plot: {}</p>\n", escaped(page.no_plot))
             : fmt::format(
                   "<figure>{}</figure>\n<p class=\"quiet\">Lines are distances, bands "
                   "below them reach to the certified lower bounds; shaded: a zone was "
                   "active.</p>\n",
                   inline_svg(page.svg));
  out += "<h2>Worst moments</h2>\n" + moments(page);
  out += "<h2>Zones</h2>\n" + zones(series);
  for (const std::string& note : replay.notes) {
    out += fmt::format("<p class=\"quiet\">{}</p>\n", escaped(note));
  }
  return out + "</body></html>\n";
}

}  // namespace clearance
